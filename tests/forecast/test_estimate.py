"""What a Task will take, against figures worked out by hand and against plain sampling."""

import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.forecast.estimate import estimate, limit_problems
from fieldhand.forecast.mission_state import Spent, Visit
from fieldhand.forecast.remaining_work import remaining_work_after
from fieldhand.forecast.resource_limits import resource_limits
from fieldhand.forecast.visit_order import drives_for
from fieldhand.orienteering.overrun import overrun_probability
from fieldhand.places.context import Context
from fieldhand.places.selectors import Marker, TreeIs, Trees
from fieldhand.task.conditions import Level
from fieldhand.task.frames import Budget, Constraints
from fieldhand.task.plan import Act, ForEach, If, InOrder, Repeat
from fieldhand.testing.small_orchard import husky, orchard, task_for
from support.missions.paper import frames_at

SITE = orchard()
ROBOT = husky()
CERTAIN = replace(ROBOT, leg_cost=replace(ROBOT.leg_cost, alpha=1.0))
LOW = Level(reading="r", quantity="canopy_temperature", level="low")
ROUND = ForEach(id="", select=Trees(), body=Act(id="", action="take_thermal_picture"))


def limited(kind, limit, pf=0.1):
    return Constraints(budgets=(Budget(kind=kind, limit=limit, failure_probability=pf),))


def test_a_certain_robot_takes_what_arithmetic_says():
    plan = Act(id="", action="take_thermal_picture", at=TreeIs(tree="1"), count=3)
    found = estimate(task_for(SITE, plan), SITE, CERTAIN).worst
    drives = drives_for(SITE, CERTAIN)
    tree, home = SITE.by_id["1"].place, SITE.markers["end"]
    metres = drives.between(SITE.start, tree).length_m + drives.between(tree, home).length_m
    action = CERTAIN.action["take_thermal_picture"]
    seconds = metres / CERTAIN.speed_m_s + 3 * action.duration_s
    assert found.metres.mean == pytest.approx(metres) == pytest.approx(found.metres.p90)
    assert found.seconds.mean == pytest.approx(seconds)
    assert found.percent.mean == pytest.approx(CERTAIN.percent(metres, seconds, 3 * action.energy_j))
    assert found.captures == 3


def test_the_mean_is_the_length_and_the_spread_is_that_of_the_legs():
    found = estimate(task_for(SITE, ROUND), SITE, ROBOT).worst
    legs = np.array(found.walk.legs_m)
    assert found.metres.mean == pytest.approx(legs.sum(), rel=0.02)
    assert legs.sum() < found.metres.p90 < legs.sum() + 2.5 * 0.5 * np.sqrt((legs**2).sum())
    assert found.captures == 20
    assert found.walk.used.metres.std() == pytest.approx(0.5 * np.sqrt((legs**2).sum()), rel=0.1)


def test_the_same_seed_gives_the_same_estimate_and_a_slow_task_takes_longer():
    task = task_for(SITE, ROUND)
    assert estimate(task, SITE, ROBOT, 3) == estimate(task, SITE, ROBOT, 3)
    slow = task_for(SITE, ROUND, constraints=Constraints(speed_m_s=ROBOT.speed_m_s / 2))
    fast = estimate(task, SITE, ROBOT).worst
    work = fast.walk.work[0]
    assert estimate(slow, SITE, ROBOT).worst.seconds.mean - work == pytest.approx(2 * (fast.seconds.mean - work))


def test_the_chance_of_each_budget_is_that_of_the_tail():
    legs = np.array(estimate(task_for(SITE, ROUND), SITE, ROBOT).worst.walk.legs_m)
    for limit in (legs.sum() * 0.95, legs.sum() * 1.05, legs.sum() * 1.2):
        chance = estimate(task_for(SITE, ROUND, constraints=limited("distance_m", limit)), SITE, ROBOT).worst.chances[0]
        tail = float(overrun_probability(legs.sum(), (legs**2).sum() / 4, (legs**3).sum() / 4, limit))
        assert chance.chance == pytest.approx(tail, abs=0.04)


@pytest.mark.parametrize(("kind", "limit"), [("distance_m", 40.0), ("duration_s", 60.0), ("energy_percent", 0.5)])
def test_what_must_be_done_beyond_a_budget_is_a_problem_in_words(kind, limit):
    found = estimate(task_for(SITE, ROUND, constraints=limited(kind, limit)), SITE, ROBOT)
    assert len(found.problems) == 1
    assert "chance of running short" in found.problems[0]
    assert found.worst.chances[0].exceeded


def test_a_budget_that_does_not_last_for_the_way_home_is_a_problem():
    found = estimate(task_for(SITE, ROUND, constraints=limited("distance_m", 5.0)), SITE, ROBOT)
    assert "driving home from the start alone" in found.problems[0]


def test_an_empty_battery_is_a_problem_without_any_budget():
    found = estimate(task_for(SITE, ROUND), SITE, ROBOT, charge_percent=20.5)
    assert "reserve" in found.problems[0]
    assert estimate(task_for(SITE, ROUND), SITE, ROBOT).problems == ()


def test_optional_visits_are_no_problem_and_those_left_out_are_told():
    many = replace(ROUND, optional=True)
    found = estimate(task_for(SITE, many, constraints=limited("distance_m", 60.0)), SITE, ROBOT)
    assert found.problems == ()
    assert round(found.worst.visits) + len(found.worst.shed) == 20
    assert 3 <= found.worst.visits < 20
    assert found.worst.chances[0].chance <= 0.13


def test_the_worst_branch_is_the_one_that_takes_most():
    costly = If(id="", condition=LOW, then=Act(id="", action="take_thermal_picture", at=TreeIs(tree="20")))
    first = Act(id="", action="take_thermal_picture", at=TreeIs(tree="1"), reading="r")
    found = estimate(task_for(SITE, InOrder(id="", steps=(first, costly))), SITE, ROBOT)
    assert len(found.branches) == 2
    assert found.complete
    assert found.worst.decisions[0].answer is True
    assert found.worst.metres.mean == max(b.metres.mean for b in found.branches)


def test_an_estimate_as_a_record_is_json():
    found = estimate(task_for(SITE, ROUND, constraints=limited("distance_m", 400.0)), SITE, ROBOT)
    record = json.loads(json.dumps(found.as_record()))
    assert record["captures"] == 20


def test_every_limit_in_metres_allows_what_the_resource_allows():
    constraints = Constraints(
        budgets=(
            Budget(kind="distance_m", limit=100.0),
            Budget(kind="duration_s", limit=100.0),
            Budget(kind="energy_percent", limit=3.0),
        ),
        reserve_percent=30.0,
    )
    spent = Spent(metres=10.0, seconds=15.0, percent=1.0)
    for resource in resource_limits(constraints, ROBOT, 90.0):
        left = resource.metres_left(spent)
        seconds = left / ROBOT.speed_m_s
        used = spent + Spent(metres=left, seconds=seconds, percent=ROBOT.percent(left, seconds))
        assert resource.used(used) == pytest.approx(resource.limit)
    assert resource_limits(constraints, ROBOT, 90.0)[-1].limit == pytest.approx(60.0)


def test_the_rest_of_a_plan_is_what_stands_after_a_node_and_the_way_home():
    many = replace(ROUND, optional=True)
    last = Act(id="", action="take_thermal_picture", at=TreeIs(tree="20"), count=2)
    task = task_for(SITE, InOrder(id="", steps=(many, last)))
    drives = drives_for(SITE, ROBOT)
    rest = remaining_work_after(
        task, SITE, ROBOT, drives, frames_at(task.composition.plan, "n2"), Context(here=SITE.start)
    )
    tree = SITE.by_id["20"].place
    assert rest.first == tree
    assert rest.legs_m == pytest.approx((drives.between(tree, SITE.markers["end"]).length_m,))
    assert rest.work.seconds == pytest.approx(2 * ROBOT.action["take_thermal_picture"].duration_s)
    assert rest.mandatory


def test_the_rest_inside_a_loop_has_the_visits_that_are_still_to_come():
    inner = InOrder(
        id="", steps=(replace(ROUND, optional=True, select=TreeIs(tree="5")), Act(id="", action="read_co2"))
    )
    task = task_for(SITE, ForEach(id="", select=Trees(), body=inner))
    drives, here = drives_for(SITE, ROBOT), SITE.by_id["3"].place
    seconds = ROBOT.action["read_co2"].duration_s
    to_come = [Visit(place=t.place, service_s=seconds) for t in SITE.trees[3:]]
    context = Context(here=here, visited=("1", "2", "3"))
    rest = remaining_work_after(
        task, SITE, ROBOT, drives, frames_at(task.composition.plan, "n3"), context, to_come=to_come
    )
    # The step after it in this round, 17 more trees with one each, and the way home.
    assert rest.work.seconds == pytest.approx(18 * seconds)
    assert len(rest.legs_m) == 17
    assert rest.first == SITE.by_id["4"].place


@given(st.integers(1, 6).flatmap(lambda times: st.tuples(st.just(times), st.integers(1, times))))
@settings(max_examples=12, deadline=None)
def test_of_a_repeat_under_way_the_rounds_that_are_left_are_set_aside(rounds):
    times, done = rounds
    plan = Repeat(id="", times=times, body=Act(id="", action="read_co2"))
    task, drives = task_for(SITE, plan), drives_for(SITE, ROBOT)
    rest = remaining_work_after(
        task, SITE, ROBOT, drives, frames_at(task.composition.plan, "n2", done), Context(here=SITE.start)
    )
    assert rest.work.seconds == pytest.approx((times - done) * ROBOT.action["read_co2"].duration_s)


def test_the_rest_is_that_of_the_branch_that_takes_most_and_home_where_nothing_follows():
    longer = Repeat(id="", times=9, body=Act(id="", action="take_thermal_picture"))
    choice = If(id="", condition=LOW, then=Act(id="", action="read_co2"), otherwise=longer)
    many = replace(ROUND, optional=True)
    drives = drives_for(SITE, ROBOT)
    here = Context(here=SITE.markers["end"])
    task = task_for(SITE, InOrder(id="", steps=(many, choice)))
    rest = remaining_work_after(task, SITE, ROBOT, drives, frames_at(task.composition.plan, "n2"), here)
    assert rest.work.seconds == pytest.approx(9 * ROBOT.action["take_thermal_picture"].duration_s)
    task = task_for(SITE, many)
    alone = remaining_work_after(task, SITE, ROBOT, drives, frames_at(task.composition.plan, "n1"), here)
    assert (alone.first, alone.legs_m, alone.mandatory) == (SITE.markers["end"], (), False)
    task = task_for(SITE, many, nominal="stay")
    stays = remaining_work_after(task, SITE, ROBOT, drives, frames_at(task.composition.plan, "n1"), here)
    assert stays.first is None
    task = task_for(SITE, InOrder(id="", steps=(many, Act(id="", action="read_co2", at=Marker(name="start")))))
    back = remaining_work_after(
        task, SITE, ROBOT, drives, frames_at(task.composition.plan, "n2"), Context(here=SITE.start)
    )  # fmt: skip
    # It stands there already, and will have to come back.
    assert back.first == SITE.start


def test_what_must_be_done_is_judged_without_what_may_be_left_out() -> None:
    """A mandatory drive beyond the budget is a problem, even where an optional visit lies on its way for nothing."""
    from fieldhand.planning.english.planner import EnglishPlanner
    from fieldhand.planning.planner import Planned
    from fieldhand.robot.loader import load_robot
    from fieldhand.site.loader import open_site

    site, robot = open_site("demo"), load_robot("husky")

    def problems(request: str) -> tuple[str, ...]:
        outcome = EnglishPlanner().plan(request, site, robot)
        assert isinstance(outcome, Planned)
        return estimate(outcome.task, site, robot).problems

    far = "Go to tree 100. Then take pictures of as many trees as you can without driving more than {} m."
    assert any("what must be done" in sentence for sentence in problems(far.format(150)))
    assert problems(far.format(500)) == ()


def test_a_forecast_that_exceeds_what_is_accepted_is_said_of_optional_visits_too():
    limits = (Budget(kind="distance_m", limit=60.0), Budget(kind="duration_s", limit=2000.0))
    task = task_for(SITE, replace(ROUND, optional=True), constraints=Constraints(budgets=limits))
    found = estimate(task, SITE, ROBOT)
    assert found.worst.visits > 0
    assert found.problems == ()
    resources, drives = resource_limits(task.constraints, ROBOT, 100.0), drives_for(SITE, ROBOT)
    for kind, words in (("distance_m", "the distance budget of 60 m"), ("duration_s", "the time budget of 2000 s")):
        said = tuple(replace(c, chance=0.44 if c.kind == kind else c.chance) for c in found.worst.chances)
        branches = (found.worst, replace(found.worst, chances=said))
        (sentence,) = limit_problems(task, SITE, drives, resources, branches)
        assert words in sentence
        assert "44% chance of running short, but only 10% is accepted" in sentence


def test_branches_that_took_the_same_share_what_is_expected_of_optional_visits(monkeypatch) -> None:
    """The visits that follow depend on how many trees were measured twice, not on which."""
    from fieldhand.forecast import optional_work

    trees = ["1", "2", "3"]
    looks = [
        step
        for k, tree in enumerate(trees)
        for step in (
            Act(id="", action="take_thermal_picture", at=TreeIs(tree=tree), reading=f"r{k}"),
            If(id="", condition=replace(LOW, reading=f"r{k}"), then=Act(id="", action="read_co2", count=1)),
        )
    ]
    task = task_for(
        SITE, InOrder(id="", steps=(*looks, replace(ROUND, optional=True))), constraints=limited("distance_m", 120.0)
    )
    asked: list[str] = []
    real = optional_work.expected_visits

    def counted(walk, node, visits, rng, before=None):
        asked.append(node.id)
        return real(walk, node, visits, rng, before)

    monkeypatch.setattr(optional_work, "expected_visits", counted)
    shared = estimate(task, orchard(), ROBOT)
    some, _ = len(asked), asked.clear()
    monkeypatch.setattr(optional_work, "_state", lambda walker: iter((object(),)))
    alone = estimate(task, orchard(), ROBOT)
    assert some <= len(trees) + 1 < len(asked)
    assert len(shared.branches) == len(alone.branches) == 2 ** len(trees)
    for one, other in zip(shared.branches, alone.branches, strict=True):
        assert one.metres.mean == pytest.approx(other.metres.mean, rel=0.02)
        assert [c.chance for c in one.chances] == pytest.approx([c.chance for c in other.chances], abs=0.02)
