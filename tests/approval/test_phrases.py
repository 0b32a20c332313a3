"""Words for selectors, conditions and actions."""

from __future__ import annotations

import re
from typing import get_args

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.places import selectors as s
from fieldhand.places.wording import say_selector
from fieldhand.task import conditions as c
from fieldhand.task.plan import Act
from fieldhand.terms import Side, Test
from fieldhand.testing.generated.tasks import ROVER, Parts
from fieldhand.testing.small_orchard import husky
from fieldhand.wording.conditions import say_act, say_condition

PARTS = Parts(ROVER)
YELLOW = s.Where(attribute="leaf_color", test="eq", value="yellow")
HERE, TREE = s.Here(), s.TreeIs(tree="81")

#: One of each selector class at least; the test below fails when a class is missing.
SAID = [
    (s.Trees(), None, "every tree"),
    (s.Trees(), 98, "all 98 trees"),
    (TREE, None, "tree 81"),
    (s.Marker(name="charger"), None, "the charger"),
    (s.GateIs(gate="gate"), None, "the gate"),
    (s.Beside(side="both", of=s.TreeIs(tree="4")), None, "both sides of tree 4"),
    (s.ByReading(reading="r1", quantity="co2"), None, "the place where the CO₂ read was highest"),
    (
        s.GroupByReading(group="row", reading="r1", quantity="co2"),
        None,
        "the trees in the row with the highest mean CO₂",
    ),
    (s.GateIs(gate="north gate"), None, "the gate “north gate”"),
    (HERE, None, "the place reached before"),
    (s.Bound(label="a"), None, "the place called “a”"),
    (s.First(), None, "the first tree"),
    (s.Last(of=YELLOW), None, "the last of the yellow trees"),
    (s.Corners(), None, "the 4 corner trees"),
    (s.Corners(which=("nw",)), None, "the north-west corner tree"),
    (s.Corners(which=("nw", "se"), of=YELLOW), None, "the north-west and south-east corner trees of the yellow trees"),
    (s.Extreme(side="north"), None, "the northernmost tree"),
    (s.Extreme(side="west", count=3, of=YELLOW), None, "the 3 westernmost of the yellow trees"),
    (s.AmongExtreme(side="north"), None, "the northernmost trees"),
    (s.Middle(), None, "the tree nearest to the middle of the site"),
    (s.EdgeMiddle(side="east", count=2), None, "the 2 trees nearest to the middle of the eastern edge"),
    (s.Half(side="north", of=YELLOW), 3, "the 3 yellow trees in the northern half"),
    (s.Quarter(quarter="se"), 1, "the 1 tree in the south-east quarter"),
    (s.Edge(side="south"), None, "the trees along the southern edge"),
    (s.Nearest(to=HERE, fresh=True), None, "the tree nearest to that place and not visited yet"),
    (s.Nearest(to=TREE, adjacent=True, of=YELLOW), None, "the yellow tree next to tree 81"),
    (s.Farthest(origin=HERE), None, "the tree farthest from there"),
    (s.Adjacent(near=TREE), None, "2 trees next to each other, beginning with the one nearest to tree 81"),
    (s.NotVisited(), None, "the trees not visited yet"),
    (s.Apart(count=3, apart_m=15.0), None, "3 trees, about 15 m from each other"),
    (
        s.Apart(count=2, apart_m=4.5, least=True, of=YELLOW),
        None,
        "2 of the yellow trees, at least 4.5 m from each other",
    ),
    (s.Excluding(places=TREE, of=YELLOW), None, "the yellow trees other than tree 81"),
    (s.Where(attribute="age_years", test="ge", value=10.0), None, "the trees whose age is at least 10 years"),
    (s.Top(attribute="reward", count=10), None, "the 10 trees with the highest reward"),
    (s.InZone(zone="wet corner", outside=True), None, "the trees outside the zone “wet corner”"),
    (s.Within(distance_m=20.0, to=TREE), None, "the trees within 20 m of tree 81"),
    (s.Within(distance_m=20.0, to=TREE, beyond=True), None, "the trees more than 20 m from tree 81"),
    (s.Take(count=1, of=s.AmongExtreme(side="north")), None, "the nearest of the northernmost trees"),
    (s.Spread(count=5, of=YELLOW), None, "5 of the yellow trees, spread far from each other"),
    (s.Spread(count=1), None, "the one of the trees nearest to their middle"),
    (s.Evenly(count=3, of=YELLOW), None, "3 of the yellow trees, evenly along them"),
    (s.Evenly(count=1, of=YELLOW), None, "the middle one of the yellow trees"),
    (s.Evenly(count=3, out_of=5), None, "3 of every 5 trees"),
    (s.Evenly(count=3, out_of=5, of=s.Rows(first="3", last="3")), None, "3 of every 5 of the trees of row 3"),
    (s.RandomSample(count=1), None, "one of the trees, drawn at random (seed 0)"),
    (s.RandomSample(count=3, seed=7, of=YELLOW), None, "3 of the yellow trees, drawn at random (seed 7)"),
    (s.Quota(per="variety", count=5), None, "5 trees per variety, spread evenly"),
    (s.Quota(per="row", count=2, of=YELLOW), None, "2 trees per row, of the yellow trees, spread evenly"),
    (s.Quota(per="row", percent=10.0, of=YELLOW), None, "10 % of the yellow trees per row, spread evenly"),
    (s.Quota(percent=2.5, how="random", seed=7), None, "2.5 % of the trees, drawn at random (seed 7)"),
    (
        s.Quota(per="block", count=2, how="lowest", by="yield_kg"),
        None,
        "2 trees per block, those with the lowest yield kg",
    ),
    (s.Quota(per="row", count=1, how="first"), None, "1 tree per row, the first ones"),
    (s.Missing(), None, "the gaps where trees are missing"),
    (s.Missing(of=s.Rows(first="3", last="3")), None, "the gaps where trees of row 3 are missing"),
    (s.Missing(of=YELLOW), None, "the gaps where a tree is missing among the yellow trees"),
    (s.Grid(every_m=20.0, of=YELLOW), None, "one of the yellow trees per cell of a 20 m grid"),
    (s.Grid(every_m=12.5, zone="wet corner"), None, "points on a 12.5 m grid over the zone “wet corner”"),
    (s.Transect(count=20, of=YELLOW), None, "20 of the yellow trees, along a W across them"),
    (
        s.Transect(count=9, legs=5, zone="wet corner"),
        None,
        "9 points along a zigzag of 5 legs across the zone “wet corner”",
    ),
    (s.Transect(apart_m=10.0, shape="x"), None, "the points every 10 m along an X across the trees"),
    (
        s.Transect(apart_m=10.0, shape="edge", zone="pond", off_m=4.0),
        None,
        "the points every 10 m along the edge of the zone “pond”, 4 m from it",
    ),
    (
        s.Transect(count=1, shape="edge", zone="pond", part="north"),
        None,
        "the middle of the north side of the zone “pond”",
    ),
    (
        s.Transect(count=5, shape="edge", zone="pond", part="east"),
        None,
        "5 points along the east side of the zone “pond”",
    ),
    (
        s.Transect(apart_m=10.0, shape="edge", zone="pond", part="west"),
        None,
        "the points every 10 m along the west side of the zone “pond”",
    ),
    (
        s.Transect(count=1, shape="edge", zone="wet corner", off_m=-1.5),
        None,
        "1 point along the edge of the zone “wet corner”, 1.5 m outside of it",
    ),
    (
        s.PointAt(metres=10.0, towards="west", origin=s.InZone(zone="wet corner")),
        None,
        "the point 10 m west of the zone “wet corner”",
    ),
    (
        s.StraightLine(start=s.Marker(name="start"), end=s.InZone(zone="pond"), apart_m=20.0),
        None,
        "the points every 20 m on the straight line from the start marker to the zone “pond”",
    ),
    (
        s.StraightLine(start=s.Marker(name="start"), end=s.Marker(name="end"), count=8),
        None,
        "8 points on the straight line from the start marker to the end marker",
    ),
    (s.Corners(zone="wet corner"), None, "the 4 corners of the zone “wet corner”"),
    (s.Corners(which=("nw",), zone="wet corner"), None, "the north-west corner of the zone “wet corner”"),
    (
        s.PointsIn(zone="wet corner", count=5, random=True, seed=3),
        None,
        "5 points in the zone “wet corner”, drawn at random (seed 3)",
    ),
    (s.PointsIn(count=5), None, "5 points spread over the site"),
    (s.Nearest(to=TREE, adjacent=True, side="east"), None, "the tree next to tree 81, on its east side"),
    (s.InZone(zone="pond", margin_m=10.0), None, "the trees within 10 m of the zone “pond”"),
    (s.InZone(zone="pond", margin_m=10.0, outside=True), None, "the trees more than 10 m from the zone “pond”"),
    (s.Take(count=1, of=s.NotVisited()), None, "another tree, the nearest one not visited yet"),
    (s.UnionOf(parts=(TREE, s.TreeIs(tree="12"))), None, "trees 81 and 12"),
    (s.UnionOf(parts=(TREE, s.First())), None, "tree 81 and the first tree"),
    (
        s.Where(attribute="leaf_color", test="eq", value="yellow", of=s.Extreme(side="north", count=3)),
        2,
        "the 2 yellow trees among the 3 northernmost trees",
    ),
    (
        s.Top(attribute="yield_kg", count=3, lowest=True, of=s.Half(side="west", of=YELLOW)),
        None,
        "the 3 yellow trees in the western half with the lowest yield",
    ),
    (
        s.Farthest(origin=HERE, of=s.NotVisited()),
        None,
        "the tree not visited yet that is farthest from there",
    ),
    (s.InBlock(block="B"), 12, "the 12 trees of block B"),
    (s.InBlock(block="Block 2", of=YELLOW), None, "the yellow trees of Block 2"),
    (s.Rows(first="3", last="3"), None, "the trees of row 3"),
    (s.Rows(first="3", last="3", of=s.InBlock(block="B")), 9, "the 9 trees of row 3 of block B"),
    (s.InBlock(block="B", of=s.Rows(first="A", last="C")), None, "the trees of rows A to C of block B"),
    (
        s.Rows(first="2", last="5", of=s.Half(side="north", of=YELLOW)),
        None,
        "the yellow trees of rows 2 to 5 in the northern half",
    ),
    (s.Rows(every=2), None, "the trees of every other row"),
    (s.Rows(first="2", last="8", every=3), None, "the trees of every third one of rows 2 to 8"),
    (s.Rows(first="-1", last="-1"), None, "the trees of the last row"),
    (s.Rows(first="2", last="2", counted_from="east"), None, "the trees of the second row from the east"),
    (
        s.Rows(first="1", last="3", counted_from="east"),
        None,
        "the trees of rows 1 to 3 from the east",
    ),
    (s.Rows(first="Row 7"), None, "the trees of the rows from row 7 to the last row"),
    (s.RowOf(), None, "the trees of the same row"),
    (s.RowOf(origin=TREE, over=-1), None, "the trees of the row before that of tree 81"),
    (s.RowOf(over=2), None, "the trees of the row 2 rows after this one"),
    (s.InRow(first=4, last=9, of=s.Rows(first="2", last="2")), None, "trees 4 to 9 of row 2"),
    (s.InRow(first=-1, last=-1, of=s.Rows(first="2", last="5")), None, "the last tree of each of rows 2 to 5"),
    (s.InRow(first=1, last=3), None, "the first 3 trees of each row"),
    (s.InRow(first=-2, last=-1, of=s.InBlock(block="B")), None, "the last 2 trees of each row of block B"),
    (
        s.InRow(first=4, last=4, counted_from="south", of=s.Rows(first="2", last="2", of=YELLOW)),
        None,
        "tree 4 of each row among the yellow trees of row 2, counted from the south",
    ),
    (s.EveryNth(nth=3, of=s.Rows(first="2", last="5")), None, "every third tree of rows 2 to 5"),
    (s.EveryNth(nth=2), None, "every other tree of each row"),
    (s.EveryNth(nth=2, start=2, of=YELLOW), None, "every other one of the yellow trees, from the second on"),
    (
        s.EveryNth(
            nth=3,
            of=s.Where(
                attribute="age_years", test="gt", value=10.0, of=s.Half(side="north", of=s.Rows(first="2", last="5"))
            ),
        ),
        None,
        "every third one of the trees of rows 2 to 5 whose age is above 10 years, in the northern half",
    ),
    (s.AlongRow(trees=5), None, "the tree 5 trees further down the row"),
    (s.AlongRow(trees=1, towards="up", origin=TREE), None, "the next tree up the row from tree 81"),
    (s.AlongRow(trees=3, towards="east"), None, "the tree 3 trees further along the row to the east"),
    (s.Across(), None, "the tree abreast of that place in the next row"),
    (s.Across(origin=TREE, side="west"), None, "the tree abreast of tree 81 in the next row to the west"),
    (s.Successive(count=5), None, "5 successive trees of one row, as near to that place as there are"),
    (
        s.Successive(count=5, near=TREE, of=s.Rows(first="3", last="3")),
        None,
        "5 successive trees of row 3, as near to tree 81 as there are",
    ),
    (
        s.Successive(count=3, of=YELLOW),
        None,
        "3 of the yellow trees that follow each other in one row, as near to that place as there are",
    ),
    (s.Ordered(by="west_to_east", of=YELLOW), 4, "the 4 yellow trees, from west to east"),
    (s.Ordered(by="rows"), None, "every tree, row by row"),
    (s.Ordered(by="attribute", attribute="yield_kg", descending=True), None, "every tree, by yield, the highest first"),
    (s.Nth(nth=2, of=s.Ordered(by="north_to_south")), None, "the second northernmost tree"),
    (s.Nth(nth=1, of=s.Ordered(by="nearest_first", of=YELLOW)), None, "the nearest of the yellow trees"),
    (
        s.Nth(nth=3, of=s.Ordered(by="attribute", attribute="reward", descending=True)),
        None,
        "the tree with the third highest reward",
    ),
    (s.Nth(nth=-1, of=s.Ordered(by="rows", of=YELLOW)), None, "the last of the yellow trees, row by row"),
    (s.Nth(nth=21, of=YELLOW), None, "the 21st of the yellow trees"),
    (
        s.Spaced(apart_m=15.0, count=10),
        None,
        "10 points 15 m apart beside the nearest row, beginning at the end nearer to that place",
    ),
    (
        s.Spaced(apart_m=2.5, near=TREE, of=s.Rows(first="3", last="3")),
        None,
        "as many points 2.5 m apart as fit beside row 3, beginning at the end nearer to tree 81",
    ),
    (
        s.Spaced(apart_m=15.0, count=3, zone="wet", near=s.Marker(name="start")),
        None,
        "3 points 15 m apart on a line inside the zone “wet”, beginning at the end nearer to the start marker",
    ),
    (s.PointsIn(zone="wet"), None, "the middle of the zone “wet”"),
    (s.PointsIn(zone="wet", count=5), None, "5 points spread over the zone “wet”"),
    (s.Extreme(side="north", of=s.Rows(first="3", last="3")), None, "the northernmost of the trees of row 3"),
    (s.Nearest(to=TREE, count=2, of=s.Rows(first="3", last="3")), None, "the 2 trees of row 3 nearest to tree 81"),
    (
        s.Half(side="north", of=s.InZone(zone="wet")),
        None,
        "the trees in the northern half of the trees inside the zone “wet”",
    ),
    (
        s.DoneEarlier(action="take_thermal_picture", period=s.Period(calendar="yesterday")),
        None,
        "the trees visited yesterday to take a thermal picture",
    ),
    (
        s.Excluding(places=s.DoneEarlier(action="read_co2"), of=s.Rows(first="3", last="3")),
        None,
        "the trees of row 3 not visited before to read CO₂",
    ),
    (
        s.DoneEarlier(outcome="left_out", period=s.Period(last_missions=3)),
        None,
        "the trees left out by a mission in the last 3 missions",
    ),
    (
        s.TopEarlier(quantity="co2", count=5, lowest=True, period=s.Period(calendar="last_week")),
        None,
        "the 5 trees with the lowest CO₂ read last week",
    ),
    (
        s.WhereEarlier(quantity="co2", test="gt", value=450.0, unit="ppm", period=s.Period(first_day="--10-01")),
        None,
        "the trees whose CO₂ read since 10-01 was above 450 ppm",
    ),
]

LOW = c.Level(reading="r", quantity="canopy_temperature", level="low")
COLD = c.Compare(reading="r", quantity="canopy_temperature", test="lt", value=33.0, unit="degC")
THERE = {"r": "there"}


@pytest.mark.parametrize(("selector", "count", "words"), SAID)
def test_selectors_are_said_as_people_say_them(selector, count, words):
    assert say_selector(selector, count=count) == words


def test_every_kind_of_selector_has_an_example():
    assert {type(selector) for selector, _, _ in SAID} == set(s.SELECTORS)


@settings(max_examples=150, deadline=None)
@given(selector=PARTS.selectors)
def test_no_selector_shows_a_class_name(selector):
    said = say_selector(selector)
    assert said
    names = "|".join(cls.__name__ for cls in s.SELECTORS)
    assert not re.search(rf"\b(?:{names})\(", said)


PLAIN = st.sampled_from(("yellow", "Kerman", "old"))


@settings(max_examples=60, deadline=None)
@given(value=PLAIN, test=st.sampled_from(get_args(Test)), count=st.integers(1, 9), side=st.sampled_from(get_args(Side)))
def test_names_with_underscores_are_said_without(value, test, count, side):
    selector = s.Top(
        attribute="trunk_girth_cm",
        count=count,
        of=s.Half(side=side, of=s.Where(attribute="leaf_shape", test=test, value=value)),
    )
    assert "_" not in say_selector(selector)


def test_a_label_is_called_what_the_reader_knows_it_as():
    assert say_selector(s.Farthest(origin=s.Bound(label="a")), {"a": "tree 36"}) == "the tree farthest from tree 36"


@pytest.mark.parametrize(
    ("condition", "words"),
    [
        (COLD, "the canopy temperature there is below 33 °C"),
        (c.Not(condition=COLD), "the canopy temperature there is not below 33 °C"),
        (LOW, "the canopy temperature there is low (below 33 °C)"),
        (
            c.Between(reading="r", quantity="co2", low=380.0, high=420.5, unit="ppm"),
            "the CO₂ there is between 380 and 420.5 ppm",
        ),
        (c.TreeHas(attribute="leaf_color", test="eq", value="yellow"), "the tree's leaf color is yellow"),
        (
            c.AllOf(conditions=(COLD, c.AnyOf(conditions=(LOW, COLD)))),
            "the canopy temperature there is below 33 °C and (the canopy temperature there is low (below 33 °C)"
            " or the canopy temperature there is below 33 °C)",
        ),
        (c.Not(condition=c.Not(condition=LOW)), "the canopy temperature there is low (below 33 °C)"),
    ],
)
def test_conditions_are_said_as_clauses(condition, words):
    assert say_condition(condition, THERE, husky()) == words


@settings(max_examples=100, deadline=None)
@given(condition=PARTS.conditions)
def test_no_condition_shows_a_class_name(condition):
    said = say_condition(condition)
    assert said
    names = "|".join(cls.__name__ for cls in get_args(c.Condition))
    assert not re.search(rf"\b(?:{names})\(", said)


@pytest.mark.parametrize(
    ("act", "words"),
    [
        (Act(id="n", action="take_thermal_picture"), "take a thermal picture"),
        (Act(id="n", action="take_thermal_picture", count=2), "take 2 thermal pictures"),
        (Act(id="n", action="read_ambient_temperature", count=2), "read the ambient temperature twice"),
        (Act(id="n", action="read_co2", count=3), "read CO₂ 3 times"),
        (Act(id="n", action="sample_leaf", count=2), "sample 2 leaves"),
        (Act(id="n", action="take_rgb_picture"), "take an RGB picture"),
        (
            Act(id="n", action="probe_soil", parameters=(("depth_cm", 20.0), ("mode", "fast"))),
            "probe a soil with depth cm 20 and mode fast",
        ),
    ],
)
def test_actions_are_said_as_verb_phrases(act, words):
    assert say_act(act, husky()) == words
