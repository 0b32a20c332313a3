"""Ends that are left out, plants that are clean, beds beside a crop, and days of sowing in words."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from planning.grammar.field_requests import name, require_plan
from support.sites.gardens import glasshouse, vegetable_garden

GARDEN, GLASSHOUSE = vegetable_garden(), glasshouse()
AMIGA = load_robot("amiga")

ENDS = "UnionOf(InRow(1, 1, of Rows(3, 3))+InRow(-1, -1, of Rows(3, 3)))"
WITHOUT_ENDS = f"for Excluding({ENDS}, of Where(crop, eq, radish, of Rows(3, 3))): [picture]"
EACH_WITHOUT = "for Excluding(UnionOf(InRow(1, 1, of Rows)+InRow(-1, -1, of Rows)), of Rows): [picture]"


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Photograph all the radishes in bed 3 apart from the one at either end.", WITHOUT_ENDS),
        ("Photograph all the radishes in bed 3 apart from the two at the ends.", WITHOUT_ENDS),
        ("Photograph all the radishes in bed 3 except the ones at both ends.", WITHOUT_ENDS),
        ("Photograph all the radishes in bed 3 but not the plants at the ends.", WITHOUT_ENDS),
        ("Photograph every radish in bed 3 except for one at each end.", WITHOUT_ENDS),
        ("Photograph all the radishes in bed 3 except the end plants.", WITHOUT_ENDS),
        (
            "Photograph bed 3, leaving out the two at each end.",
            "for Excluding(UnionOf(InRow(1, 2, of Rows(3, 3))+InRow(-2, -1, of Rows(3, 3))), of Rows(3, 3)): [picture]",
        ),
        ("Photograph all the plants in each bed apart from the one at either end.", EACH_WITHOUT),
        ("Photograph all the plants in each bed apart from the plants at the ends.", EACH_WITHOUT),
        (
            "Photograph each bed apart from the one at either end.",
            "for Excluding(UnionOf(Rows(1, 1)+Rows(-1, -1)), of Rows): [picture]",
        ),
    ],
    ids=name,
)
def test_ends_are_left_out(request_: str, plan: str) -> None:
    require_plan(GARDEN, AMIGA, request_, plan)
