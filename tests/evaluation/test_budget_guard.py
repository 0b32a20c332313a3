"""The budget guard over missions driven on paper: budgets kept, what must be done protected, reasons in words."""

import re
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.execution.guard import Guard
from fieldhand.forecast.mission_state import Spent, Visit
from fieldhand.forecast.service import service_of
from fieldhand.forecast.visit_order import drives_for, visits_in_order, with_stands
from fieldhand.forecast.walk_branch import walk_branch
from fieldhand.orienteering.overrun import overrun_probability
from fieldhand.places.selectors import TreeIs, Trees
from fieldhand.site.loader import load_site
from fieldhand.task.frames import Budget, Constraints
from fieldhand.task.plan import Act, ForEach, InOrder, Repeat
from fieldhand.task.results import Shed
from fieldhand.testing.small_orchard import block, husky, orchard, task_for
from fieldhand.wording.events import EventText
from support.missions.paper import Paper

ROBOT = husky()
CERTAIN = replace(ROBOT, leg_cost=replace(ROBOT.leg_cost, alpha=1.0))
SITE = orchard()
TREES = [t.place for t in SITE.trees]
ORCHARD = Path(__file__).parents[3] / "shared" / "data" / "farms" / "reza_medium.geojson"

PICTURE = Act(id="", action="take_thermal_picture")
MANY = ForEach(id="n1", select=Trees(), body=PICTURE, optional=True)
ALL = ForEach(id="n1", select=Trees(), body=PICTURE)


def limited(limit, kind="distance_m", pf=0.1):
    return Constraints(budgets=(Budget(kind=kind, limit=limit, failure_probability=pf),))


def lasts(places, chance):
    """Metres that the drives from place to place exceed with that chance."""
    legs = np.array([drives_for(SITE, ROBOT).between(a, b).length_m for a, b in pairwise(places)])
    metres = np.arange(legs.sum(), 2 * legs.sum(), 0.5)
    return float(
        metres[np.argmax(overrun_probability(legs.sum(), (legs**2).sum() / 4, (legs**3).sum() / 4, metres) <= chance)]
    )


def optional_mission(site, seed, constraints, robot=ROBOT, node=MANY, nominal="return_to_end"):
    paper = Paper(task_for(site, node, constraints=constraints, nominal=nominal), site, robot, seed)
    choice = paper.optional(node, [t.place for t in site.trees])
    if nominal != "stay":
        paper.home()
    return paper, choice


def no_more_often(failures, missions, pf=0.1):
    return failures <= pf * missions + 3 * np.sqrt(pf * (1 - pf) * missions)


@cache
def hundred_metres():
    """Fifteen missions on the published orchard, 100 m each, which end where the last visit is."""
    site = load_site(ORCHARD)
    return [optional_mission(site, seed, limited(100.0), nominal="stay")[0] for seed in range(15)]


@pytest.mark.skipif(not ORCHARD.exists(), reason="the published orchard is not beside this repository")
def test_on_a_hundred_metres_of_the_published_orchard_eighteen_trees_are_visited_and_the_budget_is_kept():
    missions = hundred_metres()
    assert np.mean([len(m.visited) for m in missions]) >= 20
    assert np.mean([len(m.visited) >= 18 for m in missions]) >= 0.85
    assert no_more_often(sum(m.spent.metres > 100.0 for m in missions), len(missions))


@pytest.mark.parametrize(
    ("kind", "limit", "used"),
    [
        ("distance_m", 60.0, lambda s: s.metres),
        ("duration_s", 110.0, lambda s: s.seconds),
        ("energy_percent", 1.2, lambda s: s.percent),
    ],
)
def test_missions_of_each_kind_of_budget_keep_it_and_put_it_to_use(kind, limit, used):
    missions = [optional_mission(SITE, seed, limited(limit, kind))[0] for seed in range(16)]
    assert no_more_often(sum(used(m.spent) > limit for m in missions), len(missions))
    assert all(len(m.visited) < 20 for m in missions)
    assert np.mean([used(m.spent) for m in missions]) > 0.6 * limit


@given(seed=st.integers(0, 10_000), rows=st.integers(1, 3), columns=st.integers(2, 5), budget=st.floats(30.0, 150.0))
@settings(max_examples=10, deadline=None)
def test_a_robot_with_certain_legs_never_exceeds_its_budget(seed, rows, columns, budget):
    site = orchard(rows, columns)
    paper, _ = optional_mission(site, seed, limited(budget), robot=CERTAIN)
    assert paper.spent.metres <= budget + 1e-6
    assert len(set(paper.visited)) == len(paper.visited)
    again, _ = optional_mission(site, seed, limited(budget), robot=CERTAIN)
    assert again.visited == paper.visited


def test_the_same_seed_gives_the_same_mission():
    one, two = (optional_mission(SITE, 5, limited(60.0))[0] for _ in range(2))
    assert (one.visited, one.spent) == (two.visited, two.spent)


def test_without_a_budget_every_optional_visit_is_made_and_the_reserve_is_still_guarded():
    paper, choice = optional_mission(SITE, 0, None)
    assert len(paper.visited) == 20
    assert choice.shed == ()
    # A reserve of all but a little: 1.2 % of this battery are about 130 m.
    missions = [optional_mission(SITE, seed, Constraints(reserve_percent=98.8)) for seed in range(20)]
    assert all(0 < len(short.visited) < 20 for short, _ in missions)
    assert no_more_often(sum(short.spent.percent > 1.2 for short, _ in missions), 20)
    assert all("above the reserve" in reason for short, _ in missions for _, reason in short.shed)


def test_the_visits_that_are_worth_most_are_made():
    node = replace(MANY, reward="reward")
    budgets = (55.0, 65.0, 75.0, 85.0)
    for budget in budgets:
        paper, _ = optional_mission(SITE, 0, limited(budget), robot=CERTAIN, node=node)
        plain, _ = optional_mission(SITE, 0, limited(budget), robot=CERTAIN)
        worth = [sum(int(name) for name in m.visited) for m in (paper, plain)]
        assert worth[0] >= worth[1]
        if worth[0] > worth[1]:
            return
    pytest.fail("rewards never changed which visits were made")


def test_every_optional_visit_that_is_not_made_is_given_up_once_and_with_a_reason():
    for seed in range(5):
        paper, _ = optional_mission(SITE, seed, limited(60.0))
        given_up = [tree for tree, _ in paper.shed]
        assert sorted([*given_up, *paper.visited], key=int) == [t.id for t in TREES]
        assert all("chance of running short" in why for _, why in paper.shed)
        assert all(tree in why or "more" in why for tree, why in paper.shed)


def test_what_must_follow_is_set_aside_before_optional_visits_are_made():
    last = Act(id="", action="take_thermal_picture", at=TreeIs(tree="16"))
    plan = InOrder(id="", steps=(MANY, last))
    limit, kept, failed = 75.0, 0, 0
    for seed in range(25):
        paper = Paper(task_for(SITE, plan, constraints=limited(limit)), SITE, ROBOT, seed)
        paper.optional(replace(MANY, id="n2"), TREES)
        kept += paper.mandatory(replace(last, id="n4"), SITE.by_id["16"].place).go
        paper.home()
        failed += paper.spent.metres > limit
    assert kept >= 22
    assert no_more_often(failed, 25)


def test_a_mandatory_visit_that_fits_is_admitted_and_one_that_does_not_is_refused_in_words():
    plan = Act(id="", action="take_thermal_picture", at=TreeIs(tree="20"))
    paper = Paper(task_for(SITE, plan, constraints=limited(200.0)), SITE, ROBOT, 0)
    assert paper.mandatory(replace(plan, id="n1"), SITE.by_id["20"].place).go
    tight = Paper(task_for(SITE, plan, constraints=limited(45.0)), SITE, ROBOT, 0)
    verdict = tight.mandatory(replace(plan, id="n1"), SITE.by_id["20"].place)
    assert not verdict.go
    assert verdict.chance_short > 0.1
    assert verdict.reason.startswith("45 m left; going to tree 20 and home takes ")
    assert verdict.reason.endswith(f"{100 * verdict.chance_short:.0f} % chance of running short")
    assert tight.visited == ()


def test_a_round_of_short_legs_is_admitted_where_one_long_way_home_would_be_too_uncertain():
    # Seventy trees in a row, home at the far end: straight home from the first is 345 m in one leg.
    site = orchard(1, 70)
    drives = drives_for(site, ROBOT)
    places = [t.place for t in site.trees]
    length = drives.between(places[0], places[-1]).length_m
    paper = Paper(task_for(site, ALL, constraints=limited(1.25 * length)), site, ROBOT, 0)
    later = [paper.visit(p, PICTURE) for p in places]
    assert paper.mandatory(replace(ALL.body, id="n1"), places[0]).go is False
    assert paper.guard.admit(paper.state("n1"), later[0], later[1:]).go


def test_mandatory_missions_exceed_their_budget_no_more_often_than_accepted():
    failed = done = 0
    for seed in range(40):
        paper = Paper(task_for(SITE, ALL, constraints=limited(118.0)), SITE, ROBOT, seed)
        order = [*TREES[:5], *TREES[9:4:-1], *TREES[10:15], *TREES[19:14:-1]]
        for k, place in enumerate(order):
            later = [paper.visit(p, PICTURE) for p in order[k + 1 :]]
            if not paper.mandatory(replace(PICTURE, id="n1"), place, later).go:
                break
        done += len(paper.visited)
        paper.home()
        failed += paper.spent.metres > 118.0
    assert no_more_often(failed, 40)
    assert done > 0.5 * 40 * 20


#: Every tree in the order that drives least, each from the aisle that it is best worked on from.
ROUND = visits_in_order(ALL, drives_for(SITE, ROBOT), SITE.start, TREES, SITE.markers["end"])

#: Metres that last for the round with a chance of a few percent of running short.
LASTS = lasts([SITE.start, *ROUND, SITE.markers["end"]], 0.06)


def rounds(limit, missions, before=None):
    """Missions that must visit every tree, after optional ones: how many of them do, and how many exceed the limit."""
    plan = ALL if before is None else InOrder(id="", steps=(before, ALL))
    task = task_for(SITE, plan, constraints=limited(limit))
    drives = drives_for(SITE, ROBOT)
    loop = "n1" if before is None else "n4"
    done = failed = 0
    for seed in range(missions):
        paper, order = Paper(task, SITE, ROBOT, seed, drives), tuple(ROUND)
        if before is not None:
            paper.optional(replace(before, id="n2"), TREES)
            order = visits_in_order(ALL, drives, paper.here, TREES, SITE.home("return_to_end", paper.here))
        for k, place in enumerate(order):
            later = [paper.visit(p, PICTURE) for p in order[k + 1 :]]
            if not paper.mandatory(replace(PICTURE, id=loop), place, later).go:
                break
        else:
            done += 1
        paper.home()
        failed += paper.spent.metres > limit
    return done, failed


@pytest.mark.parametrize("limit", [104.0, 110.0, 118.0, 125.0])
def test_mandatory_missions_do_not_exceed_their_budget_more_often_than_accepted_however_tight_it_is(limit):
    _, failed = rounds(limit, 150)
    assert no_more_often(failed, 150)


def test_a_mandatory_mission_that_is_safe_enough_at_its_start_is_carried_out():
    paper = Paper(task_for(SITE, ALL, constraints=limited(LASTS)), SITE, ROBOT, 0)
    later = [paper.visit(p, PICTURE) for p in ROUND]
    chance = paper.guard.admit(paper.state("n1"), later[0], later[1:]).chance_short
    assert 0.03 < chance < 0.1
    done, failed = rounds(LASTS, 150)
    assert done >= 150 * (1 - chance) - 3 * np.sqrt(150 * chance * (1 - chance))
    assert no_more_often(failed, 150, chance)


def test_mandatory_visits_after_optional_ones_are_carried_out_as_often_as_the_budget_was_to_last():
    done, failed = rounds(160.0, 60, before=replace(MANY, at_most=4))
    assert done >= 60 * 0.9 - 3 * np.sqrt(60 * 0.09)
    assert no_more_often(failed, 60)


def test_work_allowed_with_a_visit_is_not_asked_for_again_but_what_follows_the_loop_at_that_place_is():
    loop = ForEach(id="", select=TreeIs(tree="1"), body=PICTURE)
    plan = InOrder(id="", steps=(loop, Repeat(id="", times=40, body=PICTURE)))
    paper = Paper(task_for(SITE, plan, constraints=limited(200.0, "duration_s")), SITE, ROBOT, 0)
    tree = SITE.by_id["1"].place
    assert paper.mandatory(replace(loop, id="n2"), tree).go
    costly = replace(paper.visit(tree, PICTURE), service_s=1000.0)
    assert paper.guard.admit(paper.state("n3"), costly).go
    assert not paper.guard.admit(paper.state("n5"), costly).go
    assert not paper.guard.admit(paper.state("n3"), costly).go


@pytest.mark.parametrize("at_most", [1, 2])
@pytest.mark.parametrize("limit", [45.0, 60.0, 90.0])
def test_where_only_so_many_visits_may_be_made_the_robot_makes_those_of_the_preview(at_most, limit):
    node = replace(MANY, at_most=at_most, reward="reward")
    task = task_for(SITE, node, constraints=limited(limit))
    walked = walk_branch(task, SITE, CERTAIN, holds=lambda _: True)
    (shown,) = [[p.id for p in s.places] for s in walked.steps if s.kind == "visit-list"]
    paper, _ = optional_mission(SITE, 0, limited(limit), robot=CERTAIN, node=node)
    assert len(shown) == at_most
    assert list(paper.visited) == shown
    first = [str(k + 1) for k in range(at_most)]
    assert shown != first


def test_trees_that_cannot_be_reached_are_given_up_and_named():
    site = orchard(zones=[block("keep_out", "pond", (1.5, 1.5), (2.5, 2.5))])
    inside = site.by_id["13"].place
    paper = Paper(task_for(site, MANY), site, ROBOT, 0)
    visits = [Visit(place=p) for p in (inside, site.by_id["1"].place)]
    choice = paper.guard.choose(paper.state("n1"), visits)
    assert (choice.index, choice.shed) == (1, (0,))
    assert "tree 13" in choice.reason
    only = paper.guard.choose(paper.state("n1"), visits[:1])
    assert (only.index, only.shed) == (None, (0,))
    assert only.reason == "there is no way to tree 13"


def test_the_line_of_a_mission_under_way_names_what_is_left_out_once():
    paper, _ = optional_mission(SITE, 0, limited(60.0))
    by_reason = {why: tuple(tree for tree, said in paper.shed if said == why) for _, why in paper.shed}
    assert by_reason
    for why, trees in by_reason.items():
        shed = Shed(t=1.0, node="n1", places=trees, optional=True, reason=why, names_places=True)
        line = EventText(ROBOT).line(shed)
        assert line.startswith("    0:01     left out: tree")
        named = line.removeprefix("    0:01     left out: ").partition(":")[0]
        assert len(re.findall(rf"\b{trees[0]}\b", named)) == 1
    other = Shed(t=1.0, node="n1", places=("7",), optional=True, reason="too far")
    assert EventText(ROBOT).line(other) == "    0:01     left out: 7 (too far)"


def test_overspent_the_guard_sends_nobody_anywhere():
    paper = Paper(task_for(SITE, MANY, constraints=limited(60.0)), SITE, ROBOT, 0)
    paper.spent = Spent(metres=70.0, seconds=70.0, percent=0.7)
    paper.here = TREES[0]
    choice = paper.guard.choose(paper.state("n1"), [Visit(place=TREES[19])])
    assert (choice.index, choice.shed) == (None, (0,))
    assert not paper.guard.admit(paper.state("n1"), Visit(place=TREES[19])).go


def test_no_candidates_no_choice():
    paper = Paper(task_for(SITE, MANY), SITE, ROBOT, 0)
    assert paper.guard.choose(paper.state("n1"), []).index is None


def test_the_guard_is_what_execution_asks_for():
    guard: Guard = Paper(task_for(SITE, MANY), SITE, ROBOT, 0).guard
    assert guard.choose is not None


@pytest.mark.parametrize("seed", [0, 7])
def test_the_robot_sets_out_along_the_order_that_was_forecast(seed):
    site = orchard(6, 12)
    task = task_for(site, MANY, constraints=limited(150.0), nominal="return_to_end")
    forecast = next(s for s in walk_branch(task, site, ROBOT, holds=lambda _: False).steps if s.kind == "visit-list")
    paper, _ = optional_mission(site, seed, limited(150.0))
    shown = [p.id for p in forecast.places]
    # A place that is as likely as one that is shown may come between.
    assert [place for place in paper.visited if place in shown][:3] == shown[:3]


@pytest.mark.parametrize("chance", [0.3, 0.5, 0.7])
def test_a_robot_that_leaves_its_places_in_between_still_has_what_it_collected_at_stake(chance):
    """Twelve visits are not risked for a thirteenth, from a place where no visit was, such as a charger."""
    paper = Paper(task_for(SITE, MANY, constraints=limited(400.0), nominal="return_to_end"), SITE, ROBOT, 3)
    left = list(with_stands(paper.drives, paper.here, TREES))
    for _ in range(12):
        index = paper.guard.choose(paper.state("n1"), [paper.visit(p, MANY) for p in left]).index
        assert index is not None
        paper.go(left.pop(index), service_of(PICTURE, ROBOT))
    home = paper.here = SITE.home("return_to_end", TREES[0])
    far = sorted(left, key=lambda place: paper.drives.between(place, home).length_m)[-2:]
    needed = min(lasts([home, place, home], chance) for place in far)
    paper.spent = replace(paper.spent, metres=400.0 - needed)
    assert paper.guard.choose(paper.state("n1"), [paper.visit(p, MANY) for p in far]).index is None
