"""Which places the clauses of a request visit: how many, which of those spoken of, and where the one or other is done."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest

from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

SITE, HUSKY = open_site("demo"), load_robot("husky")
SAME = [
    ("Go along row 3 tree by tree and take a picture.", "for Rows(3, 3): [picture]"),
    ("Drive along row 3 tree by tree and measure CO2 at each.", "for Rows(3, 3): [co2]"),
    ("Measure CO2 along row 3 one tree at a time.", "for Rows(3, 3): [co2]"),
    ("One by one, photograph trees 4, 5 and 9.", "for UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(9)): [picture]"),
    ("Photograph the yellow trees, at most five.", "for Where(leaf_color, eq, yellow) at most 5: [picture]"),
    ("Photograph the yellow trees, five at most.", "for Where(leaf_color, eq, yellow) at most 5: [picture]"),
    ("Visit the yellow trees and photograph up to 3 of them.", "for Where(leaf_color, eq, yellow) at most 3: [picture]"),
    ("Read CO2 at the trees of row 3, stop after 8 trees.", "for Rows(3, 3) at most 8: [co2]"),
    ("Measure CO2 along row 3 tree by tree. As soon as it is below 400, stop.", "for Rows(3, 3) until r1 < 400 ppm: [co2 = r1]"),
    ("Measure CO2 at different trees of row 3 until one is below 400 ppm.", "for NotVisited(of Rows(3, 3)) until r1 < 400 ppm: [co2 = r1]"),
    ("Photograph the trees of row 3. Those hotter than 35 degrees get a CO2 reading.", "for Rows(3, 3): [picture = r1; if r1 > 35 degC: [co2]]"),
    ("Along row 3, wherever a tree is not yellow, measure CO2.", "for Where(leaf_color, ne, yellow, of Rows(3, 3)): [co2]"),
    ("Photograph tree 4 after measuring CO2 at tree 9.", "co2 @ TreeIs(9); picture @ TreeIs(4)"),
]  # fmt: skip


@pytest.mark.parametrize(("request_", "plan"), SAME)
def test_the_places_that_are_meant_are_visited(request_: str, plan: str) -> None:
    outcome = composed(request_, SITE, HUSKY)
    assert isinstance(outcome, Planned)
    assert outline(outcome.task) == plan


@pytest.mark.parametrize(
    "request_",
    [
        "Take pictures of different trees in row 3.",  # how many?
        "Photograph trees 4, 5 and 6, two at most.",  # these three, or any two of them?
        "Photograph tree 4. Those hotter than 35 degrees get a CO2 reading.",  # which of them?
    ],
)  # fmt: skip
def test_places_that_are_left_open_are_not_guessed(request_: str) -> None:
    assert not isinstance(composed(request_, SITE, HUSKY), Planned)
