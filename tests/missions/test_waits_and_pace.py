"""Waits and paces of a plan: the robot does what was forecast, commands and limits apply, a power cut loses nothing."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from execution.journalled import Field, PowerCut
from fieldhand.evaluation.budget_guard import BudgetGuard
from fieldhand.evaluation.outcome import judge
from fieldhand.execution.operator_commands import OperatorCommand
from fieldhand.forecast.estimate import estimate
from fieldhand.forecast.mission_state import Work
from fieldhand.forecast.remaining_work import remaining_work_after
from fieldhand.forecast.visit_order import drives_for
from fieldhand.places.context import Context
from fieldhand.places.selectors import Half, TreeIs
from fieldhand.task.frames import Budget, Constraints
from fieldhand.task.plan import Act, ForEach, GoTo, InOrder, Node, Pace, Recharge, Try, Wait, walk
from fieldhand.task.results import (
    ChargeEnded,
    Driving,
    Dwelling,
    Dwelt,
    Ended,
    Event,
    EventBegan,
    Exited,
    Resumed,
    Shed,
)
from fieldhand.task.run import StackFrame
from missions.agreement import AsChosen, previewed, simulated
from support.examples import examples
from support.missions.rechargeable import CHARGING
from support.missions.rig import Rig, captured, husky, of_type, orchard, task_for

CO2 = Act(action="read_co2")
WAITING = InOrder(
    steps=(
        GoTo(place=TreeIs(tree="r0c1")),
        Wait(seconds=600.0),
        Act(action="read_co2", at=TreeIs(tree="r1c3")),
    )
)


def driven_between(events: Sequence[Event], begin: float, end: float) -> bool:
    return any(begin <= event.t < end for event in of_type(events, Driving))


@settings(max_examples=examples(20, thorough=500), deadline=None)
@given(st.integers(0, 2**32 - 1))
@example(16867)
@example(759)
def test_the_time_of_waits_and_slow_drives_is_that_of_the_forecast(seed: int) -> None:
    flight = simulated(seed)
    assume(all(kind != "failure" for kind, _, _ in flight.trace))
    assume(not of_type(flight.events, EventBegan))  # the forecast is without events
    walked = previewed(flight, AsChosen(flight))
    # A timed charge ends early once the battery is full; the forecast has the whole time.
    wanted = {node.id: node.duration_s for node in walk(flight.task.composition.plan) if isinstance(node, Recharge)}
    charges = of_type(flight.events, ChargeEnded)
    early = sum(wanted[one.node] - one.seconds for one in charges if wanted.get(one.node) and one.charge_percent > 99.9)
    # The forecast undocks after each charge; the robot does so only to drive on.
    ended_s = of_type(flight.events, Ended)[0].t
    stays = sum(not driven_between(flight.events, *pair) for pair in pairwise([*(one.t for one in charges), ended_s]))
    undocking = stays * CHARGING["undock"]["duration_s"]
    assert sum(step.seconds for step in walked.steps) == pytest.approx(ended_s + early + undocking)


@settings(max_examples=examples(20, thorough=500), deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_no_drive_is_faster_than_the_paces_around_it(seed: int) -> None:
    flight = simulated(seed)
    most: dict[str, float] = {}

    def limit(node: Node, pace: float) -> None:
        most[node.id] = min(pace, node.pace_m_s)
        for child in node.children:
            limit(child, most[node.id])

    limit(flight.task.composition.plan, 1.0)
    slower = bool(flight.task.constraints.slow or flight.task.composition.watches)
    for drive in of_type(flight.events, Driving):
        pace = most.get(drive.node, 1.0)
        assert drive.speed_m_s is not None
        assert drive.speed_m_s <= pace * (1 + 1e-9)
        assert slower or drive.speed_m_s == pytest.approx(pace)


def test_each_sampled_mission_takes_longer_by_the_slower_part_alone() -> None:
    robot, site = husky(alpha=0.5), orchard()
    loop = ForEach(select=Half(side="north"), body=CO2)
    plain, slow = (
        estimate(task_for(InOrder(steps=(*first, body))), site, robot, seed=3).worst
        for body in (loop, Pace(speed_m_s=0.25, body=loop))
        for first in [(Act(action="read_co2", at=TreeIs(tree="r0c0")),)]
    )
    inside = sum(s.drive.length_m for s in slow.walk.steps if s.drive is not None and s.slower_s_per_m > 0)
    assert inside > 0
    assert slow.seconds.mean == pytest.approx(plain.seconds.mean + 3.0 * inside, rel=0.02)
    # The spread of the slow legs' time is four times that of the others.
    assert slow.seconds.p90 - slow.seconds.p50 > 1.5 * (plain.seconds.p90 - plain.seconds.p50)


def test_the_rest_of_a_slow_part_stays_slow_for_the_guard() -> None:
    """What follows inside a pace is priced at its speed, what follows after it is not."""
    site, robot = orchard(), husky()
    inner = InOrder(id="n3", steps=(CO2, Act(id="n4", action="read_co2", at=TreeIs(tree="r3c4"))))
    pace = Pace(id="n2", speed_m_s=0.1, body=inner)
    task = task_for(InOrder(steps=(pace,)))
    drives = drives_for(site, robot)
    here = drives.stands((site.by_id["r0c0"].place,))[0]
    frames = (StackFrame(node=pace), StackFrame(node=inner, left=inner.steps[1:]), StackFrame(node=CO2))
    rest = remaining_work_after(task, site, robot, drives, frames, Context(here=here))
    metres = drives.between(here, site.by_id["r3c4"].place).length_m
    assert rest.work == Work(seconds=pytest.approx(15.0 + 9.0 * metres), joules=1000.0)


def test_a_wait_beyond_the_time_budget_is_not_begun() -> None:
    budget = Constraints(budgets=(Budget(kind="duration_s", limit=300.0),))
    task, site, robot = task_for(WAITING, constraints=budget), orchard(), husky()
    guard = BudgetGuard(task, site, robot, drives_for(site, robot), seed=0)
    result = Rig(guard=guard).fly(task)
    assert result.status == "returned"
    assert result.spent.seconds < 300.0
    assert not of_type(result.events, Dwelling)
    assert any(shed.node == "n3" and not shed.optional for shed in of_type(result.events, Shed))


def test_an_optional_wait_that_does_not_fit_is_left_out() -> None:
    budget = Constraints(budgets=(Budget(kind="duration_s", limit=900.0),))
    loop = ForEach(select=Half(side="north"), optional=True, body=InOrder(steps=(Wait(seconds=200.0), CO2)))
    task, site, robot = task_for(loop, constraints=budget), orchard(), husky()
    guard = BudgetGuard(task, site, robot, drives_for(site, robot), seed=0)
    result = Rig(guard=guard).fly(task)
    assert result.status == "completed"
    assert 1 <= len(of_type(result.events, Dwelt)) < 10
    assert result.spent.seconds <= 900.0


@pytest.mark.parametrize(("wanted", "then"), [("return", "return_to_end"), ("end", "stay"), ("abort", "stay")])
def test_commands_take_effect_during_a_wait(tmp_path: Path, wanted: str, then: str) -> None:
    field = Field(tmp_path)
    command = OperatorCommand(wanted=wanted, reason="rain", number=1)  # type: ignore[arg-type]
    result = field.fly(WAITING, orders=lambda: command if field.clock.now() > 100.0 else None)
    assert result.status == "aborted"
    assert (of_type(result.events, Exited)[0].then, of_type(result.events, Dwelt)) == (then, [])
    assert of_type(result.events, Exited)[0].t == pytest.approx(100.0, abs=1.1)
    (outcome,) = judge(task_for(WAITING), result.events)
    assert (outcome.outcome, outcome.done) == ("indeterminate", 0)


def test_a_pause_during_a_wait_does_not_prolong_it(tmp_path: Path) -> None:
    field = Field(tmp_path)
    pause = OperatorCommand(wanted="pause", reason="lunch", number=1)
    asked = 0

    def orders() -> OperatorCommand | None:
        """Pause at some time of the wait, until the robot has asked a few times whether it is over."""
        nonlocal asked
        asked += field.clock.now() > 100.0
        return pause if 0 < asked < 4 else None

    result = field.fly(WAITING, orders=orders)
    assert result.status == "completed"
    assert of_type(result.events, Dwelt)[0].seconds == pytest.approx(600.0)


def test_a_wait_that_a_power_cut_interrupts_lasts_as_long_in_all(tmp_path: Path) -> None:
    plan = InOrder(steps=(GoTo(place=TreeIs(tree="r0c1")), Wait(seconds=20.0), Act(action="read_co2")))
    whole = Field(tmp_path / "whole").fly(plan)
    for n in range(1, 60):
        field = Field(tmp_path / str(n))
        try:
            result = field.fly(plan, cut=n)
        except PowerCut:
            result = field.fly(plan)
        assert result.status == "completed"
        assert of_type(result.events, Dwelt)[0].seconds == pytest.approx(20.0)
        assert captured(result.events) == captured(whole.events)
        cut = of_type(result.events, Resumed)
        if not cut and n > 5:
            return
    raise AssertionError("the mission never ended without a cut")


def test_a_robot_that_a_failed_drive_left_on_the_way_waits_there() -> None:
    from fieldhand.execution.drivers.simulation.world import DriveFails, TreeRef, World

    plan = Try(
        body=GoTo(place=TreeIs(tree="r3c4")),
        otherwise=InOrder(steps=(Wait(seconds=60.0), GoTo(place=TreeIs(tree="r3c3")))),
    )
    result = Rig(world=World(faults=(DriveFails(at=TreeRef(id="r3c4"), times=2),))).fly(plan)
    assert result.status == "completed"
    begun = of_type(result.events, Dwelling)[0]
    around = [d for d in of_type(result.events, Driving) if d.t == pytest.approx(begun.t + 60.0)]
    assert [d.place for d in around] == ["r3c3"]
