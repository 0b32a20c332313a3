"""Wishes for results, which the report states: averages, what is highest, how readings compare."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE, ORCHARD = vegetable_garden(), glasshouse(), pasture(), open_site("demo")
HUSKY, AMIGA = load_robot("husky"), load_robot("amiga")

PLANNED = [
    (
        PASTURE,
        AMIGA,
        "Read the soil moisture at 12 random points in the cow paddock. I want the average.",
        "for PointsIn(cow paddock, 12, True): [moisture]",
    ),
    (
        PASTURE,
        AMIGA,
        "Read the nitrate at six points on the bank, and tell me the mean and the spread.",
        "for PointsIn(bank, 6): [nitrate]",
    ),
    (
        PASTURE,
        HUSKY,
        "Read the air temperature at the bank and in the boggy corner and tell me the difference.",
        "for UnionOf(PointsIn(bank)+PointsIn(boggy corner)): [air]",
    ),
    (
        PASTURE,
        HUSKY,
        "Read CO2 in the middle of the bank and of the cow paddock, then tell me which is higher.",
        "for UnionOf(PointsIn(bank)+PointsIn(cow paddock)): [co2]",
    ),
    (
        GARDEN,
        AMIGA,
        "Read the nitrate beside every second kale, and work out the mean.",
        "for EveryNth(2, of Where(crop, eq, kale)): [nitrate]",
    ),
    (
        GARDEN,
        AMIGA,
        "Read the nitrate at four beans. I need the lowest and the highest value.",
        "for Take(4, of Where(crop, eq, bean)): [nitrate]",
    ),
    (
        GARDEN,
        AMIGA,
        "Measure the soil moisture at every third squash. Which plant is driest?",
        "for EveryNth(3, of Where(crop, eq, squash)): [moisture]",
    ),
    (
        GARDEN,
        AMIGA,
        "Read the soil moisture at every squash; tell me the average of each bed.",
        "for Where(crop, eq, squash): [moisture]",
    ),
    (
        GARDEN,
        AMIGA,
        "Read the soil moisture at every squash and let me know how it varies along the bed.",
        "for Where(crop, eq, squash): [moisture]",
    ),
    (
        GARDEN,
        AMIGA,
        "Get me the average nitrate of bed 4 from four readings.",
        "for Evenly(4, of Rows(4, 4)): [nitrate]",
    ),
    (
        GARDEN,
        HUSKY,
        "Measure the air temperature at both ends of bed 2, give me the mean of the two readings, and come home.",
        "for UnionOf(InRow(1, 1, of Rows(2, 2))+InRow(-1, -1, of Rows(2, 2))): [air]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "Measure CO2 at every third melon. What is the average?",
        "for EveryNth(3, of Where(crop, eq, melon)): [co2]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Measure the soil moisture at every melon, then report all the readings.",
        "for Where(crop, eq, melon): [moisture]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Measure the soil moisture at every melon. Tell me how far each has moved.",
        "for Where(crop, eq, melon): [moisture]",
    ),
    (
        ORCHARD,
        HUSKY,
        "Measure CO2 at every tree in row 3. Tell me where it is highest.",
        "for Rows(3, 3): [co2]",
    ),
    (
        ORCHARD,
        HUSKY,
        "Measure CO2 at every tree in row 3 and every tree in row 4, and tell me which row is higher on average.",
        "for UnionOf(Rows(3, 3)+Rows(4, 4)): [co2]",
    ),
    (
        PASTURE,
        AMIGA,
        "I want to know the average soil moisture of the boggy corner from ten readings.",
        "for PointsIn(boggy corner, 10): [moisture]",
    ),
    (
        PASTURE,
        AMIGA,
        "Tell me the average nitrate of the bank, based on twelve points.",
        "for PointsIn(bank, 12): [nitrate]",
    ),
]

REFUSED = [
    (
        GARDEN,
        AMIGA,
        "Photograph every bean and tell me which plants have rust.",
        "recognise something",
    ),
    (
        GARDEN,
        AMIGA,
        "If the soil moisture at V3-1 is below 20 percent, tell me.",
        "message to somebody",
    ),
    (
        ORCHARD,
        HUSKY,
        "Photograph tree 4 and tell me the average soil moisture.",
        "cannot read the soil moisture",
    ),
    (
        ORCHARD,
        HUSKY,
        "Measure CO2 at every tree in row 3. Send me the average by email.",
        "message to somebody",
    ),
    (
        ORCHARD,
        HUSKY,
        "Measure CO2 at every tree in row 3. If the average is above 500 ppm, tell me the average.",
        "message to somebody",
    ),
    (
        GARDEN,
        AMIGA,
        "Take a leaf from every bean and tell me the average.",
        "message to somebody",
    ),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_the_plan_is_what_is_meant(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_the_refusal_says_why(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)
