"""Aisles by the beds between which they lie, their middles, and the side from which plants are filmed."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import require_plan, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASS, PASTURE = vegetable_garden(), glasshouse(), pasture()
DEMO, VINES = open_site("demo"), open_site("vineyard")
AMIGA, HUSKY, TRACTOR = load_robot("amiga"), load_robot("husky"), load_robot("tractor")

KALE = "film rows Where(crop, eq, kale)"
TWO = "mow aisles Rows(2, 4)"

WORK = [
    (GARDEN, "Film the kale from the west side.", f"{KALE}, west"),
    (GARDEN, "Film the kale on its east side.", f"{KALE}, east"),
    (GARDEN, "Film the kale from the west.", f"{KALE}, west"),
    (GARDEN, "Film along the west side of the kale.", f"{KALE}, west"),
    (GARDEN, "Drive along the east side of the kale and film it.", f"{KALE}, east"),
    (GARDEN, "Film the kale, driving along its west side.", f"{KALE}, west"),
    (GARDEN, "Film the kale from the south side.", f"{KALE}, heading north"),
    (GARDEN, "Spray bed 4 from the aisle to the west of it.", "spray rows Rows(4, 4), west"),
    (GLASS, "Film the melons from the north side.", "film rows Where(crop, eq, melon), north"),
    (GLASS, "Spray the melons from the south.", "spray rows Where(crop, eq, melon), south"),
    (DEMO, "spray row 4 from the west", "spray rows Rows(4, 4), west"),
    (VINES, "Film rows 3 to 5 of the north block from the east side.", "film rows Rows(3, 5, of InBlock(North)), east"),
    (GARDEN, "Mow the paths between beds 2 and 4.", TWO),
    (GARDEN, "Mow the two walkways between beds 2 and 4.", TWO),
    (GARDEN, "Mow the grass between bed 2 and bed 4.", TWO),
    (GARDEN, "Mow the grass strips between beds 2, 3 and 4.", "mow aisles UnionOf(Rows(2, 2)+Rows(3, 3)+Rows(4, 4))"),
    (GARDEN, "Mow the paths between the potatoes and the beans.", TWO),
    (GARDEN, "Mow all the paths between the beds.", "mow aisles Trees"),
    (GARDEN, "Mow between the beds.", "mow aisles Trees"),
    (GARDEN, "Mow every second path between beds 1 and 5.", "mow aisles Rows(1, 5), every 2"),
    (GARDEN, "Mow the paths on both sides of bed 3.", TWO),
    (GARDEN, "Mow the path west of bed 3.", "mow aisles Rows(2, 3)"),
    (GARDEN, "Mow the track on the east side of bed 3.", "mow aisles Rows(3, 4)"),
    (GARDEN, "Mow the path next to the kale.", "mow aisles Rows(5, 6)"),
    (GARDEN, "Mow the first two aisles.", "mow aisles Rows(1, 3)"),
    (GARDEN, "Mow the last aisle.", "mow aisles Rows(5, 6)"),
    (GARDEN, "Drive along the path between beds 3 and 4.", "drive aisles Rows(3, 4)"),
    (GLASS, "Mow the walkway of the hot bay.", "mow aisles InZone(hot bay)"),
    (DEMO, "mow the grass strips between rows 3 and 6", "mow aisles Rows(3, 6)"),
    (DEMO, "mow the second aisle from the west", "mow aisles Rows(2, 3)"),
    (VINES, "Mow the grass between rows 3 and 6 of the north block.", "mow aisles Rows(3, 6, of InBlock(North))"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "request_", "plan"), WORK)
def test_aisles_and_sides_of_rows_are_worked(site: Site, request_: str, plan: str) -> None:
    require_plan(site, TRACTOR, request_, plan)


CAPTURED = [
    (
        GLASS, HUSKY, "Read CO2 in the middle of the aisle between rows 1 and 2.",
        "co2 @ Beside(north, of Middle(of Rows(1, 1)))",
    ),
    (
        GLASS, HUSKY, "Read CO2 halfway along the aisle of the mild bay.",
        "co2 @ Beside(north, of Middle(of InZone(mild bay, of Rows(3, 3))))",
    ),
    (
        DEMO, HUSKY, "read CO2 in the middle of the aisles between rows 3 and 5",
        "for UnionOf(Beside(east, of Middle(of Rows(3, 3)))+Beside(east, of Middle(of Rows(4, 4)))): [co2]",
    ),
    (
        GARDEN, AMIGA, "Take pictures of the kale from the west side.",
        "for Beside(west, of Where(crop, eq, kale)): [picture]",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), CAPTURED)
def test_captures_are_made_in_aisles(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


def test_either_aisle_beside_a_bed_may_be_meant() -> None:
    require_question(GARDEN, TRACTOR, "Mow the path next to bed 3.", 2)


def test_ground_without_rows_has_no_aisles() -> None:
    require_refusal(PASTURE, TRACTOR, "Mow the aisles.", "no plants")
    require_refusal(GARDEN, TRACTOR, "Mow the path.", "no place of this site")
    require_refusal(GLASS, HUSKY, "Read CO2 in every aisle.", "an aisle is not a place")
