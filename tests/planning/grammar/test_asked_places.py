"""Questions that the site's file answers about what is visited next, and both of two places that were named."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_refusal
from support.sites.gardens import glasshouse, vegetable_garden

DEMO, GARDEN, GLASSHOUSE = open_site("demo"), vegetable_garden(), glasshouse()
HUSKY, AMIGA = load_robot("husky"), load_robot("amiga")
TALLEST = "go Top(height_cm, 1, of Where(crop, eq, squash)); picture"
DRIEST = "Top(moisture, 1, True, of Where(crop, eq, melon))"
WETTEST = "Top(moisture, 1, of Where(crop, eq, mint))"
BOTH = f"for UnionOf({DRIEST}+{WETTEST}): [moisture]"
AT_DEPTHS = f"for UnionOf({DRIEST}+{WETTEST}): [moisture(depth_cm 10); moisture(depth_cm 30)]"

PLANNED = [
    (GARDEN, AMIGA, "Which squash is the tallest? Photograph it.", TALLEST),
    (GARDEN, AMIGA, "Which is the tallest squash? Photograph it.", TALLEST),
    (GARDEN, AMIGA, "What is the tallest squash? Take a picture of it.", TALLEST),
    (GARDEN, AMIGA, "According to the map, which squash is the tallest? Take a picture of it.", TALLEST),
    (DEMO, HUSKY, "Which tree is the oldest? Photograph it.", "go Top(age_years, 1); picture"),
    (
        DEMO,
        HUSKY,
        "Which is the youngest tree in row 3? Photograph it.",
        "go Top(age_years, 1, True, of Rows(3, 3)); picture",
    ),
    (DEMO, HUSKY, "Which three trees are the oldest? Photograph them.", "for Top(age_years, 3): [picture]"),
    (GLASSHOUSE, AMIGA, "Which melon is the driest? Check the soil moisture there.", f"go {DRIEST}; moisture"),
    (GLASSHOUSE, AMIGA, "On our list, which melon is the driest? Read its moisture.", f"go {DRIEST}; moisture"),
    (GLASSHOUSE, AMIGA, "Which melon is driest and which mint is wettest? Check the soil moisture at both.", BOTH),
    (GLASSHOUSE, AMIGA, "Check the soil moisture at the driest melon according to the map.", f"moisture @ {DRIEST}"),
    (GLASSHOUSE, AMIGA, "According to the map, check the soil moisture at the driest melon.", f"moisture @ {DRIEST}"),
    (
        GLASSHOUSE,
        AMIGA,
        "According to the map, which melon is the driest and which mint is the wettest?"
        " Check the soil moisture at both plants, at 10 cm and at 30 cm.",
        AT_DEPTHS,
    ),
    (GLASSHOUSE, AMIGA, "Find the driest melon and the wettest mint and check the soil moisture at both plants.", BOTH),
    (GLASSHOUSE, AMIGA, "The driest melon and the wettest mint: check the soil moisture at both plants.", BOTH),
    (
        DEMO,
        HUSKY,
        "Go to trees 4 and 9 and take a picture at both trees.",
        "for UnionOf(TreeIs(4)+TreeIs(9)): [picture]",
    ),
    (
        DEMO,
        HUSKY,
        "Photograph trees 4 and 9. Measure CO2 at both trees.",
        "for UnionOf(TreeIs(4)+TreeIs(9)): [picture; co2]",
    ),
    (DEMO, HUSKY, "Visit tree 3 and tree 9 and photograph both trees.", "for UnionOf(TreeIs(3)+TreeIs(9)): [picture]"),
]

REFUSED = [
    (DEMO, HUSKY, "Go to trees 4, 5 and 9 and take a picture at both trees.", "no such ones"),
    (DEMO, HUSKY, "Measure CO2 at both trees.", "which place is meant"),
    (DEMO, HUSKY, "Photograph both trees.", "which place is meant"),
    (DEMO, HUSKY, "Which tree is the oldest?", "asks for nothing"),
    (DEMO, HUSKY, "Which trees are the oldest? Photograph them.", "which place is meant"),
    (DEMO, HUSKY, "According to the map, photograph tree 4.", "each word is known"),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_places_are_asked_for(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_other_questions_are_refused(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)
