"""What a robot captures with ("the moisture probe"), and pictures in the corners of ground that is driven round."""

from __future__ import annotations

import pytest

from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import require_plan, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASS, PASTURE = vegetable_garden(), glasshouse(), pasture()
DEMO, VINES = open_site("demo"), open_site("vineyard")
AMIGA, HUSKY = load_robot("amiga"), load_robot("husky")

UNTIL = "for Where(crop, eq, melon) until r1 < 25 percent: [moisture = r1]"
THIRD = "for EveryNth(3, of Where(crop, eq, bean)): [moisture]"

INSTRUMENTS = [
    (GLASS, AMIGA, "Go along the melons with the moisture probe until one is under 25 percent, then stop.", UNTIL),
    (GLASS, AMIGA, "Go along the melons with the soil probe until one is under 25 percent, then stop.", UNTIL),
    (
        GLASS, AMIGA, "Drive along the melons with the moisture meter, and stop as soon as one is below 25 percent.",
        UNTIL,
    ),
    (GARDEN, AMIGA, "Use the moisture probe at every third bean.", THIRD),
    (GARDEN, AMIGA, "Stick the moisture sensor into the soil at every third bean.", THIRD),
    (GARDEN, AMIGA, "Put the moisture probe in at every third bean.", THIRD),
    (
        GARDEN, AMIGA, "Use the leaf sampler on the three tallest squash.",
        "for Top(height_cm, 3, of Where(crop, eq, squash)): [sample_leaf]",
    ),
    (
        PASTURE, HUSKY, "Take the gas sniffer round the edge of the pond, a reading every 10 metres.",
        "for Transect(10, edge, pond): [co2]",
    ),
    (DEMO, HUSKY, "Go down row 3 with the thermal camera.", "for Rows(3, 3): [picture]"),
    (DEMO, HUSKY, "Use the CO2 analyser at tree 4.", "co2 @ TreeIs(4)"),
    (DEMO, HUSKY, "Drive along row 4 with the camera every 10 m.", "for Spaced(10, of Rows(4, 4)): [picture]"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), INSTRUMENTS)
def test_instruments_name_what_they_capture(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


def test_a_soil_probe_may_read_either_of_two_quantities() -> None:
    require_question(DEMO, AMIGA, "Use the soil probe at tree 4.", 2)


def test_one_picture_along_a_row_does_not_say_where() -> None:
    require_refusal(DEMO, HUSKY, "Drive along row 4 with a picture.", "does not fit")


BANK = "for Corners(bank): [picture]"

CORNERS = [
    (PASTURE, HUSKY, "Go once around the bank with a thermal picture in each corner.", BANK),
    (PASTURE, HUSKY, "Drive round the bank once and take a thermal picture in each corner.", BANK),
    (PASTURE, HUSKY, "Circle the bank and photograph every corner.", BANK),
    (PASTURE, HUSKY, "One lap of the bank, with a picture at each of its four corners.", BANK),
    (PASTURE, HUSKY, "Drive around the edge of the bank, stopping at each corner for a picture.", BANK),
    (PASTURE, HUSKY, "Photograph the four corners of the bank.", BANK),
    (PASTURE, HUSKY, "Photograph the north-east corner of the bank.", "picture @ Corners(ne, bank)"),
    (
        PASTURE, HUSKY, "Go once around the boundary and take a thermal picture at every corner.",
        "for Corners(common): [picture]",
    ),
    (
        GARDEN, AMIGA, "Drive around the rose bed with a picture in each of the four corners.",
        "for Corners(rose bed): [picture]",
    ),
    (
        VINES, AMIGA, "Go once around the north block with a picture at each corner.",
        "for Corners(of InBlock(North)): [picture]",
    ),
    (
        DEMO, HUSKY, "Drive once around the orchard and take a picture at each corner.",
        "drive perimeter Trees; for Corners: [picture]",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), CORNERS)
def test_corners_of_ground_are_visited(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


def test_corners_of_a_zone_lie_inside_it() -> None:
    bank = next(zone.polygon for zone in PASTURE.zones if zone.name == "bank")
    west, south, east, north = bank.bounds
    found = list(resolve(s.Corners(zone="bank"), PASTURE, Context(here=PASTURE.start)))
    ends = [(west, north), (east, north), (east, south), (west, south)]
    assert len(found) == 4
    assert all(
        1.0 < abs(one.x - x) < 2.0 and 1.0 < abs(one.y - y) < 2.0 for one, (x, y) in zip(found, ends, strict=True)
    )
