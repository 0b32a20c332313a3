"""A navigation that restarts and that others use: the mission waits, pauses and goes on, also after power cuts."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from execution.journalled import Field, PowerCut
from fieldhand.clock import Clock, SimulatedClock
from fieldhand.execution import mission_clock
from fieldhand.execution.drivers.protocol import DriveGoal, Position, Progress
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.execution.journal.records import Observation, observation_of
from fieldhand.places.selectors import TreeIs
from fieldhand.task.plan import Act, InOrder
from fieldhand.task.results import Continued, Faulted, Paused, Waited
from support.missions.rig import captured, husky, of_type, orchard

PLAN = InOrder(id="", steps=tuple(Act(id="", action="read_co2", at=TreeIs(tree=tree)) for tree in ("r0c0", "r3c3")))
WHOLE = [("read_co2", "r0c0"), ("read_co2", "r3c3")]


class SharedRobot(SimulatedDriver):
    """A robot whose navigation ends the second drive after 5 s: others drive it for 20 s, then it restarts for 10 s."""

    def __init__(self, clock: Clock) -> None:
        super().__init__(orchard(), husky(), World(), clock, np.random.default_rng(2))
        self._time, self._drives, self._cut_s = clock, 0, 0.0
        self._cutting = self._done = False

    def start_drive(self, goal: DriveGoal) -> None:
        super().start_drive(goal)
        self._drives += 1
        self._done = False
        if self._drives == 2:
            self._cut_s = self._time.now() + 5.0

    def poll(self) -> Progress:
        progress = super().poll()
        due = self._drives == 2 and self._time.now() >= self._cut_s
        if due and progress.state == "running" and not self._cutting:
            self._cutting = True
            self.cancel()
            self._cutting, self._done = False, True
        if self._done:
            return replace(super().poll(), state="failed", fault="interrupted", what="no code")
        return progress

    def next_event_in(self) -> float | None:
        due = super().next_event_in()
        left = self._cut_s - self._time.now()
        return due if due is None or self._drives != 2 or left < 0.0 else min(due, left)

    def away(self) -> str | None:
        return "restarted" if self._drives >= 2 and 20.0 <= self._time.now() - self._cut_s < 30.0 else None

    def taken(self) -> str | None:
        return "somebody drives it" if self._drives >= 2 and 0.0 <= self._time.now() - self._cut_s < 20.0 else None


class SharedField(Field):
    def _new(self) -> tuple[SimulatedClock | mission_clock.MissionClock, SimulatedDriver]:
        clock = SimulatedClock() if self.outlives else mission_clock.MissionClock(SimulatedClock())
        return clock, SharedRobot(clock)


def test_the_mission_pauses_waits_and_goes_on(tmp_path: Path) -> None:
    result = SharedField(tmp_path, robot=husky()).fly(PLAN)
    assert (result.status, captured(result.events)) == ("completed", WHOLE)
    (fault,) = [e.what for e in of_type(result.events, Faulted) if e.fault == "interrupted"]
    assert fault == "drive to tree r3c3: no code; trying again"
    (paused,), (continued,) = of_type(result.events, Paused), of_type(result.events, Continued)
    assert paused.reason == "somebody drives it; the mission goes on in 300 s, or when it is resumed"
    assert continued.t - paused.t == pytest.approx(18.0, abs=1.5)


def test_a_power_cut_at_any_time_changes_nothing_of_that(tmp_path: Path) -> None:
    whole = SharedField(tmp_path / "whole", robot=husky()).fly(PLAN)
    n = 0
    while True:
        n += 1
        field = SharedField(tmp_path / str(n), robot=husky())
        try:
            field.fly(PLAN, cut=n)
        except PowerCut:
            pass
        else:
            break
        result = field.fly(PLAN)
        assert (result.status, captured(result.events)) == (whole.status, WHOLE), n
    assert n > 10


@pytest.mark.parametrize("away", [None, "bt_navigator is inactive"])
@pytest.mark.parametrize("taken", [None, "a goal of another client"])
def test_an_observation_is_read_as_it_was_recorded(away: str | None, taken: str | None) -> None:
    seen = Observation(
        t=1.0,
        position=Position(x=1.0, y=2.0, lat=37.0, lon=-120.0),
        charge_percent=50.0,
        progress=Progress(state="failed", fault="interrupted", what="no code"),
        stopped=None,
        lost=None,
        next_in=None,
        order=None,
        away=away,
        taken=taken,
    )
    assert observation_of(seen.record()) == seen
    assert (away is None) == ('"away"' not in seen.record().body)
    assert (taken is None) == ('"taken"' not in seen.record().body)


def test_a_navigation_that_does_not_come_back_fails_the_drive(tmp_path: Path) -> None:
    robot = husky()
    field = SharedField(
        tmp_path, robot=replace(robot, patience=replace(robot.patience, navigation_wait_s=3.0, taken_wait_s=19.0))
    )
    result = field.fly(PLAN)
    assert result.status == "faulted"
    assert result.reason.startswith("the robot's navigation was not ready within 3 s (restarted)")
    assert [(e.wanted, e.over) for e in of_type(result.events, Waited)] == [("navigation", False)]
