"""Missions that work along paths: what is on where, what it costs, and what follows from each kind of fault."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.evaluation.budget_guard import BudgetGuard
from fieldhand.evaluation.outcome import judge
from fieldhand.execution.drivers.protocol import DriveGoal, StretchWork
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import (
    ActionFails,
    Blocked,
    DriveFails,
    LocalisationLost,
    RobotStops,
    TreeRef,
    World,
)
from fieldhand.forecast.estimate import estimate
from fieldhand.forecast.visit_order import drives_for
from fieldhand.task.event_lines import from_json, to_json
from fieldhand.task.frames import Budget, Constraints
from fieldhand.task.plan import InOrder, Node, Try, WorkAlong
from fieldhand.task.results import Arrived, Ended, Event, Faulted, Obstructed, Shed, Worked, Working
from support.missions.rig import Rig, of_type, orchard, task_for
from support.missions.working import along, gappy, tractor

SITE = orchard()


def rig(**more: object) -> Rig:
    return Rig(**{"site": SITE, "robot": tractor(), **more})  # type: ignore[arg-type]


def fly(plan: Node, **more: object) -> tuple[Event, ...]:
    return rig(**more).fly(InOrder(steps=(plan,))).events


def whole(events: Sequence[Event]) -> list[str]:
    return [e.stretch for e in of_type(events, Worked) if e.status == "success"]


def end(events: Sequence[Event]) -> Ended:
    (ended,) = of_type(events, Ended)
    return ended


def test_a_row_is_sprayed_from_its_first_to_its_last_tree_and_the_amount_follows() -> None:
    events = fly(along("r0", parameters=(("rate_l_ha", 500.0),)))
    (working,), (worked,) = of_type(events, Working), of_type(events, Worked)
    assert working.parameters == {"rate_l_ha": 500.0}
    assert working.speed_m_s == 1.2
    assert (worked.status, worked.stretch[:6]) == ("success", "row r0")
    assert worked.worked_m == pytest.approx(20.0, abs=0.1)
    assert worked.area_m2 == pytest.approx(24.0, abs=0.2)
    assert (worked.amount, worked.unit) == (pytest.approx(24.0 * 500 / 10_000, rel=0.01), "l")
    assert worked.t - working.t == pytest.approx(20.0 / 1.2 + 0.5, abs=0.1)
    assert end(events).status == "completed"
    assert all(from_json(to_json(event)) == event for event in events)


def test_the_implement_is_off_in_a_gap() -> None:
    (worked,) = of_type(fly(along("r1"), site=gappy()), Worked)
    assert worked.worked_m == pytest.approx(15.0, abs=0.1)
    assert len(worked.paths) == 2
    assert worked.leg_m == pytest.approx(20.0, abs=0.1)


def test_a_drive_without_an_action_works_nothing_and_is_no_goal() -> None:
    task = task_for(InOrder(steps=(along("r0", action=""),)))
    assert task.command.goals == ()
    events = rig().fly(task).events
    (worked,) = of_type(events, Worked)
    assert (worked.worked_m, worked.paths, worked.status) == (0.0, (), "success")
    assert of_type(events, Working)[0].on == ()


def test_each_lap_is_a_stretch_of_its_own() -> None:
    events = fly(along("r0", laps=3))
    assert len(whole(events)) == 3
    assert len(set(whole(events))) == 3


# --- forecast ---------------------------------------------------------------------------------------------------------

plans = st.builds(
    along,
    *[st.sampled_from(("r0", "r1", "r2", "r3"))] * 2,
    action=st.sampled_from(("spray", "mow", "film", "")),
    sides=st.sampled_from(("one", "both", "north")),
    laps=st.integers(1, 2),
    order=st.sampled_from(("best", "given")),
)


@settings(max_examples=25, deadline=None)
@given(plan=plans, aisles=st.booleans())
def test_the_mission_costs_what_the_forecast_says(plan: WorkAlong, aisles: bool) -> None:
    if aisles:
        plan = replace(plan, mode="aisles", along=along("r0", "r1", "r2").along, sides="one")
    task = task_for(InOrder(steps=(plan,)))
    (branch,) = estimate(task, gappy(), tractor()).branches
    result = rig(site=gappy()).fly(task)
    assert result.status == "completed"
    assert result.spent.metres == pytest.approx(branch.metres.mean)
    assert result.spent.seconds == pytest.approx(branch.seconds.mean)
    assert result.spent.percent == pytest.approx(branch.percent.mean)
    forecast = [s.stretch.name for s in branch.walk.steps if s.stretch is not None]
    assert forecast == whole(result.events)


@settings(max_examples=10, deadline=None)
@given(seed=st.integers(0, 2**31))
def test_random_legs_cost_what_the_forecast_says_on_average(seed: int) -> None:
    robot = tractor(alpha=0.5)
    task = task_for(InOrder(steps=(along("r0", "r2"),)))
    (branch,) = estimate(task, SITE, robot, seed).branches
    spent = [rig(robot=robot, seed=seed + k).fly(task).spent.metres for k in range(30)]
    spread = float(np.std(spent)) / math.sqrt(len(spent))
    assert abs(float(np.mean(spent)) - branch.metres.mean) < 5.0 * spread + 1e-6


# --- faults -----------------------------------------------------------------------------------------------------------


def test_a_failing_implement_is_tried_again_from_where_it_stopped() -> None:
    events = fly(along("r0"), world=World(faults=(ActionFails(action="spray", times=1),)))
    first, second = of_type(events, Worked)
    assert (first.status, second.status) == ("failed", "success")
    assert first.worked_m + second.worked_m == pytest.approx(20.0, abs=0.1)
    assert [f.handled for f in of_type(events, Faulted)] == [True]
    assert end(events).status == "completed"
    ((goal,),) = [judge(task_for(InOrder(steps=(along("r0"),))), events)]
    assert (goal.outcome, goal.done, goal.wanted) == ("success", 1, 1)


def test_an_implement_that_keeps_failing_ends_the_plan_by_the_exit_for_actions() -> None:
    events = fly(along("r0", "r1"), world=World(faults=(ActionFails(action="spray"),)))
    assert [w.status for w in of_type(events, Worked)] == ["failed", "failed"]
    assert end(events).status == "faulted"
    assert "spray failed 2 times: spray gave an error" in end(events).reason
    (goal,) = judge(task_for(InOrder(steps=(along("r0", "r1"),))), events)
    assert (goal.outcome, goal.done) == ("failure", 0)


def test_a_failure_at_a_tree_happens_there() -> None:
    fault = ActionFails(action="spray", at=TreeRef(id="r0c3"), times=1)
    first, _ = of_type(fly(along("r0"), world=World(faults=(fault,))), Worked)
    x, _ = SITE.projection.metres(first.lat, first.lon)[0]
    assert x == pytest.approx(15.0, abs=0.2)


def test_a_try_catches_it_and_the_replay_agrees() -> None:
    tried = Try(body=along("r0"), otherwise=along("r1", action="mow"))
    events = fly(tried, world=World(faults=(ActionFails(action="spray"),)))
    assert end(events).status == "completed"
    sprayed, mown = judge(task_for(InOrder(steps=(tried,))), events)
    assert (sprayed.outcome, sprayed.done) == ("failure", 0)
    assert (mown.outcome, mown.done, mown.wanted) == ("success", 1, 1)


def test_beyond_an_obstacle_the_rest_is_worked_from_the_other_end() -> None:
    blocked = Blocked(at=TreeRef(id="r1c2"), within_m=1.6)
    plan = along("r1", "r3", sides="north")
    events = fly(plan, world=World(faults=(blocked,)))
    parts = [e for e in of_type(events, Worked) if e.stretch.startswith("row r1")]
    assert [p.status for p in parts] == ["failed", "success"]
    assert 8.0 < sum(p.worked_m for p in parts) < 19.0
    assert of_type(events, Obstructed)
    # The other row is worked all the same; then the plan fails, as part of it could not be done.
    assert any(name.startswith("row r3") for name in whole(events))
    (shed,) = of_type(events, Shed)
    assert (shed.cause, shed.places) == ("unreachable", (parts[0].stretch,))
    assert end(events).status == "faulted"
    (goal,) = judge(task_for(InOrder(steps=(plan,))), events)
    assert (goal.outcome, goal.done, goal.wanted) == ("failure", 1, 2)


def test_a_lost_position_is_waited_for_and_the_rest_is_worked() -> None:
    lost = LocalisationLost(at=TreeRef(id="r0c2"), within_m=2.0, for_s=20.0, times=1)
    events = fly(along("r0"), world=World(faults=(lost,)))
    assert [w.status for w in of_type(events, Worked)] == ["failed", "success"]
    assert sum(w.worked_m for w in of_type(events, Worked)) == pytest.approx(20.0, abs=0.1)
    assert end(events).status == "completed"


def test_a_failed_drive_to_a_stretch_is_tried_again() -> None:
    events = fly(along("r0"), world=World(faults=(DriveFails(times=1),)))
    assert end(events).status == "completed"
    assert len(whole(events)) == 1


@pytest.mark.parametrize("at_s", [5.0, 12.0, 18.0])
def test_an_emergency_stop_ends_the_work_where_it_is(at_s: float) -> None:
    events = fly(along("r0", "r1"), world=World(faults=(RobotStops(at_s=at_s),)))
    assert end(events).status == "aborted"
    assert all(w.status != "success" for w in of_type(events, Worked)) or at_s > 15.0
    assert sum(w.worked_m for w in of_type(events, Worked)) < 40.0


def test_an_operator_can_stop_it_at_any_look() -> None:
    cancelled = 0
    for n in range(1, 30):
        asked = itertools.count()
        events = (
            rig().fly(along("r0"), interrupted=lambda n=n, asked=asked: "enough" if next(asked) >= n else None).events
        )
        worked = of_type(events, Worked)
        assert len(worked) <= 1
        assert all(w.worked_m < 20.1 and (w.status == "success") == (w.worked_m > 19.9) for w in worked)
        cancelled += any(w.status == "cancelled" for w in worked)
    assert cancelled


# --- budget -----------------------------------------------------------------------------------------------------------


def guarded(plan: Node, metres: float) -> tuple[Event, ...]:
    constraints = Constraints(budgets=(Budget(kind="distance_m", limit=metres),))
    task = task_for(InOrder(steps=(plan,)), constraints=constraints)
    guard = BudgetGuard(task, SITE, tractor(), drives_for(SITE, tractor()), 0)
    return rig(guard=guard).fly(task).events


def test_as_much_as_fits_is_worked_and_the_rest_is_left_out() -> None:
    everything = fly(along("r0", "r1", "r2", "r3"))
    driven = end(everything).travelled_m
    few = guarded(along("r0", "r1", "r2", "r3", optional=True), 0.7 * driven)
    assert end(few).status == "completed"
    assert end(few).travelled_m <= 0.7 * driven + 1e-6
    assert 1 <= len(whole(few)) < 4
    shed = {place for event in of_type(few, Shed) for place in event.places}
    assert len(shed) + len(whole(few)) == 4
    assert all(event.optional for event in of_type(few, Shed))
    assert len(whole(guarded(along("r0", "r1", "r2", "r3", optional=True), 1.05 * driven))) == 4


def test_mandatory_work_beyond_the_budget_turns_home_in_time() -> None:
    driven = end(fly(along("r0", "r1", "r2", "r3"))).travelled_m
    events = guarded(along("r0", "r1", "r2", "r3"), 0.6 * driven)
    assert end(events).status == "returned"
    assert end(events).travelled_m <= 0.6 * driven + 1e-6
    (goal,) = judge(task_for(InOrder(steps=(along("r0", "r1", "r2", "r3"),))), events)
    assert goal.outcome == "failure"
    assert goal.done == len(whole(events))


# --- driver -----------------------------------------------------------------------------------------------------------


def test_the_simulated_robot_follows_the_path_and_uses_the_power_of_the_implement() -> None:
    setup = rig(robot=tractor(alpha=0.2))
    driver: SimulatedDriver = setup.driver()
    path = ((-5.0, 0.0), (-5.0, 30.0))
    place = replace(SITE.start, x=-5.0, y=30.0)
    for work, joules in ((None, 0.0), (StretchWork(action="mow", on=((0.0, 10.0),)), 3000.0 * (10.0 / 1.0 + 2.0))):
        before = driver.charge_percent()
        driver.start_drive(
            DriveGoal(place=place, path_m=path, path_degrees=(), length_m=30.0, speed_m_s=1.0, work=work)
        )
        setup.clock.advance(driver.next_event_in() or 0.0)
        progress = driver.poll()
        assert progress.state == "succeeded"
        used = setup.robot.percent(progress.metres, progress.seconds, joules)
        assert before - driver.charge_percent() == pytest.approx(used)
        if work is not None:
            assert progress.metres == 30.0
            assert progress.seconds == pytest.approx(32.0)


def test_arrivals_alternate_with_work() -> None:
    kinds = [type(e) for e in fly(along("r0", "r1", "r2")) if isinstance(e, Arrived | Working | Worked)]
    assert all(pair != (Working, Working) for pair in itertools.pairwise(kinds))
