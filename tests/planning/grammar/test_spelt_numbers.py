"""Numbers, ranks and signs of numbers in every form in which they are said."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

PLANNER = EnglishPlanner(suggests=False)

#: Requests with the plan that the same request with digits has.
PLANNED = [
    ("CO2 at tree one fifty", "co2 @ TreeIs(150)"),
    ("CO2 at tree one-fourteen", "co2 @ TreeIs(114)"),
    ("CO2 at tree one oh four", "co2 @ TreeIs(104)"),
    ("CO2 at tree one twenty-three", "co2 @ TreeIs(123)"),
    ("CO2 at trees one fifty and one twelve", "for UnionOf(TreeIs(150)+TreeIs(112)): [co2]"),
    ("CO2 at tree one hundred and fifty", "co2 @ TreeIs(150)"),
    ("CO2 at tree a hundred and nine", "co2 @ TreeIs(109)"),
    ("CO2 at tree one-hundred-and-sixty-nine", "co2 @ TreeIs(169)"),
    (
        "CO2 at trees one hundred and two and one hundred and three",
        "for UnionOf(TreeIs(102)+TreeIs(103)): [co2]",
    ),
    (
        "CO2 at trees twenty-one, thirty five and a hundred",
        "for UnionOf(TreeIs(21)+TreeIs(35)+TreeIs(100)): [co2]",
    ),
    ("CO2 at every tree within a hundred and fifty feet of the charger", "for Within(45.72, Marker(charger)): [co2]"),
    (
        "You have fifteen hundred metres. CO2 at every Carmel.",
        "for Where(variety, eq, Carmel): [co2] | distance_m 1500",
    ),
    ("You have one thousand two hundred metres. CO2 at tree 4.", "co2 @ TreeIs(4) | distance_m 1200"),
    ("You have 1.5k metres. CO2 at tree 4.", "co2 @ TreeIs(4) | distance_m 1500"),
    ("CO2 at tree 4, in two and a half minutes at most.", "co2 @ TreeIs(4) | duration_s 150"),
    (
        "CO2 at tree 4. If it is above four hundred fifty ppm, a picture.",
        "co2 @ TreeIs(4) = r1; if r1 > 450 ppm: [picture]",
    ),
    ("CO2 at tree 4. If it exceeds 0.5k ppm, a picture.", "co2 @ TreeIs(4) = r1; if r1 > 500 ppm: [picture]"),
    ("CO2 x2 at tree 4", "co2 x2 @ TreeIs(4)"),
    ("CO2 at tree 4 x3", "co2 x3 @ TreeIs(4)"),
    ("CO2 \N{MULTIPLICATION SIGN}2 at tree 4", "co2 x2 @ TreeIs(4)"),
    ("a picture of the sixteenth tree of row three", "picture @ InRow(16, 16, of Rows(3, 3))"),
    ("pictures of every second tree of row 3", "for EveryNth(2, of Rows(3, 3)): [picture]"),
    (
        "pictures of trees one-fourteen",
        "for UnionOf(" + "+".join(f"TreeIs({k})" for k in range(1, 15)) + "): [picture]",
    ),
]
#: Requests with numbers that this site does not have.
REFUSED = [
    "a picture of the twenty-first tree of row 3",
    "a picture of the hundred and first tree of row 3",
    "a picture of the thirtieth tree of row 3",
    "CO2 at tree one ninety",
    "CO2 at tree two hundred and four",
]


@pytest.mark.parametrize(("request_", "plan"), PLANNED)
def test_spelt_numbers_are_those_in_digits(request_: str, plan: str) -> None:
    outcome = PLANNER.plan(request_, open_site("demo"), load_robot("husky"))
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan


@pytest.mark.parametrize("request_", REFUSED)
def test_spelt_numbers_that_the_site_lacks_are_refused(request_: str) -> None:
    assert not isinstance(PLANNER.plan(request_, open_site("demo"), load_robot("husky")), Planned)
