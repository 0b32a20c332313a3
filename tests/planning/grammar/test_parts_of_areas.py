"""Parts of an area that is named before or behind them, or not at all: its middle, corners, halves, edges and ends."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE = vegetable_garden(), glasshouse(), pasture()
ORCHARD, VINEYARD = open_site("demo"), open_site("vineyard")
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")

PLANNED = [
    # The middle and the corners are those of the area of the places before them.
    (GARDEN, AMIGA, "Read the soil moisture at the corners of the rose bed and once in the middle.",
     "for Corners(rose bed): [moisture]; moisture @ PointsIn(rose bed)"),
    (GARDEN, AMIGA, "Read the soil moisture in the middle of the rose bed, then at each corner.",
     "moisture @ PointsIn(rose bed); for Corners(rose bed): [moisture]"),
    (GARDEN, AMIGA, "Read the soil moisture in the middle of the rose bed, then at the four corners of the allotment.",
     "moisture @ PointsIn(rose bed); for Corners: [moisture]"),
    (GARDEN, AMIGA, "In the rose bed, read the soil moisture at the corners and in the middle.",
     "for Corners(rose bed): [moisture]; moisture @ PointsIn(rose bed)"),
    (GARDEN, AMIGA, "Take a picture of the north end of bed 4, and one in the middle.",
     "picture @ InRow(1, 1, north, of Rows(4, 4)); picture @ Middle(of Rows(4, 4))"),
    (GLASSHOUSE, HUSKY, "CO2 at the corners of the hot bay and in the middle.",
     "for Corners(of InZone(hot bay)): [co2]; co2 @ PointsIn(hot bay)"),
    (VINEYARD, HUSKY, "Photograph the corners of the south block and then the middle vine.",
     "for Corners(of InBlock(South)): [picture]; picture @ Middle(of InBlock(South))"),
    (VINEYARD, HUSKY, "Photograph the first vine of row 3 of the north block and the middle one.",
     "for UnionOf(InRow(1, 1, of Rows(3, 3, of InBlock(North)))+Middle(of Rows(3, 3, of InBlock(North)))): [picture]"),
    (ORCHARD, HUSKY, "Photograph the north-west corner tree, then the middle tree.",
     "picture @ Corners(nw); picture @ Middle"),
    (ORCHARD, HUSKY, "Photograph the four corners and the middle tree.", "for UnionOf(Corners+Middle): [picture]"),
    # So are an end and the other half.
    (GARDEN, AMIGA, "Read the soil moisture at the north end of the rose bed and at the south end.",
     "moisture @ Transect(1, edge, rose bed, north); moisture @ Transect(1, edge, rose bed, south)"),
    (PASTURE, HUSKY, "CO2 in the middle of the bank and at the west end.",
     "co2 @ PointsIn(bank); co2 @ Transect(1, edge, bank, west)"),
    (GARDEN, AMIGA, "Five soil moisture readings in the north half of the rose bed and five in the south half.",
     "for PointsIn(rose bed, 5, north): [moisture]; for PointsIn(rose bed, 5, south): [moisture]"),
    (PASTURE, HUSKY, "Five CO2 readings in the north half of the bank. Then five in the south half.",
     "for PointsIn(bank, 5, north): [co2]; for PointsIn(bank, 5, south): [co2]"),
    (PASTURE, HUSKY, "CO2 on the north side of the pond and on the south side.",
     "for UnionOf(Transect(1, edge, pond, north)+Transect(1, edge, pond, south)): [co2]"),
    (PASTURE, TRACTOR, "Mow the north half of the bank, then the south half.",
     "mow area Half(north, of InZone(bank)); mow area Half(south, of InZone(bank))"),
    (PASTURE, TRACTOR, "Mow the north half of the bank, then the south half of the cow paddock.",
     "mow area Half(north, of InZone(bank)); mow area Half(south, of InZone(cow paddock))"),
    (PASTURE, TRACTOR, "Film the north side of the pond, then the east side.",
     "film perimeter InZone(pond), north; film perimeter InZone(pond), east"),
    (ORCHARD, HUSKY, "Take CO2 at tree 4 and at the north end of its row.",
     "co2 @ TreeIs(4); co2 @ InRow(1, 1, north, of RowOf)"),
    # Several parts are named before the area.
    (GARDEN, AMIGA, "Read the soil moisture at the four corners and in the middle of the rose bed.",
     "for UnionOf(Corners(rose bed)+PointsIn(rose bed)): [moisture]"),
    (PASTURE, HUSKY, "CO2 at the four corners and the middle of the bank.",
     "for UnionOf(Corners(bank)+PointsIn(bank)): [co2]"),
    # A heading says in which area the parts are.
    (PASTURE, AMIGA, "Soil moisture in the bank, one in each corner and one in the middle.",
     "for Corners(bank): [moisture]; moisture @ PointsIn(bank)"),
    (PASTURE, AMIGA, "Soil moisture in the bank and one in each corner of the cow paddock.",
     "moisture @ PointsIn(bank); for Corners(cow paddock): [moisture]"),
    (PASTURE, AMIGA, "Soil moisture in the middle of the bank, one in each corner.",
     "moisture @ PointsIn(bank); for Corners(bank): [moisture]"),
    (GARDEN, AMIGA, "Soil moisture in bed 4, one at each end.",
     "for UnionOf(InRow(1, 1, of Rows(4, 4))+InRow(-1, -1, of Rows(4, 4))): [moisture]"),
    (GLASSHOUSE, HUSKY, "Thermal pictures in the hot bay, first plant of each row.",
     "for InRow(1, 1, of InZone(hot bay, of Rows)): [picture]"),
    (GLASSHOUSE, HUSKY, "Thermal pictures of the mild bay, both ends of each row.",
     "for UnionOf(InRow(1, 1, of InZone(mild bay, of Rows))+InRow(-1, -1, of InZone(mild bay, of Rows))): [picture]"),
    # A half, a quarter or an edge of a zone is not that of the site in it.
    (GLASSHOUSE, AMIGA, "Photograph the plants in the south half of the hot bay.",
     "for Half(south, of InZone(hot bay)): [picture]"),
    (GLASSHOUSE, AMIGA, "Photograph the plants along the south edge of the hot bay.",
     "for Edge(south, of InZone(hot bay)): [picture]"),
    (GLASSHOUSE, AMIGA, "Photograph the southern plants of the hot bay.",
     "for Half(south, of InZone(hot bay)): [picture]"),
    (ORCHARD, HUSKY, "Photograph every tree in the northern half of the wet corner.",
     "for Half(north, of InZone(wet corner)): [picture]"),
    # The rows of a zone.
    (GLASSHOUSE, HUSKY, "One thermal picture halfway down each row of the hot bay.",
     "for UnionOf(Middle(of Rows(2, 2, of InBlock(hot bay, of InZone(hot bay))))"
     "+Middle(of Rows(1, 1, of InBlock(hot bay, of InZone(hot bay))))): [picture]"),
    (GLASSHOUSE, HUSKY, "Photograph the plant at either end of each row in the mild bay.",
     "for UnionOf(InRow(1, 1, of Rows(of InZone(mild bay)))+InRow(-1, -1, of Rows(of InZone(mild bay)))): [picture]"),
    (GARDEN, AMIGA, "Photograph the plant at either end of every bed.",
     "for UnionOf(InRow(1, 1, of Rows)+InRow(-1, -1, of Rows)): [picture]"),
]  # fmt: skip

ASKED = [
    (GARDEN, AMIGA, "Take a picture at both ends of beds 1 to 3, and one in the middle.", 2),
    (GARDEN, AMIGA, "Take a picture in the middle of the rose bed. Then read the soil moisture at the corners.", 2),
    (GLASSHOUSE, HUSKY, "CO2 at the west end of rows 1 and 2, and in the middle.", 2),
    (PASTURE, TRACTOR, "Mow the bank, then go to the east side.", 2),
    (GARDEN, AMIGA, "Photograph one plant at the north end of bed 3 and two at the south end.", 2),
]

REFUSED = [
    (GLASSHOUSE, AMIGA, "Photograph the melons in the north half of the mild bay.", "nothing on this site matches"),
    (PASTURE, AMIGA, "Soil moisture in the bank, one in each corner of the cow paddock.", "no plants"),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_a_part_is_that_of_the_area_which_is_meant(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "ways"), ASKED, ids=name)
def test_a_part_that_may_be_of_the_site_is_asked_about(
    site: Site, robot: RobotProfile, request_: str, ways: int
) -> None:
    require_question(site, robot, request_, ways)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_a_part_that_an_area_lacks_is_refused(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)
