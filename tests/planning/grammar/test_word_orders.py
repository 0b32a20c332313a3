"""Requests whose parts stand in many orders, and what they become."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Clarify, Planned
from fieldhand.request_check import mismatches
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

DEMO, HUSKY, AMIGA = open_site("demo"), load_robot("husky"), load_robot("amiga")
PLANNED = [
    ("Take at each corner tree two pictures.", "for Corners: [picture x2]"),
    ("Take from each corner tree one picture and one CO2 reading.", "for Corners: [picture; co2]"),
    ("I'd like to have trees 4 and 9 photographed, and CO2 measured at tree 12.", 'for UnionOf(TreeIs(4)+TreeIs(9)): [picture]; co2 @ TreeIs(12)'),
    ("CO2 readings are needed at trees 4 and 9.", "for UnionOf(TreeIs(4)+TreeIs(9)): [co2]"),
    ("Get CO2 readings from the five oldest trees.", "for Top(age_years, 5): [co2]"),
    ("Trees 4, 5 and 6: two pictures each.", "for UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)): [picture x2]"),
    ("Do a CO2 measurement every 20 m along rows 3 and 4.", "for UnionOf(Spaced(20, of Rows(3, 3))+Spaced(20, of Rows(4, 4))): [co2]"),
    ("Sample CO2 along row 3, one reading every 20 m.", "for Spaced(20, of Rows(3, 3)): [co2]"),
    ("Go along row 3 and every 20 m measure CO2.", "for Spaced(20, of Rows(3, 3)): [co2]"),
    ("Use the thermal camera on every tree of row 3.", "for Rows(3, 3): [picture]"),
    ("Visit trees 5 and 9, photograph both.", "for UnionOf(TreeIs(5)+TreeIs(9)): [picture]"),
    ("Drive to tree 5 and photograph it there.", "go TreeIs(5); picture"),
    ("Visit trees 45, 90 and 135. At each one take a picture and a CO2 reading.", "for UnionOf(TreeIs(45)+TreeIs(90)+TreeIs(135)): [picture; co2]"),
    ("Give me a CO2 reading from somewhere in row 3.", "co2 @ Take(1, of Rows(3, 3))"),
    ("Measure CO2 at five Carmel trees. Any five will do.", "for Take(5, of Where(variety, eq, Carmel)): [co2]"),
    ("Measure CO2 once per row in rows 2 and 3.", "for Quota(row, 1, of UnionOf(Rows(2, 2)+Rows(3, 3))): [co2]"),
    ("Inspect every third tree of row 1: one thermal picture and one temperature reading at each.", "for EveryNth(3, of Rows(1, 1)): [picture; air]"),
    ("Take a picture of the westernmost tree and one of the easternmost.", "picture @ Extreme(west); picture @ Extreme(east)"),
    ("Take one picture of tree 5 and two of tree 9.", "picture @ TreeIs(5); picture x2 @ TreeIs(9)"),
    ("Take 5 CO2 readings at random places in row 3.", "for RandomSample(5, of Rows(3, 3)): [co2]"),
    ("Photograph tree 5 and its four nearest neighbours.", "for UnionOf(TreeIs(5)+Nearest(TreeIs(5), 4)): [picture]"),
    ("Image all trees within 12 m of tree 40, but not tree 40 itself.", "for Within(12, TreeIs(40)): [picture]"),
    ("Read CO2 at as many as you can of the yellow trees in 20 minutes.", "for Where(leaf_color, eq, yellow) optional: [co2] | duration_s 1200"),
    ("Photograph as many different trees as possible in 20 minutes.", "for Trees optional: [picture] | duration_s 1200"),
    ("Photograph the closest five yellow trees to the charger.", "for Nearest(Marker(charger), 5, of Where(leaf_color, eq, yellow)): [picture]"),
    ("Photograph one in five trees of row 3.", "for EveryNth(5, of Rows(3, 3)): [picture]"),
    ("Photograph every fifth tree starting with the third one in row 2.", "for EveryNth(5, 3, of Rows(2, 2)): [picture]"),
    ("Photograph every other tree of row 3, starting with its northernmost tree, and take CO2 at each of those trees too.", "for Ordered(north_to_south, of EveryNth(2, north, of Rows(3, 3))) given: [picture; co2]"),
    ("Survey every other tree of row 9 with the thermal camera, starting from the south end.", "for Ordered(south_to_north, of EveryNth(2, south, of Rows(9, 9))) given: [picture]"),
    ("Photograph the tree two rows east of tree 50.", "picture @ Nearest(TreeIs(50), of RowOf(TreeIs(50), 2))"),
    ("Photograph all trees that are neither yellow nor pale green.", "for Where(leaf_color, ne, pale green, of Where(leaf_color, ne, yellow)): [picture]"),
    ("Photograph the yellow trees, then the pale green ones.", "for Where(leaf_color, eq, yellow): [picture]; for Where(leaf_color, eq, pale green): [picture]"),
    ("Measure CO2 at the three northern trees of row 1.", "for Extreme(north, 3, of Rows(1, 1)): [co2]"),
    ("Choose five yellow trees and take one picture of each of the five trees.", "for Take(5, of Where(leaf_color, eq, yellow)): [picture]"),
    ("For trees 10 to 15 of row 3 I need one thermal picture each. At tree 12 of that row also measure CO2.", "for InRow(10, 15, of Rows(3, 3)): [picture]; go InRow(12, 12, of Rows(3, 3)); co2"),
    ("Photograph every tree of row 2 from north to south, and at the last tree measure CO2.", "for Ordered(north_to_south, of Rows(2, 2)) given: [picture]; go InRow(-1, -1, of Rows(2, 2)); co2"),
    ("If any tree in row 4 has a canopy temperature above 36 degrees, photograph its two neighbours.", "for Rows(4, 4): [picture = r1; if r1 > 36 degC: [for Nearest(Here, 2, True): [picture]]]"),
    ("At tree 5 and at tree 9, take a picture.", "for UnionOf(TreeIs(5)+TreeIs(9)) given: [picture]"),
]  # fmt: skip
#: What may mean something else, and is asked or refused.
OPEN = [
    "Take a picture of every tree in row 3. If one of them reads over 39 °C, go home.",
    "Measure CO2 at tree 4 and at tree 9. If it is low at either one, read the air temperature there as well.",
    "Photograph trees 4 and 9, then its four nearest neighbours.",
    "Photograph the trees in the south-west corner.",
    "Photograph the ten trees which are nearest the pond and yellow.",
    "Run the thermal camera along row 3.",
    "Take CO2 readings along row 5, 15 m apart, four of them.",
    "Take a picture of every tree in rows 3 and 4, and at the last tree measure CO2.",
]


@pytest.mark.parametrize(("request_", "plan"), PLANNED)
def test_each_order_of_the_parts_has_its_plan(request_: str, plan: str) -> None:
    outcome = composed(request_, DEMO, HUSKY)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    assert unaccounted(outcome.task) == ()
    assert mismatches(outcome.task, DEMO, HUSKY) == ()


@pytest.mark.parametrize("request_", OPEN)
def test_what_may_mean_something_else_is_not_planned(request_: str) -> None:
    assert not isinstance(composed(request_, DEMO, HUSKY), Planned)


def test_a_word_of_the_robot_may_be_an_attribute_of_the_site() -> None:
    outcome = composed("At each tree with yellow leaves, measure nitrate.", DEMO, AMIGA)
    assert isinstance(outcome, Planned)
    assert outline(outcome.task) == "for Where(leaf_color, eq, yellow): [nitrate]"


@pytest.mark.parametrize(
    "request_",
    [
        "Photograph all but the first two trees in row 2.",
        "Photograph all but the last two trees of row 2.",
        "All but the last tree of row 3: CO2.",
        "Measure CO2 at all but the northernmost tree of row 2.",
    ],
)
def test_all_but_a_part_of_a_row_is_of_the_row_or_of_the_site(request_: str) -> None:
    outcome = composed(request_, DEMO, HUSKY)
    assert isinstance(outcome, Clarify)
    assert all("other than" in choice for choice in outcome.choices)


@pytest.mark.parametrize(
    "request_", ["Photograph all, but the first two trees of row 2.", "CO2, but three trees of row 2."]
)
def test_what_follows_but_is_no_place_of_the_captures_before_it(request_: str) -> None:
    assert not isinstance(composed(request_, DEMO, HUSKY), Planned)
