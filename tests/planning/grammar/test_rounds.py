"""Corners are visited in the order of a round, clockwise or against the clock, from the corner that is named."""

from __future__ import annotations

import pytest

from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Clarify, Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

CLOCKWISE = "for UnionOf(Corners(nw)+Corners(ne)+Corners(se)+Corners(sw)) given: [picture]"


@pytest.mark.parametrize(
    ("request_", "expected"),
    [
        ("Photograph the corner trees clockwise starting in the north-west.", CLOCKWISE),
        ("Photograph the four corners, beginning at the north-west corner and going round clockwise.", CLOCKWISE),
        ("Photograph the north-west corner tree, then the others clockwise.", CLOCKWISE),
        (
            "Visit the corners anti-clockwise, starting with the south-east one, and photograph each of them.",
            "for UnionOf(Corners(se)+Corners(ne)+Corners(nw)+Corners(sw)) given: [picture]",
        ),
    ],
)
def test_corners_are_visited_in_the_order_of_a_round(request_: str, expected: str) -> None:
    planned = composed(request_, open_site("demo"), load_robot("husky"))
    assert isinstance(planned, Planned)
    assert outline(planned.task) == expected


def test_a_round_without_a_first_corner_asks_for_it() -> None:
    asked = composed("Photograph the four corners clockwise.", open_site("demo"), load_robot("husky"))
    assert isinstance(asked, Clarify)
    assert len(asked.choices) == 4


def test_rows_have_no_round() -> None:
    assert not isinstance(
        composed("Photograph rows 2 and 3 clockwise.", open_site("demo"), load_robot("husky")), Planned
    )
