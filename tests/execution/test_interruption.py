"""Whenever a mission is cut off, it ends in order: one Ended event, the last, and no capture that was made is lost."""

from __future__ import annotations

import signal
from collections.abc import Callable
from itertools import count

import numpy as np
import pytest

from fieldhand.clock import SimulatedClock
from fieldhand.execution.drivers.protocol import Progress
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import ActionFails, Blocked, TreeRef, World
from fieldhand.execution.interrupts import ctrl_c_as_request
from fieldhand.execution.mission_runner import Result, run
from fieldhand.places.selectors import Half, Take, TreeIs
from fieldhand.task.conditions import Compare
from fieldhand.task.frames import FaultedExit
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, If, InOrder, Repeat, Try
from fieldhand.task.results import Acted, Arrived, Driving, Ended, Event, Exited
from support.missions.rig import Rig, authorized, captured, husky, of_type, task_for

PICTURE = "take_thermal_picture"
PLAN = InOrder(
    id="",
    steps=(
        Act(id="", action=PICTURE, at=TreeIs(tree="r0c0"), count=2, reading="r"),
        If(
            id="",
            condition=Compare(reading="r", quantity="canopy_temperature", test="gt", value=0, unit="degC"),
            then=AnyOrder(
                id="",
                steps=(
                    GoTo(id="", place=TreeIs(tree="r3c3")),
                    Act(id="", action=PICTURE, at=TreeIs(tree="r2c2")),
                ),
            ),
        ),
        ForEach(
            id="",
            select=Take(count=3, of=Half(side="north")),
            optional=True,
            body=Try(
                id="",
                body=Act(id="", action="read_co2"),
                otherwise=Repeat(id="", times=2, body=Act(id="", action="read_ambient_temperature")),
            ),
        ),
    ),
)


def rig() -> Rig:
    return Rig(robot=husky(alpha=0.5), world=World(faults=(ActionFails(action="read_co2", times=3),)), seed=2)


def well_ended(result: Result, whole: Result) -> None:
    """One end, the last; everything before it is how the mission would have gone."""
    assert [e for e in result.events if isinstance(e, Ended)] == [result.events[-1]]
    made = captured(result.events)
    assert made == captured(whole.events)[: len(made)]
    assert result.events[-1].status == result.status


def ticks(n: int) -> Callable[[], str | None]:
    """An interruption at the n-th question."""
    asked = count()
    return lambda: "the operator said stop" if next(asked) >= n else None


def test_interrupted_at_every_tick() -> None:
    whole = rig().fly(PLAN)
    assert whole.status == "completed"
    for n in range(200):
        result = rig().fly(PLAN, interrupted=ticks(n))
        well_ended(result, whole)
        if result.status == "completed":
            break
        assert (result.status, result.reason) == ("aborted", "the operator said stop")
        assert [e.then for e in of_type(result.events, Exited)][-1] in ("stay", "return_to_end")
    assert n > 15


class Pressing(SimulatedClock):
    """A clock on which Ctrl-C comes while the n-th wait goes on, part of the way through."""

    def __init__(self, n: int, part: float) -> None:
        super().__init__()
        self._left, self._part = n, part

    def advance(self, seconds: float) -> None:
        self._left -= 1
        if self._left == -1:
            super().advance(seconds * self._part)
            raise KeyboardInterrupt
        super().advance(seconds)


@pytest.mark.parametrize("part", [0.0, 0.5, 1.0])
def test_ctrl_c_while_waiting(part: float) -> None:
    """A capture that was done when Ctrl-C came is kept, even if nobody had looked yet."""
    whole = rig().fly(PLAN)
    for n in range(200):
        one = rig()
        one.clock = Pressing(n, part)
        result = one.fly(PLAN)
        well_ended(result, whole)
        if result.status == "completed":
            break
        assert result.status == "aborted"
        done = sum(1 for e in of_type(whole.events, Acted) if e.status == "success" and e.t <= one.clock.now() + 1e-9)
        assert len(captured(result.events)) == done
    assert n > 15


def test_the_metres_of_a_drive_that_was_cut_off_count() -> None:
    one = rig()
    one.clock = Pressing(0, 0.5)
    result = one.fly(PLAN)
    assert result.spent.metres == pytest.approx(one.clock.now() * one.robot.speed_m_s)
    assert 0 < result.spent.metres < 20
    assert of_type(result.events, Arrived) == []


def test_ctrl_c_at_every_event() -> None:
    """Whoever takes the events raises KeyboardInterrupt once: the event is kept, and the end still comes."""
    whole = rig().fly(PLAN)
    for n in range(len(whole.events) - 1):
        seen = count()

        def take(event: Event, n: int = n, seen: count[int] = seen) -> None:
            if next(seen) == n:
                raise KeyboardInterrupt

        result = rig().fly(PLAN, emit=take)
        well_ended(result, whole)
        assert result.events[: n + 1] == whole.events[: n + 1]


def test_a_real_ctrl_c_is_a_request_and_the_mission_aborts() -> None:
    before = signal.getsignal(signal.SIGINT)
    seen: list[Event] = []

    def take(event: Event) -> None:
        seen.append(event)
        if isinstance(event, Acted) and len(of_type(seen, Acted)) == 1:
            signal.raise_signal(signal.SIGINT)

    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        result = rig().fly(Act(id="", action=PICTURE, at=TreeIs(tree="r0c0"), count=5), emit=take)
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)
    assert (result.status, result.reason) == ("aborted", "stopped by the operator (Ctrl-C)")
    assert len(captured(result.events)) == 1
    assert tuple(seen) == result.events


def test_a_second_ctrl_c_raises_as_ever() -> None:
    before = signal.getsignal(signal.SIGINT)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with ctrl_c_as_request() as pressed:
            assert pressed() is None
            signal.raise_signal(signal.SIGINT)
            assert pressed() is not None
            with pytest.raises(KeyboardInterrupt):
                signal.raise_signal(signal.SIGINT)
    finally:
        signal.signal(signal.SIGINT, before)


def test_somebody_elses_handler_is_left_alone() -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with ctrl_c_as_request() as pressed:
            assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
            signal.raise_signal(signal.SIGINT)
            assert pressed() is None
    finally:
        signal.signal(signal.SIGINT, before)


def test_an_aborted_mission_comes_home_where_the_task_says_so_unless_stopped_again() -> None:
    exits = (FaultedExit(fault="aborted", then="return_to_start"),)
    task = task_for(Act(id="", action="read_co2", at=TreeIs(tree="r3c3")), faulted=exits)
    asked = count()
    result = Rig().fly(task, interrupted=lambda: "stop" if next(asked) >= 4 else None)
    assert (result.status, result.reason) == ("aborted", "stop")
    assert [e.place for e in of_type(result.events, Driving)][-1] == "start"
    assert [e.place for e in of_type(result.events, Arrived)][-1] == "start"
    asked = count()
    again = Rig().fly(task, interrupted=lambda: ["stop", "really"][n > 5] if (n := next(asked)) >= 4 else None)
    assert (again.status, again.reason) == ("aborted", "really")
    assert [e.place for e in of_type(again.events, Arrived)] != ["start"]


def test_an_aborted_mission_whose_way_home_is_blocked_is_still_aborted() -> None:
    """Aborted while it reads at the row's first tree; what stands at the last closes off the end."""
    task = task_for(
        Act(id="", action="read_co2", at=TreeIs(tree="r0c0"), count=9),
        faulted=(FaultedExit(fault="aborted", then="return_to_end"),),
    )
    asked = count()
    one = Rig(world=World(faults=(Blocked(at=TreeRef(id="r0c4"), within_m=8),)))
    result = one.fly(task, interrupted=lambda: "stop" if next(asked) >= 8 else None)
    assert result.status == "aborted"
    assert result.reason.startswith("stop; then ")
    assert "r0c4" in result.reason


def test_a_robot_that_does_not_stop_is_said_so() -> None:
    class Deaf(SimulatedDriver):
        """A robot that answers nothing."""

        def cancel(self) -> None:
            pass

        def poll(self) -> Progress:
            return Progress(state="running")

        def next_event_in(self) -> float | None:
            return 0.5

    one = Rig()
    task = task_for(Act(id="", action="read_co2", at=TreeIs(tree="r3c3")))
    driver = Deaf(one.site, one.robot, one.world, one.clock, np.random.default_rng(0))
    driver._begin = lambda: None  # type: ignore[method-assign]
    asked = count()
    result = run(
        authorized(task, one.site, one.robot),
        site=one.site,
        robot=one.robot,
        driver=driver,
        guard=one.guard,
        clock=one.clock,
        emit=lambda event: None,
        interrupted=lambda: "stop" if next(asked) > 2 else None,
    )
    assert result.status == "faulted"
    assert "does not stop" in result.reason
    assert "emergency stop" in result.reason
