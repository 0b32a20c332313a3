"""Requests about neighbours and plants opposite, the nearest one next, soil samples, and waits for the weather."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE, ORCHARD = vegetable_garden(), glasshouse(), pasture(), open_site("demo")
HUSKY, AMIGA = load_robot("husky"), load_robot("amiga")

PLANNED = [
    (
        PASTURE,
        HUSKY,
        (
            "Take a CO2 reading at the bank, at the boggy corner and at the cowslip patch, always going to "
            "the nearest one next."
        ),
        "for UnionOf(PointsIn(bank)+PointsIn(boggy corner)+PointsIn(cowslip patch)): [co2]",
    ),
    (
        ORCHARD,
        HUSKY,
        "Photograph trees 4, 9 and 12, each time going to the closest one left.",
        "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(12)): [picture]",
    ),
    (
        ORCHARD,
        HUSKY,
        "Photograph the yellow trees, always the nearest one next.",
        "for Where(leaf_color, eq, yellow): [picture]",
    ),
    (
        GARDEN,
        HUSKY,
        (
            "Take a thermal picture of every plant with frost damage and of its direct neighbours in the "
            "row, but no plant twice."
        ),
        "for UnionOf(Where(frost_damage, eq, True)+TreeIs(V58)+TreeIs(V56)+TreeIs(V54)+TreeIs(V52)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "Photograph the plants with frost damage and the plants beside them.",
        "for UnionOf(Where(frost_damage, eq, True)+TreeIs(V58)+TreeIs(V56)+TreeIs(V54)+TreeIs(V52)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "Photograph each plant with frost damage and the plants next to it in the row.",
        "for UnionOf(Where(frost_damage, eq, True)+TreeIs(V58)+TreeIs(V56)+TreeIs(V54)+TreeIs(V52)): [picture]",
    ),
    (
        ORCHARD,
        HUSKY,
        "Photograph every yellow tree of row 3 along with its immediate neighbours.",
        (
            "for UnionOf(Where(leaf_color, eq, yellow, of Rows(3, "
            "3))+TreeIs(50)+TreeIs(48)+TreeIs(45)+TreeIs(43)): [picture]"
        ),
    ),
    (
        ORCHARD,
        HUSKY,
        "Photograph the yellow trees in row 3 and their neighbours, without doing any tree twice.",
        (
            "for UnionOf(Where(leaf_color, eq, yellow, of Rows(3, "
            "3))+TreeIs(50)+TreeIs(48)+TreeIs(45)+TreeIs(43)): [picture]"
        ),
    ),
    (
        ORCHARD,
        HUSKY,
        "Photograph the yellow trees in row 3 and both their neighbours, each tree only once.",
        (
            "for UnionOf(Where(leaf_color, eq, yellow, of Rows(3, "
            "3))+TreeIs(50)+TreeIs(48)+TreeIs(45)+TreeIs(43)): [picture]"
        ),
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Photograph each plant in row 1 and after each one the plant opposite.",
        "for Rows(1, 1): [picture; picture @ Across]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Photograph each plant in row 1 and the one across from it in row 2.",
        "for Rows(1, 1): [picture; picture @ Across]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Photograph the trunk of each plant in row 1 and of the plant opposite it.",
        "for Rows(1, 1): [picture(view trunk); picture(view trunk) @ Across]",
    ),
    (
        ORCHARD,
        HUSKY,
        "Photograph each yellow tree and, after each one, the tree across the aisle.",
        "for Where(leaf_color, eq, yellow): [picture; picture @ Across]",
    ),
    (
        ORCHARD,
        HUSKY,
        "At each yellow tree in row 3, take a picture and read CO2 at the tree opposite.",
        "for Where(leaf_color, eq, yellow, of Rows(3, 3)): [picture; co2 @ Across]",
    ),
]

ASKED = [
    (
        PASTURE,
        AMIGA,
        "Take ten soil samples on the bank.",
        2,
    ),
    (
        GARDEN,
        AMIGA,
        "Take a soil sample at each squash.",
        2,
    ),
]

REFUSED = [
    (
        GARDEN,
        HUSKY,
        "Take a soil sample at each squash.",
        "no action for",
    ),
    (
        GARDEN,
        HUSKY,
        "Check the beans for me once it has warmed up.",
        "gives neither a time to begin nor a value to wait for",
    ),
    (
        GARDEN,
        HUSKY,
        "Photograph the beans when the soil has dried out.",
        "gives neither a time to begin nor a value to wait for",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Photograph each plant in row 1 and the melon opposite it.",
        "not everywhere one of those",
    ),
    (
        ORCHARD,
        HUSKY,
        "Photograph each yellow tree and after each one measure CO2 at the charger.",
        "it is not clear what is done after each of them",
    ),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_the_plan_is_what_is_meant(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "ways"), ASKED, ids=name)
def test_what_is_open_is_asked(site: Site, robot: RobotProfile, request_: str, ways: int) -> None:
    require_question(site, robot, request_, ways)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_the_refusal_says_why(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)
