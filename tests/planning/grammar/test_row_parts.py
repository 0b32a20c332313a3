"""Work along parts of rows: trees of a kind, from one tree to another, so many of a row."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_refusal
from support.sites.gardens import glasshouse

DEMO, GLASSHOUSE, TRACTOR = open_site("demo"), glasshouse(), load_robot("tractor")
PART = "film rows InRow(1, 3, of Rows(1, 1))"

PLANNED = [
    (DEMO, "film trees 3 to 8 of row 4", "film rows InRow(3, 8, of Rows(4, 4))"),
    (DEMO, "film the first six trees of row 4", "film rows InRow(1, 6, of Rows(4, 4))"),
    (DEMO, "film the last 4 trees of row 2", "film rows InRow(-4, -1, of Rows(2, 2))"),
    (DEMO, "spray the first five trees of rows 4 and 5", "spray rows InRow(1, 5, of UnionOf(Rows(4, 4)+Rows(5, 5)))"),
    (GLASSHOUSE, "film the aubergines from H1-1 to H1-3", PART),
    (GLASSHOUSE, "film plants H1-1 to H1-3", PART),
    (GLASSHOUSE, "film row 1 from H1-1 to H1-3", PART),
    (GLASSHOUSE, "film from H1-1 to H1-3", PART),
    (GLASSHOUSE, "film between H1-1 and H1-3", PART),
    (GLASSHOUSE, "film H1-2 and H1-5", "film rows UnionOf(TreeIs(H1-2)+TreeIs(H1-5))"),
]
PLANNED += [
    (DEMO, "film as much of row 4 as 20 minutes allow", "film rows Rows(4, 4), optional | duration_s 1200"),
    (DEMO, "spray as much of rows 3 to 5 as 20 minutes allow", "spray rows Rows(3, 5), optional | duration_s 1200"),
]
REFUSED = [
    (GLASSHOUSE, "film H1-2", "not at single trees"),
    (GLASSHOUSE, "film H1-2 and H3-2", "not at single trees"),
    (GLASSHOUSE, "film from H1-1 to H3-3", "do not stand in one row"),
    (GLASSHOUSE, "film row 2 from H1-1 to H1-3", ""),
]


@pytest.mark.parametrize(("site", "request_", "plan"), PLANNED, ids=name)
def test_parts_of_rows_are_worked(site: Site, request_: str, plan: str) -> None:
    require_plan(site, TRACTOR, request_, plan)


@pytest.mark.parametrize(("site", "request_", "why"), REFUSED, ids=name)
def test_single_trees_and_trees_of_different_rows_are_refused(site: Site, request_: str, why: str) -> None:
    require_refusal(site, TRACTOR, request_, why)


def test_a_robot_without_an_implement_is_said_to_lack_it() -> None:
    husky: RobotProfile = load_robot("husky")
    require_refusal(DEMO, husky, "spray the first five trees of row 4", "no action 'spray'")
