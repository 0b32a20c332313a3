"""So many places in each of several areas, evenly spaced plants of a crop, and ground that is probed."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE = vegetable_garden(), glasshouse(), pasture()
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")

DRAWN = "for UnionOf(PointsIn(bank, 4, True)+PointsIn(boggy corner, 4, True)): [nitrate]"
SPREAD = "for UnionOf(PointsIn(bank, 3)+PointsIn(cow paddock, 3)): [moisture]"

PLANNED = [
    (PASTURE, AMIGA, "Measure nitrate at four random points on the bank and four in the boggy corner.", DRAWN),
    (PASTURE, AMIGA, "Measure nitrate at four random points each on the bank and in the boggy corner.", DRAWN),
    (PASTURE, AMIGA, "Measure nitrate on the bank and in the boggy corner, four random places each.", DRAWN),
    (PASTURE, AMIGA, "Compare nitrate on the bank and in the boggy corner, four random spots each.", DRAWN),
    (PASTURE, AMIGA, "Compare nitrate on the bank and in the boggy corner at four random points each.", DRAWN),
    (PASTURE, AMIGA, "Read nitrate at four points chosen at random on the bank and four in the boggy corner.", DRAWN),
    (PASTURE, AMIGA, "Take soil moisture at three points each on the bank and in the cow paddock.", SPREAD),
    (PASTURE, AMIGA, "Take soil moisture at three points in each of the bank and the cow paddock.", SPREAD),
    (PASTURE, AMIGA, "Compare soil moisture on the bank and in the cow paddock, three spots each.", SPREAD),
    (PASTURE, AMIGA, "Read soil moisture on the bank and in the cow paddock, three spots in each.", SPREAD),
    (
        GARDEN,
        AMIGA,
        "Compare nitrate in beds 3 and 4, three random plants each.",
        "for Quota(row, 3, random, of UnionOf(Rows(3, 3)+Rows(4, 4))): [nitrate]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Read soil moisture at four evenly spaced melons.",
        "for Evenly(4, of Where(crop, eq, melon, of Rows(3, 3))): [moisture]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Read soil moisture at four melon plants, evenly spaced.",
        "for Evenly(4, of Where(crop, eq, melon, of Rows(3, 3))): [moisture]",
    ),
    (
        GARDEN,
        AMIGA,
        "Photograph five evenly spread radishes.",
        "for Evenly(5, of Where(crop, eq, radish, of Rows(3, 3))): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "Photograph four evenly spaced potatoes.",
        "for Spread(4, of Where(crop, eq, potato)): [picture]",
    ),
    (
        PASTURE,
        AMIGA,
        "Test soil moisture on the bank at four evenly spread points.",
        "for PointsIn(bank, 4): [moisture]",
    ),
    (
        PASTURE,
        AMIGA,
        "Probe the bank for moisture at four evenly spread points, 15 cm deep.",
        "for PointsIn(bank, 4): [moisture(depth_cm 15)]",
    ),
    (
        PASTURE,
        TRACTOR,
        "Probe the bank at four evenly spread points, 15 cm deep.",
        "for PointsIn(bank, 4): [moisture(depth_cm 15)]",
    ),
    (
        PASTURE,
        HUSKY,
        "Test the boggy corner for CO2 at six random points.",
        "for PointsIn(boggy corner, 6, True): [co2]",
    ),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_each_area_has_its_share(site: object, robot: object, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(
    ("site", "robot", "request_"),
    [
        (PASTURE, AMIGA, "Probe the bank at four evenly spread points, 15 cm deep."),
        (GARDEN, AMIGA, "Probe every third bean."),
        (GARDEN, AMIGA, "Please get six soil samples from the kale bed."),
    ],
)
def test_what_is_probed_is_asked(site: object, robot: object, request_: str) -> None:
    require_question(site, robot, request_, 2)


def test_samples_of_soil_are_no_reading_where_none_is_to_be_chosen() -> None:
    require_refusal(PASTURE, TRACTOR, "Get six soil samples from the bank.", "soil")
