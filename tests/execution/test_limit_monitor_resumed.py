"""A mission that is cut off between or at crossings goes on as it would have gone: each crossing stands once."""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from pathlib import Path

import numpy as np
import pytest

from execution.journalled import Cut, PowerCut
from fieldhand.clock import SimulatedClock
from fieldhand.evaluation.battery_drain import BatteryDrain
from fieldhand.evaluation.failsafe import BudgetFailsafe
from fieldhand.execution import mission_clock
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import BatteryDrains, World
from fieldhand.execution.guard import NoGuard
from fieldhand.execution.journal import store
from fieldhand.execution.journal.store import create
from fieldhand.execution.mission_runner import Result, run
from fieldhand.places.selectors import TreeIs, Trees
from fieldhand.task.event_lines import to_json
from fieldhand.task.plan import Act, ForEach, InOrder
from fieldhand.task.results import Event, LimitCrossed, Resumed
from support.missions.rig import authorized, captured, husky, of_type, orchard, task_for

PLAN = InOrder(
    id="",
    steps=(
        Act(id="", action="read_co2", at=TreeIs(tree="r0c0")),
        ForEach(id="", select=Trees(), body=Act(id="", action="read_co2")),
    ),
)


@pytest.fixture(autouse=True)
def _no_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")
    monkeypatch.setattr(mission_clock.time, "sleep", lambda seconds: None)


def fly(folder: Path, factor: float, *, cut: int = 0, behind: bool = False) -> Result:
    """Carry the mission out, or what is left of it, with a battery that drains so many times as fast from 20 s on."""
    robot = husky(alpha=0.5)
    robot = replace(robot, energy=replace(robot.energy, capacity_j=0.15 * robot.energy.capacity_j))
    world = World(charge_percent=42.0, faults=(BatteryDrains(factor=factor, from_s=20.0),))
    task, clock = task_for(PLAN), mission_clock.MissionClock(SimulatedClock())
    with Cut(folder / "journal.sqlite", "mission", folder / "log", lambda line: None) as journal:
        journal.at, journal.behind = cut, behind
        return run(
            authorized(task, orchard(), robot),
            site=orchard(),
            robot=robot,
            driver=SimulatedDriver(orchard(), robot, world, clock, np.random.default_rng(2)),
            guard=NoGuard(),
            clock=clock,
            emit=lambda event: None,
            failsafe=BudgetFailsafe(task, robot, BatteryDrain(robot)),
            log=journal,
            simulated=True,
        )


def crossings(events: tuple[Event, ...]) -> list[tuple[str, str, bool]]:
    return [(e.quantity, e.level, e.cleared) for e in of_type(events, LimitCrossed)]


@pytest.mark.parametrize("factor", [2.0, 12.0])
def test_cut_at_every_commit_each_crossing_stands_once(tmp_path: Path, factor: float) -> None:
    create_in(tmp_path / "whole")
    whole = fly(tmp_path / "whole", factor)
    assert len(crossings(whole.events)) >= 2
    for n in count(1, 4):
        done = False
        for behind in (False, True):
            folder = tmp_path / f"{n}{behind}"
            create_in(folder)
            try:
                fly(folder, factor, cut=n, behind=behind)
                done = True
            except PowerCut:
                pass
            result = fly(folder, factor)
            assert (folder / "log").read_text().splitlines() == [to_json(e) for e in result.events]
            found = crossings(result.events)
            assert len(found) == len(set(found))
            assert result.status in ("returned", "exceeded", "faulted")
            if not of_type(result.events, Resumed):
                assert captured(result.events) == captured(whole.events)
        if done:
            break
    assert n > 8


def create_in(folder: Path) -> None:
    folder.mkdir()
    create(folder / "journal.sqlite", "mission")
