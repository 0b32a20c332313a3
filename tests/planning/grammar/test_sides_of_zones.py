"""Sides, ends and corners of zones, points beside and beyond places, directions of rounds, and ends of rows."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, HOUSE, PASTURE, ORCHARD = vegetable_garden(), glasshouse(), pasture(), open_site("demo")
AMIGA, HUSKY, TRACTOR = load_robot("amiga"), load_robot("husky"), load_robot("tractor")

PLANNED = [
    (
        PASTURE,
        HUSKY,
        "Take one thermal picture from each of the four sides of the pond.",
        (
            "for UnionOf(Transect(1, edge, pond, north)+Transect(1, edge, pond, east)"
            "+Transect(1, edge, pond, south)+Transect(1, edge, pond, west)): [picture]"
        ),
    ),
    (
        PASTURE,
        HUSKY,
        "Photograph the pond from all four sides.",
        (
            "for UnionOf(Transect(1, edge, pond, north)+Transect(1, edge, pond, east)"
            "+Transect(1, edge, pond, south)+Transect(1, edge, pond, west)): [picture]"
        ),
    ),
    (
        PASTURE,
        HUSKY,
        "Read CO2 on the west and the east side of the pond.",
        "for UnionOf(Transect(1, edge, pond, west)+Transect(1, edge, pond, east)): [co2]",
    ),
    (
        PASTURE,
        HUSKY,
        "Read CO2 on both sides of the sheep fence.",
        "for UnionOf(Transect(1, edge, sheep fence, west)+Transect(1, edge, sheep fence, east)): [co2]",
    ),
    (PASTURE, HUSKY, "Read CO2 on the paddock side of the sheep fence.", "co2 @ Transect(1, edge, sheep fence, east)"),
    (
        PASTURE,
        HUSKY,
        "CO2 at the north end and the south end of the long pasture.",
        "for UnionOf(Transect(1, edge, long pasture, north)+Transect(1, edge, long pasture, south)): [co2]",
    ),
    (
        PASTURE,
        HUSKY,
        "CO2 at both ends of the bank.",
        "for UnionOf(Transect(1, edge, bank, west)+Transect(1, edge, bank, east)): [co2]",
    ),
    (
        PASTURE,
        HUSKY,
        "Take the air temperature at the northern edge of the bank.",
        "air @ Transect(1, edge, bank, north)",
    ),
    (
        PASTURE,
        HUSKY,
        "Drive along the south edge of the long pasture and take the air temperature every 20 metres.",
        "for Transect(20, edge, long pasture, south): [air]",
    ),
    (
        PASTURE,
        HUSKY,
        "Every 10 m along the east side of the cow paddock read CO2.",
        "for Transect(10, edge, cow paddock, east): [co2]",
    ),
    (
        PASTURE,
        HUSKY,
        "Take four thermal pictures along the north side of the pond.",
        "for Transect(4, edge, pond, north): [picture]",
    ),
    (
        PASTURE,
        HUSKY,
        "Walk along the western boundary of the cow paddock with a CO2 reading every 25 m.",
        "for Transect(25, edge, cow paddock, west): [co2]",
    ),
    (
        PASTURE,
        HUSKY,
        "Go to the south side of the pond and take a thermal picture.",
        "go Transect(1, edge, pond, south); picture",
    ),
    (PASTURE, HUSKY, "Read CO2 in the middle of the south edge of the bank.", "co2 @ Transect(1, edge, bank, south)"),
    (PASTURE, HUSKY, "Read the air temperature in the west of the cow paddock.", "air @ PointsIn(cow paddock, west)"),
    (
        PASTURE,
        HUSKY,
        "Measure CO2 next to the cowslip patch and then at the pond.",
        "co2 @ Transect(1, edge, cowslip patch, -1.5); co2 @ Transect(1, edge, pond)",
    ),
    (
        PASTURE,
        HUSKY,
        "Read CO2 near the pond, then close to the cowslip patch.",
        "co2 @ Transect(1, edge, pond); co2 @ Transect(1, edge, cowslip patch, -1.5)",
    ),
    (PASTURE, HUSKY, "Measure CO2 right beside the middle gate.", "co2 @ GateIs(middle gate)"),
    (
        PASTURE,
        AMIGA,
        "Nitrate at the cowslip patch, then 10 m west of it and 20 m west of it.",
        (
            "nitrate @ PointsIn(cowslip patch); for UnionOf(PointAt(10, west, InZone(cowslip patch))"
            "+PointAt(20, west, InZone(cowslip patch))): [nitrate]"
        ),
    ),
    (
        PASTURE,
        AMIGA,
        "Read nitrate 5, 10 and 15 m to the north of the pond.",
        (
            "for UnionOf(PointAt(5, north, InZone(pond))+PointAt(10, north, InZone(pond))"
            "+PointAt(15, north, InZone(pond))): [nitrate]"
        ),
    ),
    (
        PASTURE,
        AMIGA,
        "Soil moisture 12 metres east of the middle gate.",
        "moisture @ PointAt(12, east, GateIs(middle gate))",
    ),
    (
        PASTURE,
        AMIGA,
        "Measure moisture at the cowslip patch and again 20 metres south of it.",
        "moisture @ PointsIn(cowslip patch); moisture @ PointAt(20, south, InZone(cowslip patch))",
    ),
    (
        PASTURE,
        AMIGA,
        "Go 20 m north of the pond and read the soil moisture.",
        "go PointAt(20, north, InZone(pond)); moisture",
    ),
    (
        PASTURE,
        AMIGA,
        "Photograph the pond from the south, then from the north.",
        "picture @ Transect(1, edge, pond, south); picture @ Transect(1, edge, pond, north)",
    ),
    (
        ORCHARD,
        AMIGA,
        "Photograph the trunk of tree 4 from the east, then its canopy from the west.",
        "picture(view trunk) @ Beside(east, of TreeIs(4)); picture(view canopy) @ Beside(west, of TreeIs(4))",
    ),
    (
        ORCHARD,
        AMIGA,
        "Photograph the trunk of tree 4, then its canopy.",
        "picture(view trunk) @ TreeIs(4); picture(view canopy)",
    ),
    (
        ORCHARD,
        HUSKY,
        "Read CO2 at tree 40 and 10 m east of it.",
        "co2 @ TreeIs(40); co2 @ PointAt(10, east, TreeIs(40))",
    ),
    (
        GARDEN,
        HUSKY,
        "Measure CO2 next to the rose bed and close to the manure heap.",
        "co2 @ Transect(1, edge, rose bed, -1.5); co2 @ Transect(1, edge, manure heap, -1.5)",
    ),
    (
        HOUSE,
        HUSKY,
        "CO2 at the west end and the east end of the hot bay.",
        "for UnionOf(Transect(1, edge, hot bay, west)+Transect(1, edge, hot bay, east)): [co2]",
    ),
    (
        HOUSE,
        HUSKY,
        "Measure CO2 at the west end of the hot bay, then do the same in the mild bay.",
        "co2 @ Transect(1, edge, hot bay, west); co2 @ Transect(1, edge, mild bay, west)",
    ),
    (HOUSE, HUSKY, "CO2 next to the seedling table.", "co2 @ Transect(1, edge, seedling table, -1.5)"),
    (HOUSE, TRACTOR, "Spray the aisle between rows 3 and 4 on both sides.", "spray aisles Rows(3, 4)"),
    (
        PASTURE,
        TRACTOR,
        "Drive once around the cow paddock with the side camera looking outwards.",
        "film perimeter InZone(cow paddock)",
    ),
    (
        PASTURE,
        TRACTOR,
        "Film round the cow paddock with the camera pointing inwards.",
        "film perimeter InZone(cow paddock), heading clockwise",
    ),
    (PASTURE, TRACTOR, "Film clockwise round the pond.", "film perimeter InZone(pond), heading clockwise"),
    (
        PASTURE,
        TRACTOR,
        "Film anticlockwise round the pond, the camera facing outwards.",
        "film perimeter InZone(pond), heading counterclockwise",
    ),
    (
        PASTURE,
        TRACTOR,
        "Drive anticlockwise around the cow paddock.",
        "drive perimeter InZone(cow paddock), heading counterclockwise",
    ),
    (
        PASTURE,
        TRACTOR,
        "Drive three laps clockwise around the bank.",
        "drive perimeter InZone(bank), heading clockwise, 3 laps",
    ),
    (
        PASTURE,
        TRACTOR,
        "Drive twice round the pond, keeping it on your left.",
        "drive perimeter InZone(pond), heading counterclockwise, 2 laps",
    ),
    (
        PASTURE,
        TRACTOR,
        "Mow once around the pond in a clockwise direction.",
        "mow perimeter InZone(pond), heading clockwise",
    ),
    (PASTURE, TRACTOR, "Film the sheep fence, keeping it on your right side.", "film perimeter InZone(sheep fence)"),
    (
        PASTURE,
        HUSKY,
        "Take a thermal picture every 5 metres around the pond, clockwise.",
        "for Transect(5, edge, pond) given: [picture]",
    ),
    (PASTURE, TRACTOR, "Mow a strip on both sides of the sheep fence.", "mow perimeter InZone(sheep fence)"),
    (
        PASTURE,
        TRACTOR,
        "Mow a strip 2.4 m wide on the west side of the sheep fence.",
        "mow perimeter InZone(sheep fence), west, 2 laps",
    ),
    (
        GARDEN,
        TRACTOR,
        "Film the kale bed with it on your right, driving up from south to north.",
        "film rows Rows(6, 6), heading north",
    ),
    (GARDEN, TRACTOR, "Film row 4 heading north with the row on your right.", "film rows Rows(4, 4), heading north"),
    (
        GARDEN,
        TRACTOR,
        "Film rows 3 and 4 and wait half a minute at the end of each row.",
        "film rows Rows(3, 3); wait 30; film rows Rows(4, 4); wait 30",
    ),
    (GARDEN, TRACTOR, "Film row 3 and wait 20 seconds at its end.", "film rows Rows(3, 3); wait 20"),
    (
        GARDEN,
        TRACTOR,
        "Film the radishes and the beans with a rest of a minute after each row.",
        "film rows Rows(3, 3); wait 60; film rows Rows(4, 4); wait 60",
    ),
    (
        ORCHARD,
        TRACTOR,
        "Spray rows 3 to 5, pausing for a minute at the end of every row.",
        "spray rows Rows(3, 3); wait 60; spray rows Rows(4, 4); wait 60; spray rows Rows(5, 5); wait 60",
    ),
    (
        GARDEN,
        HUSKY,
        "Thermal picture of every squash with frost damage and of the plant on each side of it.",
        (
            "for UnionOf(Where(frost_damage, eq, True, of Where(crop, eq, squash))+TreeIs(V58)+TreeIs(V56)"
            "+TreeIs(V54)+TreeIs(V52)): [picture]"
        ),
    ),
    (
        ORCHARD,
        HUSKY,
        "Photograph each yellow tree in row 3 and a green tree next to it.",
        "for UnionOf(Where(leaf_color, eq, yellow, of Rows(3, 3))+TreeIs(45)+TreeIs(48)+TreeIs(50)): [picture]",
    ),
    (GARDEN, AMIGA, "Read the soil moisture just inside the river gate.", "moisture @ GateIs(river gate)"),
]

ASKED = [
    (PASTURE, TRACTOR, "Mow a strip 1.2 m wide on one side of the sheep fence.", 2),
    (PASTURE, TRACTOR, "Mow one side of the sheep fence.", 2),
    (GARDEN, AMIGA, "Read the soil moisture just inside the gate at 30 cm depth.", 2),
]

REFUSED = [
    (PASTURE, TRACTOR, "Film the pond anticlockwise.", "that way round it faces away from what it is driven around"),
    (PASTURE, TRACTOR, "Film the pond with the water on your left.", "the implement works to the right"),
    (PASTURE, TRACTOR, "Film the pond, keeping it on your left.", "the implement works to the right"),
    (
        PASTURE,
        HUSKY,
        "Take a thermal picture every 5 metres around the pond, anticlockwise.",
        "points along an edge are visited clockwise, and only drives around an area the other way",
    ),
    (GARDEN, TRACTOR, "Film the kale, keeping it on your left.", "the implement works to the right"),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_sides_and_places_beside_are_planned(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "ways"), ASKED, ids=name)
def test_sides_that_are_not_named_are_asked_about(site: Site, robot: RobotProfile, request_: str, ways: int) -> None:
    require_question(site, robot, request_, ways)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_what_an_implement_cannot_face_is_refused(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)
