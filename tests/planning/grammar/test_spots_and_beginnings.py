"""Spots between and beside things, grids over ground, so many of each kind, and where or when the work begins."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE, ORCHARD = vegetable_garden(), glasshouse(), pasture(), open_site("demo")
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")

PLANNED = [
    # "Next to" is said of all that follows it.
    (GARDEN, AMIGA, "Take a picture next to the manure heap and the rose bed.",
     "for UnionOf(Transect(1, edge, manure heap, -1.5)+Transect(1, edge, rose bed, -1.5)): [picture]"),
    (GARDEN, AMIGA, "Take a picture next to the manure heap and in the rose bed.",
     "picture @ Transect(1, edge, manure heap, -1.5); picture @ PointsIn(rose bed)"),
    (GARDEN, AMIGA, "Take a picture next to the manure heap and the street gate.",
     "for UnionOf(Transect(1, edge, manure heap, -1.5)+GateIs(street gate)): [picture]"),
    # Places in an aisle.
    (GARDEN, AMIGA, "Read the soil moisture between beds 4 and 5, at the north end.",
     "moisture @ Beside(east, of InRow(1, 1, north, of Rows(4, 4)))"),
    (GARDEN, AMIGA, "Read the soil moisture in the middle between beds 4 and 5.",
     "moisture @ Beside(east, of Middle(of Rows(4, 4)))"),
    (GARDEN, AMIGA, "Read the soil moisture at both ends of the path between beds 4 and 5.",
     "for UnionOf(Beside(east, of InRow(1, 1, of Rows(4, 4)))"
     "+Beside(east, of InRow(-1, -1, of Rows(4, 4)))): [moisture]"),
    (GARDEN, AMIGA, "Read the soil moisture at the south end of each aisle between beds 3 and 5.",
     "for UnionOf(Beside(east, of InRow(1, 1, south, of Rows(3, 3)))"
     "+Beside(east, of InRow(1, 1, south, of Rows(4, 4)))): [moisture]"),
    # Halfway between two places.
    (PASTURE, HUSKY, "Read CO2 halfway between the boggy corner and the bank.",
     "co2 @ StraightLine(InZone(boggy corner), InZone(bank), 1)"),
    (PASTURE, HUSKY, "Read CO2 midway between the farm gate and the pond.",
     "co2 @ StraightLine(GateIs(farm gate), InZone(pond), 1)"),
    (GLASSHOUSE, HUSKY, "CO2 mid hot bay and mid mild bay.",
     "for UnionOf(PointsIn(hot bay)+PointsIn(mild bay)): [co2]"),
    # Points all over ground, and along its edge.
    (PASTURE, AMIGA, "Photograph the ground all over the cowslip patch, one picture every 4 m.",
     "for Grid(4, cowslip patch): [picture(view ground)]"),
    (PASTURE, AMIGA, "Take a picture every 4 m all over the cowslip patch.", "for Grid(4, cowslip patch): [picture]"),
    (PASTURE, HUSKY, "Thermal pictures every 4 m around the cowslip patch.",
     "for Transect(4, edge, cowslip patch): [picture]"),
    # So many of each kind.
    (GARDEN, AMIGA, "Photograph two of each: potatoes, radishes, beans.",
     "for UnionOf(Take(2, of Where(crop, eq, potato))+Take(2, of Where(crop, eq, radish))"
     "+Take(2, of Where(crop, eq, bean))): [picture]"),
    (GARDEN, AMIGA, "Photograph two of each crop.", "for Quota(crop, 2): [picture]"),
    # The plant from which others are counted, and a depth in the unit of the one before.
    (GARDEN, AMIGA, "Photograph every third plant of bed 4, starting with plant 2.",
     "for EveryNth(3, 2, of Rows(4, 4)): [picture]"),
    (GLASSHOUSE, AMIGA, "Photograph every third plant of row 1, starting with H1-2.",
     "for EveryNth(3, 2, of Rows(1, 1)): [picture]"),
    (GLASSHOUSE, AMIGA, "Read the soil moisture at H1-2 at 10 cm and again at 30.",
     "moisture(depth_cm 10) @ TreeIs(H1-2); moisture(depth_cm 30)"),
    # Sides of two rows, and an edge along which is worked.
    (GARDEN, TRACTOR, "Film the east side of bed 3 and the west side of bed 4.",
     "film rows Rows(3, 3), east; film rows Rows(4, 4), west"),
    (PASTURE, TRACTOR, "Film along the north edge of the long pasture.",
     "film perimeter InZone(long pasture), north"),
    (PASTURE, HUSKY, "Read CO2 at five points in the bank, starting at the north end.",
     "for Ordered(north_to_south, of PointsIn(bank, 5)) given: [co2]"),
    # A time within which the work is done.
    (PASTURE, HUSKY, "Read CO2 in the bank within two hours.", "co2 @ PointsIn(bank) | duration_s 7200"),
    (ORCHARD, HUSKY, "Take pictures of as many trees as you can in 20 minutes.",
     "for Trees optional: [picture] | duration_s 1200"),
    (ORCHARD, HUSKY, "Photograph every yellow tree and come back in 20 minutes.",
     "for Where(leaf_color, eq, yellow): [picture] | duration_s 1200"),
]  # fmt: skip

ASKED = [
    (GARDEN, AMIGA, "Read the soil moisture between beds 4 and 5.", 3),
    (GARDEN, AMIGA, "Photograph the plants between beds 3 and 5.", 2),
    (PASTURE, AMIGA, "Photograph the ground in the bank and the cowslip patch.", 0),
    (PASTURE, AMIGA, "Photograph the ground all over the cowslip patch, one soil moisture reading every 4 m.", 0),
    (PASTURE, HUSKY, "Read CO2 in the bank in two hours.", 0),
]

REFUSED = [
    (GLASSHOUSE, AMIGA, "Photograph every third plant of row 1, starting with H2-2.", "where to begin"),
    (GARDEN, TRACTOR, "Film beds 3 to 5, starting with bed 5.", "where to begin"),
    (PASTURE, TRACTOR, "Mow the bank and the boggy corner, starting with the boggy corner.", "where to begin"),
    (PASTURE, HUSKY, "Read CO2 at five points in the bank, starting at the boggy corner.", "where to begin"),
    (PASTURE, TRACTOR, "Drive along the north edge of the long pasture and film.", "no plants"),
    (GARDEN, AMIGA, "Moisture in beds 1 to 5, three plants each, at 15 cm; in bed 5 also at 40 cm.", "how many"),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_spots_and_beginnings_are_planned(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "ways"), ASKED, ids=name)
def test_spots_that_are_left_open_are_asked_about(site: Site, robot: RobotProfile, request_: str, ways: int) -> None:
    require_question(site, robot, request_, ways)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_a_beginning_that_cannot_be_kept_is_refused(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)
