"""Indirect, passive, old-fashioned and foreign ways to say known things, and what is left open by them."""

from __future__ import annotations

import pytest

from fieldhand.planning.builtin import BuiltinPlanner
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

SITE = open_site("demo")
HUSKY = load_robot("husky")
AMIGA = load_robot("amiga")

_YELLOW = "Where(leaf_color, eq, yellow)"
_WITHOUT_YELLOW = f"for Excluding({_YELLOW}, of Rows(3, 3)): [picture]"
_WITHOUT_45 = "for Excluding(TreeIs(45), of Rows(3, 3)): [picture]"
_WITHOUT_WET = "for Excluding(InZone(wet corner), of Rows(3, 3)): [picture]"
_HOT = "for UnionOf(TreeIs(4)+TreeIs(5)): [picture = r1; if r1 > 38 degC: [co2]]"
_UNTIL = "for Rows(3, 3) until r1 > 500 ppm: [co2 = r1]"
_OR_FIVE = "try [picture @ TreeIs(4)] or [picture @ TreeIs(5)]"

PLANNED = [
    # Passive and subjunctive commands.
    ("Let the leaf temperature be taken at tree 14.", "picture @ TreeIs(14)"),
    ("Let a CO2 sample be drawn at tree 14.", "co2 @ TreeIs(14)"),
    ("Let trees 14 and 15 be photographed.", "for UnionOf(TreeIs(14)+TreeIs(15)): [picture]"),
    ("At tree 14 let a picture be taken.", "go TreeIs(14); picture"),
    ("To be photographed: trees 1 and 19.", "for UnionOf(TreeIs(1)+TreeIs(19)): [picture]"),
    ("To be measured: CO2 at tree 4.", "co2 @ TreeIs(4)"),
    ("I would know the air temperature at tree 14.", "air @ TreeIs(14)"),
    ("The air temperature at tree 14 I would know.", "air @ TreeIs(14)"),
    ("Go to tree 14. Its air temperature I want.", "go TreeIs(14); air"),
    ("The three oldest trees: their leaf temperature I would know.", "for Top(age_years, 3): [picture]"),
    ("Have tree 9 checked for CO2.", "co2 @ TreeIs(9)"),
    ("I'd like the air at tree 9 tested for CO2.", "co2 @ TreeIs(9)"),
    ("Boss wants tree 9 photographed.", "picture @ TreeIs(9)"),
    ("Go to tree 14, see what the air temperature is.", "go TreeIs(14); air"),
    ("At tree 14 one takes the CO2.", "go TreeIs(14); co2"),
    ("One takes the CO2 at tree 14, then one returns.", "co2 @ TreeIs(14) | return_to_start"),
    ("The robot is to photograph tree 14.", "picture @ TreeIs(14)"),
    ("Off you trot to tree 4 and take a picture.", "go TreeIs(4); picture"),
    ("The three oldest trees get a picture, one each.", "for Top(age_years, 3): [picture]"),
    # Groups under a condition.
    ("Photograph trees 4 and 5; any that reads over 38 degrees gets a CO2 with it.", _HOT),
    ("Photograph trees 4 and 5. Whichever reads above 38 degrees gets a CO2.", _HOT),
    ("Photograph trees 4 and 5. Those found to be above 38 degrees get a CO2.", _HOT),
    ("Photograph trees 4 and 5. Each one above 38 degrees gets a CO2.", _HOT),
    ("Photograph trees 4 and 5, and where it be found above 38 degrees, take the CO2 also.", _HOT),
    ("Photograph trees 4 and 5. If it is hot, read CO2. By hot I mean over 38.", _HOT),
    (
        "Photograph trees 4 and 5, with a CO2 at any whose canopy turns out high.",
        "for UnionOf(TreeIs(4)+TreeIs(5)): [picture = r1; if r1 high: [co2]]",
    ),
    (
        "Is the air above 35 °C at tree 140? Measure it. If yes: a picture of tree 141.",
        "air @ TreeIs(140) = r1; if r1 > 35 degC: [picture @ TreeIs(141)]",
    ),
    # Exclusions.
    ("Photograph row 3. Ignore the yellow ones.", _WITHOUT_YELLOW),
    ("Photograph row 3, but ignore the yellow ones.", _WITHOUT_YELLOW),
    ("Ignore the yellow trees. Photograph row 3.", _WITHOUT_YELLOW),
    ("Photograph row 3. Don't photograph the yellow trees.", _WITHOUT_YELLOW),
    ("Photograph row 3. The yellow ones are exempt.", _WITHOUT_YELLOW),
    ("Photograph row 3. Not tree 45.", _WITHOUT_45),
    ("Photograph row 3, tree 45 excepted.", _WITHOUT_45),
    ("Photograph every tree in row 3. You can skip tree 45.", _WITHOUT_45),
    ("Photograph row 3, but don't do tree 45.", _WITHOUT_45),
    ("Never photograph tree 45. Photograph every tree in row 3.", _WITHOUT_45),
    ("Photograph every tree in row 3. Leave the wet corner alone.", _WITHOUT_WET),
    ("Photograph row 3, minus any that lie inside the wet corner.", _WITHOUT_WET),
    ("Photograph row 3, those lying in the wet corner being excepted.", _WITHOUT_WET),
    ("Photograph row 3, any standing in the wet corner left out.", _WITHOUT_WET),
    ("Photograph rows 2 to 4, no need to do row 3.", "for Excluding(Rows(3, 3), of Rows(2, 4)): [picture]"),
    (
        "Photograph row 3, not the first one though.",
        "for Excluding(InRow(1, 1, of Rows(3, 3)), of Rows(3, 3)): [picture]",
    ),
    (
        "Leave the Nonpareil be. The other trees get an infrared picture, one each.",
        "for Excluding(Where(variety, eq, Nonpareil)): [picture]",
    ),
    (
        "Skip the Carmels. Photograph the three oldest trees.",
        "for Top(age_years, 3, of Excluding(Where(variety, eq, Carmel))): [picture]",
    ),
    (
        "Don't bother with the northern half at all. In the other one: the six oldest trees, a picture of each.",
        "for Top(age_years, 6, of Excluding(Half(north))): [picture]",
    ),
    (
        "Photograph every tree of row 3 and read CO2 at every tree of row 5. Skip tree 45.",
        "for Excluding(TreeIs(45), of Rows(3, 3)): [picture]; for Rows(5, 5): [co2]",
    ),
    ("You can forget the Carmels. Photograph every tree.", "for Excluding(Where(variety, eq, Carmel)): [picture]"),
    # Superlatives and numbers.
    ("The tree with the yield the most big: a picture.", "picture @ Top(yield_kg, 1)"),
    ("Photograph the most near tree to the charger.", "picture @ Nearest(Marker(charger))"),
    ("Photograph the oldest half dozen trees.", "for Top(age_years, 6): [picture]"),
    ("Photograph the ten best trees, judged by yield.", "for Top(yield_kg, 10): [picture]"),
    # Another place where the first cannot be reached.
    ("Photograph tree 4 or, failing that, tree 5.", _OR_FIVE),
    ("Tree 4 or, failing that, should you be unable to get to it, tree 5: a picture.", _OR_FIVE),
    ("Photograph tree 4. If it cannot be reached, use tree 5 instead.", _OR_FIVE),
    ("Photograph tree 4; should you be unable to reach it, photograph tree 5.", _OR_FIVE),
    ("Photograph tree 4, or tree 5 if you can't get to it.", _OR_FIVE),
    # Stops.
    (
        "CO2 at each tree of row 3, and the moment a reading passes 500 ppm you quit and go home.",
        f"{_UNTIL} | return_to_start",
    ),
    (
        "CO2 at each tree of row 3. Stop the survey and return as soon as one reading is above 500 ppm.",
        f"{_UNTIL} | return_to_start",
    ),
    ("CO2 at each tree of row 3; the first reading above 500 ppm ends the job.", _UNTIL),
    ("CO2 at each tree of row 3; the survey is to be stopped as soon as one is over 500 ppm.", _UNTIL),
    # Frames.
    ("Would ye kindly fetch a picture of tree 4.", "picture @ TreeIs(4)"),
    ("CO2, if you'd be so kind, at tree 33.", "co2 @ TreeIs(33)"),
    ("Take a picture of tree 4 and no dawdling.", "picture @ TreeIs(4)"),
    ("Merely a picture of tree 4.", "picture @ TreeIs(4)"),
    (
        "Up row 3 you go, from its south end, CO2 at each tree.",
        "for Ordered(south_to_north, of Rows(3, 3)) given: [co2]",
    ),
]

OPEN = [
    "Nobody wants pictures of tree 4.",
    "Photograph row 3. Skip row 3.",
    "Photograph tree 4. Skip tree 45.",
    "Photograph row 4. Skip tree 45.",
    "Photograph row 3. Not the CO2.",
    "Photograph the three oldest trees. Skip the Carmels.",
    "Photograph every tree in row 3. Not just tree 45.",
    "Photograph every tree in row 3, not just tree 45.",
    "Skip row 3. Take pictures of every other row.",
    "Leave tree 4 alone.",
    "Don't photograph row 3.",
    "Photograph every tree in row 3. Don't go near the pond.",
    "Photograph every tree in row 3. Never go to tree 45.",
    "Photograph tree 4. Use tree 5 instead.",
    "Photograph trees 4 and 5 or, failing that, tree 6.",
    "Photograph the oldest tree by yield.",
    "Photograph as many yellow trees as you can in a good half hour.",
    "Take a thermal picture of trees 57 to 60. By hot I mean over 37.",
    "Two trees get a picture in this mission. At the first tree take a picture. At another tree take a picture.",
]


@pytest.mark.parametrize(("request_", "expected"), PLANNED, ids=[request[:60] for request, _ in PLANNED])
def test_odd_wordings_mean_what_plain_ones_do(request_: str, expected: str) -> None:
    outcome = BuiltinPlanner().plan(request_, SITE, HUSKY)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == expected


@pytest.mark.parametrize("request_", OPEN, ids=[request[:60] for request in OPEN])
def test_what_is_left_open_is_not_planned(request_: str) -> None:
    assert isinstance(BuiltinPlanner().plan(request_, SITE, HUSKY), Clarify | Refused)


def test_a_level_that_the_profile_does_not_define_is_asked_for() -> None:
    outcome = BuiltinPlanner().plan("Nitrate at trees 4 and 9, and where low, a leaf too.", SITE, AMIGA)
    assert isinstance(outcome, Clarify)
