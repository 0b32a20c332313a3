"""Requests about each of several areas, plants that are counted from an end, and crops as ground."""

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
        "Read the air temperature at four random spots in each bay.",
        "for UnionOf(PointsIn(hot bay, 4, True)+PointsIn(mild bay, 4, True)): [air]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "Read the air temperature at four random spots in the hot bay and four in the mild bay.",
        "for UnionOf(PointsIn(hot bay, 4, True)+PointsIn(mild bay, 4, True)): [air]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "Measure CO2 in the middle of the two bays.",
        "for UnionOf(PointsIn(hot bay)+PointsIn(mild bay)): [co2]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "Measure the carbon dioxide in the middle of each bay.",
        "for UnionOf(PointsIn(hot bay)+PointsIn(mild bay)): [co2]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "Take a thermal picture of every fourth plant in each bay.",
        "for EveryNth(4, of UnionOf(InZone(hot bay)+InZone(mild bay))): [picture]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "Take three CO2 readings in each bay.",
        "for UnionOf(Take(3, of InZone(hot bay))+Take(3, of InZone(mild bay))): [co2]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "Read the CO2 in both bays, three readings each.",
        "for UnionOf(Take(3, of InZone(hot bay))+Take(3, of InZone(mild bay))): [co2]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "In each bay, read the CO2 at five plants.",
        "for UnionOf(Take(5, of InZone(hot bay))+Take(5, of InZone(mild bay))): [co2]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "Photograph the driest plant in each bay.",
        (
            "for UnionOf(Top(moisture, 1, True, of InZone(hot bay))+Top(moisture, 1, True, of InZone(mild "
            "bay))): [picture]"
        ),
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "Photograph the two driest plants of both bays.",
        (
            "for UnionOf(Top(moisture, 2, True, of InZone(hot bay))+Top(moisture, 2, True, of InZone(mild "
            "bay))): [picture]"
        ),
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "Photograph every plant in both bays.",
        "for UnionOf(InZone(hot bay)+InZone(mild bay)): [picture]",
    ),
    (
        GLASSHOUSE,
        TRACTOR,
        "Read the soil moisture at both ends and in the middle of every row in the mild bay.",
        (
            "for UnionOf(InRow(1, 1, of Rows(4, 4, of InBlock(mild bay, of InZone(mild bay))))+InRow(-1, -1,"
            " of Rows(4, 4, of InBlock(mild bay, of InZone(mild bay))))+Middle(of Rows(4, 4, of InBlock(mild bay,"
            " of InZone(mild bay))))+InRow(1, 1, of Rows(3, 3, of InBlock(mild bay, of InZone(mild bay))))"
            "+InRow(-1, -1, of Rows(3, 3, of InBlock(mild bay, of InZone(mild bay))))+Middle(of Rows(3, 3,"
            " of InBlock(mild bay, of InZone(mild bay))))): [moisture]"
        ),
    ),
    (
        PASTURE,
        AMIGA,
        "Take a picture of the ground in the middle of each quarter of the cow paddock.",
        (
            "for UnionOf(PointsIn(cow paddock, nw)+PointsIn(cow paddock, ne)+PointsIn(cow paddock, "
            "se)+PointsIn(cow paddock, sw)): [picture(view ground)]"
        ),
    ),
    (
        PASTURE,
        AMIGA,
        "Read the nitrate in the centre of the four quarters of the bank.",
        "for UnionOf(PointsIn(bank, nw)+PointsIn(bank, ne)+PointsIn(bank, se)+PointsIn(bank, sw)): [nitrate]",
    ),
    (
        PASTURE,
        AMIGA,
        "Read the nitrate at three random points in each quarter of the cow paddock.",
        (
            "for UnionOf(PointsIn(cow paddock, 3, True, nw)+PointsIn(cow paddock, 3, True, ne)+PointsIn(cow "
            "paddock, 3, True, se)+PointsIn(cow paddock, 3, True, sw)): [nitrate]"
        ),
    ),
    (
        PASTURE,
        AMIGA,
        "Read the nitrate at five points each in the boggy corner and on the bank.",
        "for UnionOf(PointsIn(boggy corner, 5)+PointsIn(bank, 5)): [nitrate]",
    ),
    (
        PASTURE,
        AMIGA,
        "Read the nitrate at five random points in the boggy corner, the bank and the cowslip patch each.",
        (
            "for UnionOf(PointsIn(boggy corner, 5, True)+PointsIn(bank, 5, True)+PointsIn(cowslip patch, 5, "
            "True)): [nitrate]"
        ),
    ),
    (
        PASTURE,
        HUSKY,
        "Read CO2 in the middle of the bank, the cow paddock and the boggy corner.",
        "for UnionOf(PointsIn(bank)+PointsIn(cow paddock)+PointsIn(boggy corner)): [co2]",
    ),
    (
        PASTURE,
        HUSKY,
        "Read CO2 in the middle of every zone.",
        (
            "for UnionOf(PointsIn(long pasture)+PointsIn(cow paddock)+PointsIn(boggy "
            "corner)+PointsIn(bank)+PointsIn(cowslip patch)): [co2]"
        ),
    ),
    (
        PASTURE,
        AMIGA,
        "Take five pictures of the ground on the bank.",
        "for PointsIn(bank, 5): [picture(view ground)]",
    ),
    (
        ORCHARD,
        HUSKY,
        "Take a picture of the tree in the middle of each quarter of the orchard.",
        (
            "for UnionOf(Middle(of Quarter(nw))+Middle(of Quarter(ne))+Middle(of Quarter(se))+Middle(of "
            "Quarter(sw))): [picture]"
        ),
    ),
    (
        GARDEN,
        HUSKY,
        "Take a thermal picture of every third potato in both potato beds, and count from the north end each time.",
        "for EveryNth(3, north, of Where(crop, eq, potato, of Rows(of Where(crop, eq, potato)))): [picture]",
    ),
    (
        GARDEN,
        HUSKY,
        "Photograph every second bean, counting from the southern end.",
        "for EveryNth(2, south, of Where(crop, eq, bean)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "Photograph every third kale. Count from the south.",
        "for EveryNth(3, south, of Where(crop, eq, kale)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "In beds 3 and 4, photograph the second and the fifth plant, counting from the north end in each.",
        (
            "for UnionOf(InRow(2, 2, north, of UnionOf(Rows(3, 3)+Rows(4, 4)))+InRow(5, 5, north, of "
            "UnionOf(Rows(3, 3)+Rows(4, 4)))): [picture]"
        ),
    ),
    (
        ORCHARD,
        HUSKY,
        "Photograph every third tree of rows 3 and 4. Count from the south end.",
        "for EveryNth(3, south, of UnionOf(Rows(3, 3)+Rows(4, 4))): [picture]",
    ),
    (
        ORCHARD,
        HUSKY,
        "Photograph every third tree of row 3, starting the count at the south end.",
        "for EveryNth(3, south, of Rows(3, 3)): [picture]",
    ),
    (
        ORCHARD,
        HUSKY,
        "Photograph every third tree of row 3, counting from the second tree.",
        "for EveryNth(3, 2, of Rows(3, 3)): [picture]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "Photograph every fourth melon, and count from the east.",
        "for EveryNth(4, east, of Where(crop, eq, melon)): [picture]",
    ),
    (
        GARDEN,
        TRACTOR,
        "Spray the squash at 150 litres per hectare.",
        "spray rows Where(crop, eq, squash), rate_l_ha 150",
    ),
    (
        GARDEN,
        TRACTOR,
        "Spray the radish from both sides.",
        "spray rows Where(crop, eq, radish), both",
    ),
    (
        GARDEN,
        TRACTOR,
        "Film the bean and the kale.",
        "film rows UnionOf(Where(crop, eq, bean)+Where(crop, eq, kale))",
    ),
]

REFUSED = [
    (
        ORCHARD,
        HUSKY,
        "Photograph every third tree of row 3 and count from the east.",
        "cannot be counted from the east",
    ),
    (
        ORCHARD,
        HUSKY,
        "Photograph the yellow trees, counting from the north.",
        "does not fit at this point",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "Measure CO2 in the middle of the three bays.",
        "does not fit at this point",
    ),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_the_plan_is_what_is_meant(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_the_refusal_says_why(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)
