"""Whole missions with an optional step: done within a loose budget, shed within a tight one, met either way."""

from __future__ import annotations

from dataclasses import replace

import pytest
from shapely.geometry import Point

from fieldhand import mission
from fieldhand.approval.checks import check
from fieldhand.forecast.estimate import estimate
from fieldhand.places.selectors import Corners, TreeIs
from fieldhand.site.model import Zone
from fieldhand.task.frames import Budget, Constraints, Task
from fieldhand.task.plan import Act, AnyOrder, ForEach, InOrder, Node, OptionalStep
from fieldhand.task.results import Acted, Shed
from fieldhand.testing.small_orchard import husky, orchard, task_for
from support.missions.flights import Flight, fly_request, fly_task

SITE, ROBOT = orchard(rows=5, columns=6), husky()
PICTURE = "take_thermal_picture"


def act(tree: str = "", **more: object) -> Act:
    return Act(id="", action=PICTURE, at=TreeIs(tree=tree) if tree else None, **more)


def seq(*steps: Node) -> InOrder:
    return InOrder(id="", steps=steps)


def optional(*steps: Node) -> OptionalStep:
    return OptionalStep(id="", body=steps[0] if len(steps) == 1 else seq(*steps))


def without(node: InOrder | AnyOrder) -> Node:
    """Return the steps of a sequence or a set that must be done."""
    return replace(node, steps=tuple(step for step in node.steps if not isinstance(step, OptionalStep)))


def within(plan: Node, metres: float) -> Task:
    return task_for(SITE, plan, constraints=Constraints(budgets=(Budget(kind="distance_m", limit=metres),)))


def takes(plan: Node) -> float:
    """Metres that a plan takes in nine missions of ten."""
    return estimate(task_for(SITE, plan), SITE, ROBOT).worst.metres.p90


def visited(flight: Flight) -> list[str]:
    return [e.place for e in flight.events if isinstance(e, Acted) and e.status == "success"]


PLANS = {
    "one drive": seq(act("1"), optional(act("30")), act("2")),
    "several drives": seq(act("1"), optional(act("25"), act("30")), act("2")),
    "an any-order set": AnyOrder(id="", steps=(act("1"), optional(act("30")), act("2"))),
    "at the end": seq(act("1"), act("2"), optional(act("30"))),
    "a loop inside": seq(act("1"), optional(ForEach(id="", select=Corners(), body=act())), act("2")),
}


@pytest.mark.parametrize("plan", PLANS.values(), ids=PLANS.keys())
def test_within_a_tight_budget_the_step_is_shed_and_within_a_loose_one_done_and_both_missions_succeed(
    plan: Node,
) -> None:
    tight, loose = within(plan, 1.1 * takes(without(plan))), within(plan, 2.0 * takes(plan))
    for seed in range(4):
        short, long = fly_task(tight, SITE, seed=seed), fly_task(loose, SITE, seed=seed)
        assert {"1", "2"} == set(visited(short))
        assert {"1", "2", "30"} <= set(visited(long))
        for flight in (short, long):
            assert flight.end.status == "completed"
            assert flight.assessment.success
        assert flight.end.travelled_m <= loose.constraints.budgets[0].limit
        assert [e.optional for e in short.events if isinstance(e, Shed)] == [True]
        assert not any(isinstance(e, Shed) for e in long.events)


@pytest.mark.parametrize("plan", [PLANS["one drive"], PLANS["several drives"]])
def test_what_must_follow_is_lost_and_the_budget_exceeded_no_more_often_than_is_accepted(plan: Node) -> None:
    least, most = takes(without(plan)), takes(plan)
    missions = [
        fly_task(within(plan, least + share * (most - least)), SITE, seed=seed)
        for share in (0.1, 0.6, 1.1)
        for seed in range(8)
    ]
    assert all("1" in visited(flight) for flight in missions)
    lost = [f for f in missions if "2" not in visited(f)]
    late = [f for f in missions if f.end.travelled_m > f.task.constraints.budgets[0].limit]
    # One in ten is accepted at each decision; so many of 24 are more than that by chance once in a hundred times.
    assert len(lost) <= 7
    assert len(late) <= 7
    assert {"30" in visited(flight) for flight in missions} == {True, False}


def test_the_map_and_the_robot_agree_on_the_path_where_all_fits() -> None:
    task = within(PLANS["several drives"], 5000.0)
    planned = estimate(task, SITE, ROBOT).worst.walk
    flown = [e.place for e in fly_task(task, SITE).events if isinstance(e, Acted)]
    assert [s.places[0].id for s in planned.steps if s.kind == "act"] == flown


def test_without_a_budget_the_reserve_decides() -> None:
    plan = PLANS["one drive"]
    needs = estimate(task_for(SITE, without(plan)), SITE, ROBOT).worst.percent.p90
    for reserve, done in ((20.0, True), (100.0 - 1.2 * needs, False)):
        task = task_for(SITE, plan, constraints=Constraints(reserve_percent=reserve))
        flight = fly_task(task, SITE)
        assert flight.assessment.success
        assert ("30" in visited(flight)) is done


def test_a_step_that_cannot_be_driven_to_is_left_out_and_the_person_who_approves_is_told() -> None:
    pond = Zone(name="pond", kind="keep_out", polygon=Point(*SITE.by_id["30"].place.xy).buffer(0.8))
    site = replace(SITE, zones=(pond,))
    for plan in (PLANS["several drives"], PLANS["an any-order set"]):
        task = task_for(site, plan)
        (found,) = check(task, site, ROBOT)
        assert found.severity == "warning"
        assert "an optional step will be left out: tree 30 is" in found.what
        flight = fly_task(task, site)
        assert flight.assessment.success
        assert set(visited(flight)) == {"1", "2"}
        (shed,) = (e for e in flight.events if isinstance(e, Shed))
        assert "cannot be reached" in shed.reason


def test_an_optional_step_at_each_place_leaves_enough_for_every_place() -> None:
    loop = ForEach(id="", select=Corners(), body=seq(act(), optional(act(count=60))))
    plain = estimate(task_for(SITE, replace(loop, body=act())), SITE, ROBOT).worst.seconds
    more = 1.5 * 60 * ROBOT.action[PICTURE].duration_s
    constraints = Constraints(budgets=(Budget(kind="duration_s", limit=plain.p90 + more),))
    task = task_for(SITE, loop, constraints=constraints)
    assert mission.review(task, SITE, ROBOT).errors == ()
    for seed in range(4):
        flight = fly_task(task, SITE, seed=seed)
        counts = sorted(visited(flight).count(corner) for corner in set(visited(flight)))
        assert flight.assessment.success
        assert counts == [1, 1, 1, 61]


def test_what_is_asked_for_if_the_battery_allows_is_done_or_told_from_the_words_to_the_outcome() -> None:
    request = "Take a picture of the last tree{}. If the budget allows, also take a picture of the north-west corner."
    for limit, done in (("", 2), (", driving at most 150 m", 1)):
        flight = fly_request(request.format(limit))
        assert flight.assessment.success
        assert len(visited(flight)) == done
        assert [o.done for o in flight.assessment.outcomes] == [1, done - 1]
        shed = [e for e in flight.events if isinstance(e, Shed)]
        assert len(shed) == 2 - done
        assert all(e.optional and "chance of running short" in e.reason for e in shed)
