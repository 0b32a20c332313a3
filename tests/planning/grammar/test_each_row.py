"""What a sentence says of each of several rows holds for all of its commands."""

from __future__ import annotations

import pytest

from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

NORTHERN = "Extreme(north, of Rows(2, 2))+Extreme(north, of Rows(3, 3))"
SOUTHERN = "Extreme(south, of Rows(2, 2))+Extreme(south, of Rows(3, 3))"


@pytest.mark.parametrize(
    ("request_", "expected"),
    [
        (
            "For each of rows 2 and 3, photograph the northernmost tree and measure CO2 at the southernmost tree.",
            f"for UnionOf({NORTHERN}): [picture]; for UnionOf({SOUTHERN}): [co2]",
        ),
        (
            "For each row from 2 to 3, visit the northernmost tree and photograph it, then visit the southernmost tree "
            "and measure CO2.",
            f"for UnionOf({NORTHERN}): [picture]; for UnionOf({SOUTHERN}): [co2]",
        ),
        (
            "For each of rows 2 and 3, photograph the northernmost tree and then tree 5.",
            f"for UnionOf({NORTHERN}): [picture]; picture @ TreeIs(5)",
        ),
        (
            "For each of rows 2 and 3, photograph the northernmost tree. Photograph the southernmost tree, too.",
            f"for UnionOf({NORTHERN}): [picture]; picture @ Extreme(south)",
        ),
        (
            "Photograph the middle tree of rows 2 and 3.",
            "for UnionOf(Middle(of Rows(2, 2))+Middle(of Rows(3, 3))): [picture]",
        ),
        (
            "Take one thermal picture in every fifth row, at the middle tree.",
            "for UnionOf(Middle(of Rows(1, 1))+Middle(of Rows(6, 6))): [picture]",
        ),
        (
            "Photograph the yellow trees in the eastern half first and then those in the western half.",
            "for Where(leaf_color, eq, yellow, of Half(east)): [picture]; "
            "for Where(leaf_color, eq, yellow, of Half(west)): [picture]",
        ),
    ],
)
def test_each_row_holds_for_the_sentence(request_: str, expected: str) -> None:
    planned = composed(request_, open_site("demo"), load_robot("husky"))
    assert isinstance(planned, Planned)
    assert outline(planned.task) == expected
