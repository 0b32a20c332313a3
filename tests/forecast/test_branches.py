"""Every branch that can be flown is explored, and its figures are those of missions that are flown."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.approval.checks import check, examine
from fieldhand.forecast import branches as exploration
from fieldhand.forecast import request_handler
from fieldhand.forecast.branches import branches
from fieldhand.forecast.estimate import estimate
from fieldhand.places.selectors import Bound, Here, Nearest, NotVisited, Take, TreeIs, Trees
from fieldhand.task.conditions import Compare, Level, TreeHas
from fieldhand.task.frames import Budget, Constraints
from fieldhand.task.plan import Act, ForEach, If, InOrder, Node, OptionalStep, Repeat, StopMission, Try
from fieldhand.task.results import Acted, Decided
from fieldhand.testing.small_orchard import block, husky, orchard, task_for
from support.missions.rig import Rig

SITE, ROBOT = orchard(), husky()
LOW = Level(reading="r", quantity="canopy_temperature", level="low")
HIGH = Level(reading="r", quantity="canopy_temperature", level="high")


def tree(name: str) -> TreeIs:
    return TreeIs(tree=name)


def picture(at: str = "", **more: object) -> Act:
    return Act(id="", action="take_thermal_picture", at=tree(at) if at else None, **more)


def line(*steps: Node) -> InOrder:
    return InOrder(id="", steps=steps)


def either(condition, then: Node, otherwise: Node | None = None) -> If:
    return If(id="", condition=condition, then=then, otherwise=otherwise)


# --- the figures ------------------------------------------------------------------------------------------------------

MISSIONS = 160
WAY = line(
    picture("7", reading="r"), either(LOW, line(picture("18"), picture("3", count=3)), picture("20")), picture("1")
)


@cache
def flown(plan: Node = WAY) -> list[tuple[tuple[tuple[str, bool], ...], float, float, float]]:
    """Missions that no guard holds back: what they decided, and what they used."""
    task = task_for(SITE, plan)
    found = []
    for seed in range(MISSIONS):
        result = Rig(site=SITE, robot=ROBOT, seed=seed).fly(task)
        decided = tuple((e.node, e.holds) for e in result.events if isinstance(e, Decided))
        found.append((decided, result.spent.metres, result.spent.seconds, result.spent.percent))
    return found


def test_distributions_and_chances_of_running_short_are_those_of_whole_missions():
    forecast = estimate(task_for(SITE, WAY), SITE, ROBOT)
    for branch in forecast.branches:
        answers = tuple((d.node, d.answer) for d in branch.decisions)
        some = np.array([used for decided, *used in flown() if decided == answers])
        assert len(some) > 25
        for column, figure in enumerate((branch.metres, branch.seconds, branch.percent)):
            for level, value in ((0.5, figure.p50), (0.9, figure.p90)):
                # Four standard errors of a share among the missions flown and among those drawn.
                error = 4 * math.sqrt(level * (1 - level) * (1 / len(some) + 1 / 2000))
                assert (some[:, column] <= value).mean() == pytest.approx(level, abs=error)
    limits = forecast.worst.metres.p50 * 1.1, forecast.worst.seconds.p50 * 1.05
    budgets = tuple(Budget(kind=k, limit=v) for k, v in zip(("distance_m", "duration_s"), limits, strict=True))
    tight = estimate(task_for(SITE, WAY, constraints=Constraints(budgets=budgets)), SITE, ROBOT)
    for branch in tight.branches:
        answers = tuple((d.node, d.answer) for d in branch.decisions)
        some = np.array([used for decided, *used in flown() if decided == answers])
        for column, limit in enumerate(limits):
            chance = branch.chances[column].chance
            error = 4 * math.sqrt(max(chance * (1 - chance), 0.01) * (1 / len(some) + 1 / 2000))
            assert (some[:, column] > limit).mean() == pytest.approx(chance, abs=error)


def test_more_draws_come_closer_to_what_is_exact():
    task = task_for(SITE, WAY)
    exact = sum(estimate(task, SITE, ROBOT).worst.walk.legs_m)

    def error(draws: int) -> float:
        return float(
            np.mean([(estimate(task, SITE, ROBOT, s, draws=draws).worst.metres.mean - exact) ** 2 for s in range(8)])
        )

    assert error(8000) < error(80) / 10


@given(st.lists(st.sampled_from([str(k) for k in range(1, 21)]), min_size=1, max_size=4), st.integers(1, 20))
@settings(max_examples=12, deadline=None)
def test_a_branch_that_drives_more_never_gets_cheaper(names: list[str], more: int):
    steps = [picture(name) for name in names]
    short, long = (
        estimate(task_for(SITE, line(*some)), SITE, ROBOT).worst for some in (steps, [*steps, picture(str(more))])
    )
    assert sum(long.walk.legs_m) >= sum(short.walk.legs_m) - 1e-6
    noise = 4 * 0.5 * math.sqrt((sum(x**2 for x in short.walk.legs_m) + sum(x**2 for x in long.walk.legs_m)) / 2000)
    assert long.metres.mean >= short.metres.mean - noise
    assert long.seconds.mean >= short.seconds.mean - noise


# --- the branches -----------------------------------------------------------------------------------------------------

conditions = st.one_of(
    st.sampled_from([LOW, HIGH, TreeHas(attribute="leaf_color", test="eq", value="yellow")]),
    st.builds(
        Compare,
        reading=st.sampled_from(["r", "s"]),
        quantity=st.just("canopy_temperature"),
        test=st.sampled_from(["lt", "ge", "eq"]),
        value=st.sampled_from([31.0, 32.0, 33.0]),
        unit=st.just("degC"),
    ),
)
acts = st.builds(picture, st.sampled_from(["", "2", "9"]), reading=st.sampled_from(["", "r", "s"]))


def _inside(steps: st.SearchStrategy[Node]) -> st.SearchStrategy[Node]:
    some = st.lists(steps, min_size=1, max_size=3).map(lambda s: line(*s))
    return st.one_of(
        some,
        st.builds(either, conditions, steps, st.none() | steps),
        st.builds(Repeat, id=st.just(""), times=st.integers(1, 2), body=steps, until=st.none() | conditions),
        st.builds(
            ForEach,
            id=st.just(""),
            select=st.just(Trees()),
            body=steps,
            at_most=st.integers(1, 2),
            until=st.none() | conditions,
        ),
        st.builds(Try, id=st.just(""), body=some, otherwise=steps),
    )


plans = st.recursive(acts | st.just(StopMission(id="")), _inside, max_leaves=8)


@given(plans, st.integers(0, 3))
@settings(max_examples=25, deadline=None)
def test_whatever_is_flown_was_explored(plan: Node, seed: int):
    task = task_for(SITE, line(picture("5", reading="r"), plan))
    found = branches(task, SITE, ROBOT)
    assert not found.broken
    result = Rig(site=SITE, robot=ROBOT, seed=seed).fly(task)
    decided = [(e.node, e.holds) for e in result.events if isinstance(e, Decided)]
    known = [[(d.node, d.answer) for d in w.decisions if d.kind == "holds"] for w in found.walks]
    if found.coverage == "enumerated":
        assert decided in known
        same = next(w for w, answers in zip(found.walks, known, strict=True) if answers == decided)
        captures = sum(isinstance(e, Acted) and e.status == "success" for e in result.events)
        assert any(
            sum(s.captures for s in w.steps) == captures
            for w, answers in zip(found.walks, known, strict=True)
            if answers == decided
        ), same
    assert all(w.steps[-1].kind == "exit" for w in found.walks)


def test_no_branch_is_both_hot_and_cold_and_the_site_is_known():
    yellow = TreeHas(attribute="leaf_color", test="eq", value="yellow")
    plan = line(
        picture("1", reading="r"), either(LOW, picture("2")), either(HIGH, picture("3")), either(yellow, picture("4"))
    )
    found = branches(task_for(SITE, plan), SITE, ROBOT)
    taken = {tuple(d.answer for d in w.decisions)[:2] for w in found.walks}
    assert taken == {(True, False), (False, True), (False, False)}
    # Tree 1 is yellow, trees 2 and 3 are not; of that nobody has to guess.
    for walked in found.walks:
        low, high, is_yellow = (d.answer for d in walked.decisions)
        assert is_yellow is (not low and not high)


@given(st.integers(2, 3), st.integers(1, 3), st.integers(0, 3))
@settings(max_examples=5, deadline=None)
def test_extremes_of_conditions_on_the_spot_hold_all_branches_between_them(trees: int, then: int, otherwise: int):
    more = picture(count=otherwise) if otherwise else None
    body = line(
        picture(reading="r"), either(LOW, picture(count=then), more), either(HIGH, Act(id="", action="read_co2"))
    )
    task = task_for(SITE, ForEach(id="", select=Trees(), body=body, at_most=trees))
    with pytest.MonkeyPatch.context() as patch:
        each = branches(task, SITE, ROBOT)
        patch.setattr(exploration, "_BY_THEMSELVES", 0)
        ends = branches(task, SITE, ROBOT)
    assert (each.coverage, ends.coverage) == ("enumerated", "bounded")
    assert len(each.walks) == 3**trees
    for amount in (0, 1):
        one, other = ([w.work[amount] for w in found.walks] for found in (each, ends))
        assert (min(one), max(one)) == (pytest.approx(min(other)), pytest.approx(max(other)))


def test_what_is_tried_fails_on_the_way_and_at_its_work_with_all_its_retries():
    plan = Try(id="", body=picture("1", count=2), otherwise=picture("20"))
    found = branches(task_for(SITE, plan), SITE, ROBOT)
    failing = {frozenset((d.kind, d.answer) for d in w.decisions): w for w in found.walks}
    assert len(failing) == 3
    stuck = failing[frozenset({("blocked", True)})]
    assert [s.reached for s in stuck.steps if s.kind == "drive"] == [False, True]
    broken = failing[frozenset({("blocked", False), ("fails", True)})]
    action = ROBOT.action["take_thermal_picture"]
    assert broken.work[0] == pytest.approx((2 + ROBOT.retries + 1) * action.duration_s)


def test_an_optional_step_is_explored_done_and_left_out():
    plan = line(picture("1"), OptionalStep(id="", body=picture("20")))
    found = branches(task_for(SITE, plan), SITE, ROBOT)
    done = {any(s.kind == "act" and s.places[0].id == "20" for s in w.steps) for w in found.optional_walks}
    assert done == {True, False}


# --- what is wrong on one branch --------------------------------------------------------------------------------------


def errors(plan: Node, site=SITE, **more):
    return [p for p in check(task_for(site, plan, **more), site, ROBOT) if p.severity == "error"]


def test_a_keep_out_on_one_branch_only_is_found():
    pond = orchard(zones=[block("keep_out", "pond", (0.5, 0.5), (1.5, 1.5))])
    near = Act(id="", action="read_co2", at=Nearest(to=Here(), fresh=True))
    around = [picture(name) for name in ("11", "17", "13", "12")]
    (error,) = errors(line(picture("2", reading="r"), either(LOW, line(*around, near))), pond)
    assert error.node == "n9"
    assert "is low" in str(error)
    assert not errors(line(picture("2", reading="r"), either(LOW, line(*around))), pond)


def test_a_place_that_only_one_branch_lacks_is_found_with_the_branch():
    few = orchard(rows=1, columns=2)
    last = Act(id="", action="read_co2", at=Take(count=1, of=NotVisited()))
    plan = line(picture("1", reading="r"), either(LOW, line(picture("2"), last)))
    (error,) = errors(plan, few)
    assert error.node == "n6"
    assert "(n3): yes" in error.what


def test_a_test_of_a_reading_that_another_branch_alone_binds_is_found():
    other = replace(LOW, reading="s")
    plan = line(picture("1", reading="r"), either(LOW, picture("2", reading="s")), either(other, picture("3")))
    (error,) = errors(plan)
    assert (error.node, "'s'" in error.what) == ("n5", True)
    assert "is low" in error.what
    assert not errors(line(picture("1", reading="r"), either(LOW, picture("2"), picture("3", reading="s"))))
    # A fault that leaves a reading out is for a person to judge.
    tried = line(Try(id="", body=picture("1", reading="r"), otherwise=picture("2")), either(LOW, picture("3")))
    assert {p.severity for p in check(task_for(SITE, tried), SITE, ROBOT)} == {"warning"}


def test_a_problem_names_node_words_and_place():
    plan = picture("99", said=((0, 5),), at_said=((7, 14),))
    (error,) = errors(plan, request="Shoot  tree 99 now")
    assert (error.node, error.words, error.place) == ("n1", "Shoot … tree 99", "tree 99")
    assert str(error).startswith("n1, “Shoot … tree 99”")


@pytest.mark.parametrize(
    ("plan", "said"),
    [
        (Repeat(id="", times=100_000, body=picture("1")), "at most"),
        (Repeat(id="", times=1000, body=Repeat(id="", times=1000, body=picture("1"))), "rounds"),
        (Repeat(id="", times=50, body=Repeat(id="", times=60, body=line(picture(), picture()))), "steps"),
        (ForEach(id="", select=Bound(label="nothing"), body=picture()), "nothing"),
        (either(LOW, picture("1")), "reading"),
    ],
    ids=["times", "rounds", "steps", "empty", "unread"],
)
def test_what_no_robot_could_do_is_a_line(plan: Node, said: str, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(request_handler, "MAX_NODES", 1000)
    found = errors(plan)
    assert found
    assert all(said in str(error) and "\n" not in str(error) for error in found)


def test_a_reserve_above_the_charge_is_a_line():
    found = examine(task_for(SITE, picture("1")), SITE, ROBOT, charge_percent=10.0)
    assert found.estimate is not None
    assert found.estimate.worst.chances[-1].chance == 1.0
    (error,) = found.errors
    assert "reserve" in error.what


def test_long_loops_with_a_condition_at_each_round_are_bounded():
    plan = Repeat(id="", times=150, body=line(picture(reading="r"), either(LOW, picture("1"))), until=HIGH)
    found = branches(task_for(SITE, plan), SITE, ROBOT)
    assert found.coverage == "sampled"
    assert len(found.walks) < exploration.MAX_WALKS
