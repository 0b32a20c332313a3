"""Rounds with an implement, sides from which rows are always worked, and aisles from one bed across to another."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import box, glasshouse, mark, pasture, vegetable_garden
from support.sites.points import read


def _ponds() -> Site:
    return read(
        box(0, 0, 120, 80, kind="boundary", name="common"),
        box(10, 10, 25, 20, kind="pond", name="duck pond"),
        box(50, 10, 80, 40, kind="zone", name="slope"),
        mark(100, 40, kind="gate", name="lane gate", width_m=4),
        mark(5, 40, kind="gate", name="wood gate", width_m=4),
        mark(100, 20, kind="start", name="shed"),
    )


POND = _ponds()
GARDEN, GLASSHOUSE, PASTURE = vegetable_garden(), glasshouse(), pasture()
AMIGA, HUSKY, TRACTOR = load_robot("amiga"), load_robot("husky"), load_robot("tractor")

ROUNDS = [
    ("One round with the mower just inside the edge of the cow paddock.", "mow perimeter InZone(cow paddock)"),
    (
        "Only the edge of the cow paddock, two rounds with the mower, leave the inside.",
        "mow perimeter InZone(cow paddock), 2 laps",
    ),
    ("Mow one lap just inside the cow paddock.", "mow perimeter InZone(cow paddock)"),
    ("Mow just inside the edge of the bank.", "mow perimeter InZone(bank)"),
    ("A lap of the bank with the sprayer.", "spray perimeter InZone(bank)"),
    ("Take the mower twice round the cow paddock.", "mow perimeter InZone(cow paddock), 2 laps"),
    ("Three laps with the mower around the pond, please.", "mow perimeter InZone(pond), 3 laps"),
    ("With the mower, two rounds inside the edge of the bank.", "mow perimeter InZone(bank), 2 laps"),
    ("I want one lap with the sprayer round the bank at 300 l/ha.", "spray perimeter InZone(bank), rate_l_ha 300"),
]

ROWS = [
    ("Film beds 2 through 5, always from their west side.", "film rows Rows(2, 5), west"),
    ("Film beds 2 to 5, always from the west.", "film rows Rows(2, 5), west"),
    ("Film beds 2 to 5, each one from its east side.", "film rows Rows(2, 5), east"),
    ("From the west side, film beds 2 to 5.", "film rows Rows(2, 5), west"),
    ("Film beds 2 to 5. Always from the west side.", "film rows Rows(2, 5), west"),
    ("Film the squash, every time from the east.", "film rows Where(crop, eq, squash), east"),
    ("Mow the aisles from bed 2 across to bed 5.", "mow aisles Rows(2, 5)"),
    ("The grass is up again, mow the aisles from bed 2 across to bed 5.", "mow aisles Rows(2, 5)"),
    ("Film bed 3, driving along the east side of it.", "film rows Rows(3, 3), east"),
    ("Mow every aisle from bed 2 over to bed 5.", "mow aisles Rows(2, 5)"),
]

AISLES = [
    (
        "Film the melons from the aisle between rows 3 and 4, no faster than 0.5 m/s.",
        "film rows Where(crop, eq, melon), north | speed 0.5",
    ),
    ("Film row 4 from the path between rows 3 and 4.", "film rows Rows(4, 4), south"),
    ("Film row 4, driving along the aisle between rows 3 and 4.", "film rows Rows(4, 4), south"),
    ("From the aisle between rows 3 and 4 spray the melons.", "spray rows Where(crop, eq, melon), north"),
    ("Film row 1 from between rows 1 and 2.", "film rows Rows(1, 1), north"),
]

POND_FILMED = "film perimeter InZone(duck pond)"

BANKS = [
    (TRACTOR, "Go once round the pond and film the bank as you go.", POND_FILMED),
    (TRACTOR, "Go once round the duck pond, filming the edge.", POND_FILMED),
    (TRACTOR, "Drive twice around the pond, filming the bank on the way.", f"{POND_FILMED}, 2 laps"),
    (TRACTOR, "Go round the pond and film as you go.", POND_FILMED),
    (TRACTOR, "Film the bank of the pond.", POND_FILMED),
    (TRACTOR, "Go round the edge of the slope and mow as you drive.", "mow perimeter InZone(slope)"),
    (
        AMIGA,
        "Go round the pond two metres off the water and take a ground photo every 10 m.",
        "for Transect(10, edge, duck pond, 2): [picture(view ground)]",
    ),
    (AMIGA, "Six photos round the pond, 2 m from the bank.", "for Transect(6, edge, duck pond, 2): [picture]"),
    (AMIGA, "Moisture every 8 m round the pond, 3 m off the shore.", "for Transect(8, edge, duck pond, 3): [moisture]"),
]


DRIVES = "[go GateIs(lane gate); go GateIs(wood gate)]"

SHUTTLES = [
    (
        "Keep going back and forth between the lane gate and the wood gate till the battery is down to 40 percent, "
        "then home.",
        f"100 times until battery <= 40: {DRIVES}",
    ),
    (
        "Patrol between the lane gate and the wood gate until the battery is below 30 %.",
        f"100 times until battery <= 30: {DRIVES}",
    ),
    (
        "Until the battery is at 40 percent, patrol between the lane gate and the wood gate.",
        f"100 times until battery <= 40: {DRIVES}",
    ),
    ("Go back and forth between the lane gate and the wood gate five times.", f"5 times: {DRIVES}"),
    (
        "Read CO2 on the slope, then go to and fro between the lane gate and the wood gate twice.",
        f"co2 @ PointsIn(slope); 2 times: {DRIVES}",
    ),
    (
        "Go back and forth between the slope and the wood gate 3 times, then read CO2 at the lane gate.",
        "3 times: [go PointsIn(slope); go GateIs(wood gate)]; co2 @ GateIs(lane gate)",
    ),
    (
        "Go back and forth between the lane gate and the wood gate with a CO2 reading at each until the battery is at "
        "40 %.",
        "100 times until battery <= 40: [go GateIs(lane gate); co2; go GateIs(wood gate); co2]",
    ),
]


@pytest.mark.parametrize(("request_", "plan"), SHUTTLES, ids=name)
def test_drives_between_two_places(request_: str, plan: str) -> None:
    require_plan(POND, HUSKY, request_, plan)


def test_drives_between_two_places_ask_how_often() -> None:
    require_question(POND, HUSKY, "Go back and forth between the lane gate and the wood gate.", 0)


@pytest.mark.parametrize(("robot", "request_", "plan"), BANKS, ids=name)
def test_banks_are_worked_on_the_way_round(robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(POND, robot, request_, plan)


@pytest.mark.parametrize(("request_", "plan"), ROUNDS, ids=name)
def test_rounds_with_an_implement(request_: str, plan: str) -> None:
    require_plan(PASTURE, TRACTOR, request_, plan)


@pytest.mark.parametrize(("request_", "plan"), ROWS, ids=name)
def test_rows_from_a_side_and_aisles_across(request_: str, plan: str) -> None:
    require_plan(GARDEN, TRACTOR, request_, plan)


@pytest.mark.parametrize(("request_", "plan"), AISLES, ids=name)
def test_rows_from_an_aisle(request_: str, plan: str) -> None:
    require_plan(GLASSHOUSE, TRACTOR, request_, plan)


@pytest.mark.parametrize(
    ("site", "request_", "why"),
    [
        (PASTURE, "One round with the mower just outside the edge of the cow paddock.", ""),
        (PASTURE, "Mow one lap inside the pond.", ""),
        (POND, "Mow the slope, and if it rains wait beside the pond until it stops.", "but not wait elsewhere"),
        (POND, "Mow the slope. If it rains, go to the lane gate and wait there.", "but not wait elsewhere"),
        (POND, "Go round the slope and mow the bank as you go.", "bank"),
        (GARDEN, "Film beds 2 to 5, always from the north.", ""),
        (GARDEN, "The grass is to be mown, then spray bed 3.", "grass"),
        (GLASSHOUSE, "Film row 1 from the aisle between rows 3 and 4.", "aisle"),
    ],
    ids=name,
)
def test_other_sides_are_not_planned(site: Site, request_: str, why: str) -> None:
    require_refusal(site, TRACTOR, request_, why)
