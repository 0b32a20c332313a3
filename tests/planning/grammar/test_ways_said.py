"""Where the robot must not drive, as people say it, and distances from places."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.request_check import mismatches
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.english.outlines import outline
from planning.english.vineyards import vineyard

HUSKY = load_robot("husky")
PLANNED = {
    "demo": [
        ("Take pictures of rows 2 to 4. Avoid row 6.", "for Rows(2, 4): [picture] | avoid Rows(6, 6)"),
        ("Take pictures of rows 2 to 4, avoiding row 6.", "for Rows(2, 4): [picture] | avoid Rows(6, 6)"),
        ("Take pictures of rows 2 to 4, but do not go through row 6.", "for Rows(2, 4): [picture] | avoid Rows(6, 6)"),
        ("Take a picture of tree 12, not through row 5.", "picture @ TreeIs(12) | avoid Rows(5, 5)"),
        ("Take a picture of tree 12 without driving through row 5.", "picture @ TreeIs(12) | avoid Rows(5, 5)"),
        ("Photograph every tree of row 9 without using row 7.", "for Rows(9, 9): [picture] | avoid Rows(7, 7)"),
        ("Please avoid rows 3 to 5, then photograph every tree of row 9.", "for Rows(9, 9): [picture] | avoid Rows(3, 5)"),
        ("Photograph every yellow tree. Don't drive through rows 3 to 5.", "for Where(leaf_color, eq, yellow): [picture] | avoid Rows(3, 5)"),
        ("Measure CO2 at tree 40 and do not drive through rows 3 and 7.", "co2 @ TreeIs(40) | avoid Rows(3, 3) | avoid Rows(7, 7)"),
        ("Measure CO2 at tree 40; stay off row 7.", "co2 @ TreeIs(40) | avoid Rows(7, 7)"),
        ("Measure CO2 at tree 40, but row 7 is closed.", "co2 @ TreeIs(40) | avoid Rows(7, 7)"),
        ("Photograph row 4. Row 6 is off limits.", "for Rows(4, 4): [picture] | avoid Rows(6, 6)"),
        ("Measure CO2 at tree 40. You must not drive through the wet corner.", "co2 @ TreeIs(40) | avoid InZone(wet corner)"),
        ("Measure CO2 at tree 40. The robot must not enter the wet corner.", "co2 @ TreeIs(40) | avoid InZone(wet corner)"),
        ("Measure CO2 at tree 40 without crossing the wet corner.", "co2 @ TreeIs(40) | avoid InZone(wet corner)"),
        ("Never drive over the wet corner. Photograph tree 40.", "picture @ TreeIs(40) | avoid InZone(wet corner)"),
        ("Go to tree 40, not through the wet corner, and take a picture.", "go TreeIs(40); picture | avoid InZone(wet corner)"),
        ("Measure CO2 at tree 40 and steer clear of the wet corner and the pond.", "co2 @ TreeIs(40) | avoid InZone(wet corner) | avoid InZone(pond)"),
        ("Keep out of the wet corner, please. Photograph tree 40, then measure CO2 at tree 60.", "picture @ TreeIs(40); co2 @ TreeIs(60) | avoid InZone(wet corner)"),
        ("If the CO2 at tree 40 is low, take a picture. Stay away from the pond.", "co2 @ TreeIs(40) = r1; if r1 low: [picture] | avoid InZone(pond)"),
        ("Photograph row 4 while avoiding the pond.", "for Rows(4, 4): [picture] | avoid InZone(pond)"),
        ("Photograph row 4, but drive around the pond.", "for Rows(4, 4): [picture] | avoid InZone(pond)"),
        ("Photograph row 4, but avoid the wet corner and drive around the pond.", "for Rows(4, 4): [picture] | avoid InZone(wet corner) | avoid InZone(pond)"),
        # Trees of what is avoided are left out where the request does not name them.
        ("Take pictures of every tree but stay out of the wet corner.", "for Excluding(InZone(wet corner)): [picture] | avoid InZone(wet corner)"),
        ("Stay out of the wet corner. Take pictures of every tree.", "for Excluding(InZone(wet corner)): [picture] | avoid InZone(wet corner)"),
        ("Photograph all trees, avoiding row 5.", "for Excluding(Rows(5, 5)): [picture] | avoid Rows(5, 5)"),
        ("Photograph 10 random trees and avoid the wet corner.", "for RandomSample(10, of Excluding(InZone(wet corner))): [picture] | avoid InZone(wet corner)"),
        ("Photograph as many trees as you can within 20 minutes, but stay out of the wet corner.", "for Excluding(InZone(wet corner)) optional: [picture] | duration_s 1200 | avoid InZone(wet corner)"),
        ("Photograph trees 40, 12 and 60 but stay out of the wet corner.", "for UnionOf(TreeIs(40)+TreeIs(12)+TreeIs(60)): [picture] | avoid InZone(wet corner)"),
        ("Photograph row 4 and avoid the yellow trees.", "for Excluding(Where(leaf_color, eq, yellow), of Rows(4, 4)): [picture]"),
        ("Photograph row 4 and avoid tree 60.", "for Excluding(TreeIs(60), of Rows(4, 4)): [picture]"),
        ("Photograph all trees. Don't take any pictures in row 5.", "for Excluding(Rows(5, 5)): [picture]"),
        # Distances.
        ("Take a picture of tree 12 and keep at least 5 m away from the pond.", "picture @ TreeIs(12) | avoid InZone(pond) 5 m"),
        ("Keep 5 m from the pond: photograph row 4.", "for Rows(4, 4): [picture] | avoid InZone(pond) 5 m"),
        ("Keep 5 m from the pond and take pictures of row 4.", "for Rows(4, 4): [picture] | avoid InZone(pond) 5 m"),
        ("Measure CO2 at tree 40, staying 8 m away from the pond.", "co2 @ TreeIs(40) | avoid InZone(pond) 8 m"),
        ("Measure CO2 at tree 40, keeping a distance of 8 m from the pond.", "co2 @ TreeIs(40) | avoid InZone(pond) 8 m"),
        ("Measure CO2 at tree 40. Keep a distance of at least 8 metres from the pond.", "co2 @ TreeIs(40) | avoid InZone(pond) 8 m"),
        ("Measure CO2 at tree 40. Don't get closer than 8 m to the pond.", "co2 @ TreeIs(40) | avoid InZone(pond) 8 m"),
        ("Measure CO2 at tree 40. Do not drive within 8 m of the pond.", "co2 @ TreeIs(40) | avoid InZone(pond) 8 m"),
        ("Never come within 10 m of the pond. Photograph row 4.", "for Rows(4, 4): [picture] | avoid InZone(pond) 10 m"),
        ("Photograph row 4 but never closer than 6 m to the pond.", "for Rows(4, 4): [picture] | avoid InZone(pond) 6 m"),
        ("Photograph row 9, keep 20 feet from the pond, every tree.", "for Rows(9, 9): [picture] | avoid InZone(pond) 6.096 m"),
        ("Photograph the yellow trees, but keep 3 m away from tree 40.", "for Where(leaf_color, eq, yellow): [picture] | avoid TreeIs(40) 3 m"),
        ("Measure CO2 at tree 40 and keep 4 m from the pond and the charger.", "co2 @ TreeIs(40) | avoid InZone(pond) 4 m | avoid Marker(charger) 4 m"),
        # Distances that choose trees.
        ("Photograph all trees more than 100 m from the charger.", "for Within(100, Marker(charger), True): [picture]"),
        ("Photograph all trees more than 20 m from row 3.", "for Within(20, Rows(3, 3), True): [picture]"),
        ("Photograph all trees within 8 m of row 3.", "for Within(8, Rows(3, 3)): [picture]"),
        ("Measure CO2 at 5 trees between 10 and 20 m from the pond.", "for Take(5, of InZone(pond, True, 10, of InZone(pond, 20))): [co2]"),
        ("Measure CO2 at the tree farthest from the pond.", "co2 @ Farthest(InZone(pond))"),
        # Sides of rows, which run north to south here.
        ("Take pictures of row 4 on the left side.", "for Beside(east, of Rows(4, 4)): [picture]"),
        ("Take pictures on the left side of row 4.", "for Beside(east, of Rows(4, 4)): [picture]"),
        ("Take pictures of the left side of row 4 and the right side of row 6.", "for UnionOf(Beside(east, of Rows(4, 4))+Beside(west, of Rows(6, 6))): [picture]"),
        ("Measure CO2 on the right-hand side of rows 3 to 5.", "for Beside(west, of Rows(3, 5)): [co2]"),
        ("Photograph every tree of row 4, along its left side.", "for Beside(east, of Rows(4, 4)): [picture]"),
        ("Take a picture of the left side of tree 40.", "picture @ Beside(east, of TreeIs(40))"),
        ("Take pictures of the east side of row 4.", "for Beside(east, of Rows(4, 4)): [picture]"),
        ("Take pictures on the west side of row 4.", "for Beside(west, of Rows(4, 4)): [picture]"),
        ("Drive on the west side of row 4.", "for Beside(west, of Rows(4, 4)): [go Here]"),
        ("Take pictures of the north side of row 4.", "picture @ InRow(1, 1, north, of Rows(4, 4))"),
    ],
    "vineyard": [
        ("Take pictures of the Merlot but avoid the pond and drive around the north block.", "for Excluding(InBlock(North), of Where(variety, eq, Merlot)): [picture] | avoid InZone(pond) | avoid InBlock(North)"),
        ("Take pictures of row 4 of the north block, but stay out of the south block.", "for Rows(4, 4, of InBlock(North)): [picture] | avoid InBlock(South)"),
        ("Take pictures of row 4 of the north block. Do not drive through row 10.", "for Rows(4, 4, of InBlock(North)): [picture] | avoid Rows(10, 10, of InBlock(North))"),
        ("Take pictures of 5 vines. Do not drive through row 10 of the north block.", "for Take(5, of Excluding(Rows(10, 10, of InBlock(North)))): [picture] | avoid Rows(10, 10, of InBlock(North))"),
        ("Take pictures of row 12 of the north block, not through row 10, not through row 14.", "for Rows(12, 12, of InBlock(North)): [picture] | avoid Rows(10, 10, of InBlock(North)) | avoid Rows(14, 14, of InBlock(North))"),
        ("Use the gate only and take a picture of vine N250.", "picture @ TreeIs(N250) | only gate"),
        ("Take a picture of vine N250. Drive only through the gate.", "picture @ TreeIs(N250) | only gate"),
        ("Take a picture of vine N250, only through the gate.", "picture @ TreeIs(N250) | only gate"),
        ("Take pictures of the vines more than 30 m from the gate.", "for Within(30, GateIs(gate), True): [picture]"),
    ],
}  # fmt: skip
ASKED = [
    ("vineyard", "Take pictures of 5 vines. Do not drive through row 10."),
]
REFUSED = [
    ("demo", "Don't drive through row 5."),
    ("demo", "Avoid the pond."),
    ("demo", "Don't take any pictures of row 5."),
    ("demo", "Photograph row 4, but avoid the charger."),
    ("demo", "Photograph tree 40 and do not drive near the pond."),
    ("demo", "Photograph tree 40 and don't drive past the pond."),
    ("demo", "Photograph tree 40 and stay out of row 77."),
    ("demo", "Photograph tree 40 and keep 5 ppm from the pond."),
    ("demo", "Photograph tree 40 and keep less than 5 m from the pond."),
    ("demo", "Photograph tree 40 and keep away from people."),
    ("demo", "Photograph tree 40 and avoid mud."),
    ("demo", "Photograph tree 40 and use the east gate only."),
    ("demo", "Take pictures on the left side."),
    ("demo", "Take pictures on the left side of the wet corner."),
]


def site_of(name: str) -> Site:
    return open_site("demo") if name == "demo" else vineyard()


@pytest.mark.parametrize(
    ("site", "request_", "plan"), [(site, *case) for site, cases in PLANNED.items() for case in cases]
)
def test_what_is_avoided_is_planned_as_it_is_said(site: str, request_: str, plan: str) -> None:
    outcome = composed(request_, site_of(site), HUSKY)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task).removesuffix(" | return_to_start") == plan
    assert mismatches(outcome.task, site_of(site), HUSKY) == ()
    assert unaccounted(outcome.task) == ()


@pytest.mark.parametrize("hand", ["left", "right"])
def test_the_left_and_the_right_side_of_a_row_are_stated_as_an_assumption(hand: str) -> None:
    outcome = composed(f"Take pictures of the {hand} side of row 4.", site_of("demo"), HUSKY)
    assert isinstance(outcome, Planned)
    compass = {"left": "east", "right": "west"}[hand]
    assert any(f"the {hand} side is the {compass} side" in text for text in outcome.task.command.assumptions)


@pytest.mark.parametrize(("site", "request_"), ASKED)
def test_rows_without_their_block_are_asked_about(site: str, request_: str) -> None:
    outcome = composed(request_, site_of(site), HUSKY)
    assert isinstance(outcome, Clarify)
    assert all("must keep out of row 10 of block" in choice for choice in outcome.choices)


@pytest.mark.parametrize(("site", "request_"), REFUSED)
def test_what_cannot_be_kept_is_refused(site: str, request_: str) -> None:
    assert isinstance(composed(request_, site_of(site), HUSKY), Refused)
