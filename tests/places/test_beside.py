"""Sides of trees: the robot stands in the aisle on the side that is named, and both sides are two stops."""

from __future__ import annotations

import itertools
from dataclasses import replace

import pytest
from hypothesis import given, settings

from fieldhand import mission
from fieldhand.approval.checks import check
from fieldhand.errors import PlaceError
from fieldhand.evaluation.outcome import judge
from fieldhand.evaluation.report.log_facts import places_ahead
from fieldhand.forecast.visit_order import drives_for
from fieldhand.forecast.walk_branch import walk_branch
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import AlongRow, Beside, InRow, Marker, Ordered, Rows, TreeIs, Trees, UnionOf
from fieldhand.places.wording import say_selector
from fieldhand.site.loader import open_site
from fieldhand.site.model import Place, Site
from fieldhand.task.plan import Act, ForEach, InOrder, Node
from fieldhand.task.results import Acted, Arrived, Visiting
from fieldhand.testing import small_orchard
from fieldhand.testing.generated.orchards import orchard_sites
from support.examples import examples
from support.missions.rig import approved, husky, of_type, orchard, task_for

CO2 = Act(action="read_co2")


def demo() -> Site:
    return open_site("demo")


def places(selector: Selector, site: Site) -> tuple[Place, ...]:
    return resolve(selector, site, Context(here=site.start))


def stands(selector: Selector, site: Site) -> list[Place]:
    return list(drives_for(site, husky()).stands(places(selector, site)))


def flown(plan: Node, site: Site) -> list:
    run = mission.simulate(approved(task_for(plan), site, husky()), seed=1, speed=None)
    assert run.result.status == "completed"
    return list(run.result.events)


@pytest.mark.parametrize(("side", "sign"), [("west", -1.0), ("east", 1.0)])
def test_the_stand_lies_on_the_side_that_is_named(side: str, sign: float) -> None:
    for place in stands(Beside(side=side, of=Trees()), demo()):  # type: ignore[arg-type]
        assert place.stand is not None
        assert sign * (place.stand[0] - place.x) > 0.5


def test_rows_that_run_east_to_west_have_a_north_and_a_south_side() -> None:
    site = orchard(3, 8)
    for place in stands(Beside(side="both"), site):
        assert place.stand is not None
        assert {"north": 1.0, "south": -1.0}[place.side] * (place.stand[1] - place.y) > 0.3


def test_both_sides_are_every_tree_twice_and_one_side_of_a_row_after_the_other() -> None:
    found = places(Beside(side="both", of=Ordered(by="rows", of=Rows(first="2", last="3"))), demo())
    trees = places(Rows(first="2", last="3"), demo())
    assert sorted(p.key for p in found) == sorted(("tree", t.id, s) for t in trees for s in ("west", "east"))
    row_two = [p for p in found if p.id in {t.id for t in places(Rows(first="2", last="2"), demo())}]
    assert [side for side, _ in itertools.groupby(p.side for p in row_two)] == ["west", "east"]


@pytest.mark.parametrize(
    ("selector", "error"),
    [
        (Beside(side="north", of=TreeIs(tree="50")), "tree 50 has no north side"),
        (Beside(side="both", of=Marker(name="start")), "start has no sides"),
    ],
)
def test_a_side_that_a_place_does_not_have_is_refused(selector: Selector, error: str) -> None:
    with pytest.raises(PlaceError, match=error):
        places(selector, demo())


def test_a_side_that_cannot_be_reached_is_named_by_the_check() -> None:
    site = walled()
    plan = ForEach(select=Beside(side="both", of=TreeIs(tree="1")), body=CO2)
    found = check(mission.build_task(plan, site, husky()), site, husky())
    errors = [p.what for p in found if p.severity == "error"]
    assert len(errors) == 1
    assert errors[0].startswith("the south side of tree 1 is out of reach")


def walled() -> Site:
    """Four rows that run east, with a keep-out right beside the southern one."""
    return small_orchard.orchard(4, 10, [small_orchard.block("obstacle", "wall", (-0.5, -0.5), (-0.05, 9.5))])


def test_both_sides_are_driven_to_and_captured_once_each() -> None:
    site = demo()
    trees = InRow(first=3, last=6, of=Rows(first="4", last="5"))
    plan = ForEach(select=Beside(side="both", of=trees), body=CO2)
    events = flown(plan, site)
    captures = [(e.place, e.side) for e in of_type(events, Acted)]
    wanted = {
        (t.id, s) for t in places(InRow(first=3, last=6, of=Rows(first="4", last="5")), site) for s in ("west", "east")
    }
    assert sorted(captures) == sorted(wanted)
    (outcome,) = judge(task_for(plan), events)
    assert (outcome.outcome, outcome.done, outcome.wanted) == ("success", 16, 16)
    walked = walk_branch(task_for(plan), site, husky(), holds=lambda _: True)
    assert [(s.places[0].id, s.places[0].side) for s in walked.steps if s.kind == "act"] == captures
    shown = [e.drive.length_m for e in walked.steps if e.drive is not None]
    assert sum(shown) == pytest.approx(of_type(events, Arrived)[-1].travelled_m)


def test_a_log_that_ends_between_two_sides_lists_the_tree_as_not_reached() -> None:
    site = demo()
    plan = ForEach(select=Beside(side="both", of=TreeIs(tree="50")), body=CO2)
    events = flown(plan, site)
    first = next(k for k, e in enumerate(events) if isinstance(e, Acted))
    assert places_ahead(task_for(plan), events[: first + 1]) == ("50",)
    (outcome,) = judge(task_for(plan), events[: first + 1])
    assert (outcome.outcome, outcome.done, outcome.wanted) == ("indeterminate", 1, 2)
    assert of_type(events, Visiting)[0].sides in (("west", "east"), ("east", "west"))


def test_the_other_side_is_another_stop_and_any_side_is_not() -> None:
    """From a side the robot drives to the other one, but not for work on the tree from any side."""
    steps = (
        Act(action="read_co2", at=Beside(side="west", of=TreeIs(tree="50"))),
        Act(action="read_co2", at=TreeIs(tree="50")),
        Act(action="read_co2", at=Beside(side="east", of=TreeIs(tree="50"))),
        Act(action="read_co2"),
    )
    events = flown(InOrder(steps=steps), demo())
    assert [(e.place, e.side) for e in of_type(events, Arrived)] == [("50", "west"), ("50", "east"), ("end", "")]
    assert [e.side for e in of_type(events, Acted)] == ["west", "west", "east", "east"]


def test_places_after_a_side_count_from_its_tree() -> None:
    steps = (
        Act(action="read_co2", at=Beside(side="west", of=TreeIs(tree="50"))),
        Act(action="read_co2", at=AlongRow(trees=2, towards="north")),
    )
    events = flown(InOrder(steps=steps), demo())
    assert [e.place for e in of_type(events, Acted)] == ["50", "52"]


def test_a_union_of_sides_keeps_them_apart() -> None:
    both = UnionOf(parts=(Beside(side="west", of=TreeIs(tree="50")), Beside(side="east", of=TreeIs(tree="50"))))
    assert [p.side for p in places(both, demo())] == ["west", "east"]


def test_a_tree_in_no_row_is_approached_from_the_compass_side() -> None:
    site = small_orchard.orchard(1, 1)
    for side, (x, y) in {"north": (0, 1), "east": (1, 0), "south": (0, -1), "west": (-1, 0)}.items():
        (place,) = stands(Beside(side=side, of=TreeIs(tree="1")), site)  # type: ignore[arg-type]
        assert place.stand == pytest.approx((place.x + 1.5 * x, place.y + 1.5 * y))
    with pytest.raises(PlaceError, match="in no row"):
        places(Beside(side="both", of=TreeIs(tree="1")), site)


@settings(max_examples=examples(10, thorough=200), deadline=None)
@given(orchard_sites())
def test_the_sides_of_a_tree_lie_across_its_row_from_each_other(site: Site) -> None:
    planted = [tree.place.id for tree in site.trees if site.planting.row_of[tree.index] >= 0][:40]
    trees = UnionOf(parts=tuple(TreeIs(tree=tree) for tree in planted))
    drives = drives_for(site, husky())
    sides = [p for p in places(Beside(side="both", of=trees), site) if not drives.problem(p)]
    for place in drives.stands(sides):
        either = drives.stands((replace(place, side="", stand=None),))[0]
        assert place.stand is not None
        assert either.stand is not None
        to_east, to_north = place.stand[0] - place.x, place.stand[1] - place.y
        assert {"west": -to_east, "east": to_east, "south": -to_north, "north": to_north}[place.side] > 0.0
        # Without a side, the robot stands on one of the two.
        other = {"west": "east", "east": "west", "north": "south", "south": "north"}[place.side]
        opposite = replace(place, side=other, stand=None)
        options = [place.stand, *([] if drives.problem(opposite) else [drives.stands((opposite,))[0].stand])]
        assert either.stand in options


def test_sides_in_words() -> None:
    assert say_selector(Beside(side="both", of=TreeIs(tree="50"))) == "both sides of tree 50"
    assert say_selector(Beside(side="east", of=Rows(first="2", last="2"))) == "the east side of the trees of row 2"
