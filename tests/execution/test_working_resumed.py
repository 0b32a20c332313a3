"""Work along a path that power cuts and pauses interrupt: no metre is lost, and none is worked twice for long."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count
from pathlib import Path

import numpy as np
import pytest

from execution.journalled import Field, PowerCut
from fieldhand.clock import SimulatedClock
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.execution.mission_clock import MissionClock
from fieldhand.execution.operator_commands import OperatorCommand
from fieldhand.task.event_lines import from_json
from fieldhand.task.plan import InOrder
from fieldhand.task.results import Ended, Event, Resumed, Worked, Working
from support.missions.rig import of_type, orchard
from support.missions.working import along, tractor


class Watched(SimulatedDriver):
    """A simulated robot that is looked at every two seconds, as a real one is."""

    def next_event_in(self) -> float | None:
        soon = super().next_event_in()
        return None if soon is None else min(2.0, soon)


class WatchedField(Field):
    def _new(self) -> tuple[SimulatedClock | MissionClock, SimulatedDriver]:
        clock, _ = super()._new()
        return clock, Watched(orchard(), self.robot, World(), clock, np.random.default_rng(2))


PLAN = InOrder(steps=(along("r0", "r1"), along("r2", action="mow")))


def events(field: Field) -> list[Event]:
    found = [from_json(line) for line in field.lines]
    assert None not in found
    return [event for event in found if event is not None]


def uninterrupted(folder: Path) -> list[Event]:
    field = Field(folder, robot=tractor())
    field.fly(PLAN)
    return events(field)


@pytest.mark.parametrize("behind", [False, True])
@pytest.mark.parametrize("outlives", [False, True])
def test_every_power_cut_is_survived_and_all_is_worked(tmp_path: Path, outlives: bool, behind: bool) -> None:
    whole = uninterrupted(tmp_path / "whole")
    worked = {e.stretch: e.worked_m for e in of_type(whole, Worked)}
    cut = 0
    while True:
        cut += 1
        field = WatchedField(tmp_path / f"{cut}{outlives}{behind}", robot=tractor(), outlives=outlives)
        try:
            field.fly(PLAN, cut=cut, behind=behind)
        except PowerCut:
            field.fly(PLAN)
        else:
            break
        found = events(field)
        assert of_type(found, Ended)[-1].status == "completed"
        by_stretch: dict[str, float] = {}
        for event in of_type(found, Worked):
            assert event.status == "success"
            by_stretch[event.stretch] = by_stretch.get(event.stretch, 0.0) + event.worked_m
        assert by_stretch == pytest.approx(worked)
    assert cut > 8


def test_a_pause_at_any_look_switches_off_and_the_rest_is_worked_afterwards(tmp_path: Path) -> None:
    in_the_middle = 0
    for n in range(1, 60, 3):
        field = WatchedField(tmp_path / str(n), robot=tractor())
        pause = OperatorCommand(wanted="pause", reason="tea", number=1)
        asked = count()

        def orders(n: int = n, asked: Iterator[int] = asked, pause: OperatorCommand = pause) -> OperatorCommand | None:
            return pause if n <= next(asked) < n + 6 else None

        assert field.fly(PLAN, orders=orders).status == "completed"
        found = events(field)
        assert [e.status for e in of_type(found, Worked)] == ["success"] * 3
        assert sum(e.worked_m for e in of_type(found, Worked)) == pytest.approx(60.0, abs=0.3)
        in_the_middle += len(of_type(found, Working)) > 3
        assert not of_type(found, Resumed)
    assert in_the_middle
