"""Requests about two places: how far their readings differ, work at one and then the other, so many of each."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE, ORCHARD = vegetable_garden(), glasshouse(), pasture(), open_site("demo")
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")

PLANNED = [
    (
        GLASSHOUSE,
        HUSKY,
        (
            "Measure the air temperature in the hot bay and the mild bay. If the difference is more than 5 "
            "degrees, take thermal pictures of the melons."
        ),
        (
            "for PointsIn(hot bay): [air = r1]; for PointsIn(mild bay): [air = r2]; if mean(r1) > mean(r2) +"
            " 5 degC or mean(r2) > mean(r1) + 5 degC: [for Where(crop, eq, melon): [picture]]"
        ),
    ),
    (
        ORCHARD,
        HUSKY,
        "Measure CO2 at tree 4 and at tree 9. If they differ by more than 50 ppm, photograph tree 9.",
        (
            "co2 @ TreeIs(4) = r1; co2 @ TreeIs(9) = r2; if mean(r1) > mean(r2) + 50 ppm or mean(r2) > "
            "mean(r1) + 50 ppm: [picture @ TreeIs(9)]"
        ),
    ),
    (
        ORCHARD,
        HUSKY,
        "Measure CO2 at trees 4 and 9. If the difference between them is below 20 ppm, photograph tree 9.",
        (
            "for TreeIs(4): [co2 = r1]; for TreeIs(9): [co2 = r2]; if mean(r1) < mean(r2) + 20 ppm and "
            "mean(r2) < mean(r1) + 20 ppm: [picture @ TreeIs(9)]"
        ),
    ),
    (
        GLASSHOUSE,
        HUSKY,
        (
            "Read the air temperature at four random spots in each bay. If the two differ by more than 5 "
            "degrees, take a CO2 reading at H1-1."
        ),
        (
            "for PointsIn(hot bay, 4, True): [air = r1]; for PointsIn(mild bay, 4, True): [air = r2]; if "
            "mean(r1) > mean(r2) + 5 degC or mean(r2) > mean(r1) + 5 degC: [co2 @ TreeIs(H1-1)]"
        ),
    ),
    (
        PASTURE,
        TRACTOR,
        "Mow the bank, then the boggy corner.",
        "mow area InZone(bank); mow area InZone(boggy corner)",
    ),
    (
        PASTURE,
        TRACTOR,
        "Mow the bank first, then the boggy corner.",
        "mow area InZone(bank); mow area InZone(boggy corner)",
    ),
    (
        GARDEN,
        TRACTOR,
        "Film bed 3 and then bed 5.",
        "film rows Rows(3, 3); film rows Rows(5, 5)",
    ),
    (
        ORCHARD,
        TRACTOR,
        "Spray row 3, then row 5, then row 7.",
        "spray rows Rows(3, 3); spray rows Rows(5, 5); spray rows Rows(7, 7)",
    ),
    (
        GLASSHOUSE,
        TRACTOR,
        "Film row 4 twice, once from each side.",
        "film rows Rows(4, 4), both",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "Take thermal pictures of the Black King and the Charente, three plants of each, picked at random.",
        (
            "for Quota(cultivar, 3, random, of UnionOf(Where(cultivar, eq, Black King)+Where(cultivar, eq, "
            "Charente))): [picture]"
        ),
    ),
    (
        GARDEN,
        AMIGA,
        "Read the nitrate in the beans and in the potatoes, at three places in each bed.",
        "for Quota(row, 3, of UnionOf(Where(crop, eq, bean)+Where(crop, eq, potato))): [nitrate]",
    ),
    (
        GARDEN,
        AMIGA,
        "Read the nitrate in the beans and the potatoes, three plants of each.",
        "for Quota(crop, 3, of UnionOf(Where(crop, eq, bean)+Where(crop, eq, potato))): [nitrate]",
    ),
    (
        PASTURE,
        AMIGA,
        "Compare the soil moisture of the boggy corner and the bank: eight random points in each, at 20 cm.",
        "for UnionOf(PointsIn(boggy corner, 8, True)+PointsIn(bank, 8, True)): [moisture(depth_cm 20)]",
    ),
    (
        ORCHARD,
        TRACTOR,
        "Film row 3 and photograph tree 4, then tree 9.",
        "film rows Rows(3, 3); picture @ TreeIs(4); picture @ TreeIs(9)",
    ),
]

REFUSED = [
    (
        ORCHARD,
        HUSKY,
        "Measure CO2 at tree 4, tree 9 and tree 12. If they differ by more than 50 ppm, photograph tree 9.",
        "it is not clear which readings are tested",
    ),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_the_plan_is_what_is_meant(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_the_refusal_says_why(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)
