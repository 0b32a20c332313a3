"""Orders of visits and the rule for the way home."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import PlaceError
from fieldhand.forecast.visit_order import (
    drives_for,
    ends_plan,
    home_if_last,
    order_visits,
    steps_in_order,
    visits_in_order,
    with_stands,
)
from fieldhand.places.context import Context
from fieldhand.places.selectors import Extreme, TreeIs, Trees, Where
from fieldhand.task.build import number
from fieldhand.task.conditions import TreeHas
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, If, InOrder, Repeat, Try
from fieldhand.testing.small_orchard import husky, orchard, task_for

SITE = orchard()
DRIVES = drives_for(SITE, husky())
TREES = [t.place for t in SITE.trees]


def act(at=None):
    return Act(id="", action="take_thermal_picture", at=at)


def length(places):
    return sum(DRIVES.between(a, b).length_m for a, b in pairwise(places))


@given(chosen=st.lists(st.sampled_from(TREES), min_size=0, max_size=12, unique_by=lambda p: p.id), home=st.booleans())
@settings(max_examples=30, deadline=None)
def test_an_order_has_every_place_once_and_is_no_longer_than_the_one_given(chosen, home):
    to = SITE.markers["end"] if home else None
    chosen = with_stands(DRIVES, SITE.start, chosen)
    order = order_visits(DRIVES, SITE.start, chosen, to)
    assert sorted(order) == list(range(len(chosen)))
    tail = [] if to is None else [to]
    ordered = length([SITE.start, *(chosen[i] for i in order), *tail])
    assert ordered <= length([SITE.start, *chosen, *tail]) + 1e-6


def test_the_way_home_decides_which_end_of_a_row_comes_last():
    row = TREES[:5]
    assert order_visits(DRIVES, SITE.start, row, SITE.markers["end"]) == (0, 1, 2, 3, 4)
    assert order_visits(DRIVES, SITE.markers["end"], row, SITE.start) == (4, 3, 2, 1, 0)


def test_at_most_keeps_the_nearest_of_a_free_order_and_the_first_of_a_given_one():
    free = ForEach(id="", select=Trees(), body=act(), at_most=2)
    given_ = ForEach(id="", select=Trees(), body=act(), at_most=2, order="given")
    backwards = TREES[::-1]
    stands = with_stands(DRIVES, SITE.start, backwards)
    first = int(DRIVES.lengths([SITE.start, *stands])[0, 1:].argmin())
    among = np.where(np.arange(20) == first, np.inf, DRIVES.lengths(stands)[first])
    nearest = [stands[first].id, stands[int(among.argmin())].id]
    assert [p.id for p in visits_in_order(free, DRIVES, SITE.start, backwards, None)] == nearest
    assert [p.id for p in visits_in_order(given_, DRIVES, SITE.start, backwards, None)] == ["20", "19"]


def test_steps_in_any_order_begin_with_the_nearest_and_those_without_a_place_come_last():
    far, near = act(Extreme(side="north")), act(TreeIs(tree="1"))
    node = AnyOrder(id="a", steps=(act(), far, near))
    assert steps_in_order(node, SITE, DRIVES, Context(here=SITE.start), None) == (2, 1, 0)


def test_a_step_whose_place_is_nowhere_is_named():
    node = AnyOrder(id="a", steps=(Act(id="b", action="x", at=TreeIs(tree="none")), act(TreeIs(tree="1"))))
    with pytest.raises(PlaceError, match=r"^b\b"):
        steps_in_order(node, SITE, DRIVES, Context(here=SITE.start), None)


def test_a_node_ends_the_plan_if_no_step_and_no_round_follows():
    loop = ForEach(id="", select=Trees(), body=act())
    condition = TreeHas(attribute="leaf_color", test="eq", value="green")
    endings = {
        "last step": (InOrder(id="", steps=(act(), loop)), True),
        "not the last step": (InOrder(id="", steps=(loop, act())), False),
        "one of a set": (AnyOrder(id="", steps=(loop, act())), False),
        "in a loop": (ForEach(id="", select=Trees(), body=loop), False),
        "in a repeat": (Repeat(id="", times=2, body=loop), False),
        "in a single round": (Repeat(id="", times=1, body=loop), True),
        "in an if": (If(id="", condition=condition, then=loop), True),
        "in a try": (Try(id="", body=loop, otherwise=act()), True),
        "in an if before something": (InOrder(id="", steps=(If(id="", condition=condition, then=loop), act())), False),
    }
    for name, (plan, ends) in endings.items():
        numbered = number(plan)
        ids = [n.id for n in _loops(numbered)]
        assert ends_plan(numbered, ids[-1]) is ends, name
    assert not ends_plan(number(loop), "none of them")


def _loops(node):
    from fieldhand.task.plan import walk

    return [n for n in walk(node) if isinstance(n, ForEach)]


def test_home_counts_only_for_what_ends_the_plan_and_the_mission_goes_home():
    plan = InOrder(id="", steps=(ForEach(id="", select=Trees(), body=act()), GoTo(id="", place=TreeIs(tree="3"))))
    task = task_for(SITE, plan)
    assert home_if_last(task, SITE, "n2", SITE.start) is None
    assert home_if_last(task, SITE, "n4", SITE.start) == SITE.markers["end"]
    assert home_if_last(task_for(SITE, plan, nominal="stay"), SITE, "n4", SITE.start) is None
    assert home_if_last(task_for(SITE, plan, nominal="return_to_start"), SITE, "n4", SITE.start) == SITE.start


def test_a_drive_between_two_places_is_the_length_that_the_order_counted():
    yellow = Where(attribute="leaf_color", test="eq", value="yellow")
    from fieldhand.places.resolution import resolve

    places = with_stands(DRIVES, SITE.start, resolve(yellow, SITE, Context(here=SITE.start)))
    matrix = DRIVES.lengths(places)
    for i, a in enumerate(places):
        for j, b in enumerate(places):
            assert matrix[i, j] == pytest.approx(DRIVES.between(a, b).length_m)
