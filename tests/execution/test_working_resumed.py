"""Work along a path that power cuts and pauses interrupt: no metre is lost, and none is worked twice for long."""

from __future__ import annotations

from pathlib import Path

import pytest

from execution.journalled import Field, PowerCut
from fieldhand.execution.operator_commands import OperatorCommand
from fieldhand.task.event_lines import from_json
from fieldhand.task.plan import InOrder
from fieldhand.task.results import Ended, Event, Paused, Resumed, Worked, Working
from support.missions.rig import of_type
from support.missions.working import along, tractor

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
        field = Field(tmp_path / f"{cut}{outlives}{behind}", robot=tractor(), outlives=outlives)
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


def test_a_pause_switches_off_and_the_rest_is_worked_afterwards(tmp_path: Path) -> None:
    field = Field(tmp_path, robot=tractor())

    def orders() -> OperatorCommand | None:
        now = field.clock.now()
        return OperatorCommand(wanted="pause", reason="tea", number=1) if 12.0 < now < 14.0 else None

    result = field.fly(PLAN, orders=orders)
    assert result.status == "completed"
    found = events(field)
    assert of_type(found, Paused)
    assert [e.status for e in of_type(found, Worked)] == ["success"] * 3
    assert sum(e.worked_m for e in of_type(found, Worked)) == pytest.approx(60.0, abs=0.3)
    assert len(of_type(found, Working)) >= 3
    assert not of_type(found, Resumed)
