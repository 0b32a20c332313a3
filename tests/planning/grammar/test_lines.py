"""Captures on the straight line from one place to another, and work along one side of an edge."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import pasture

DEMO, PASTURE = open_site("demo"), pasture()
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")
GATES = "StraightLine(GateIs(farm gate), GateIs(middle gate)"

PLANNED = [
    (PASTURE, AMIGA, request_, plan)
    for plan, requests in {
        f"for {GATES}, 20): [moisture]": [
            "read soil moisture every 20 m in a straight line from the farm gate to the middle gate",
            "A moisture reading every 20 metres on a straight line from the farm gate to the middle gate.",
            "In a straight line from the farm gate to the middle gate, measure soil moisture every 20 m.",
            "Measure soil moisture every 20 m along the straight line between the farm gate and the middle gate.",
            "Drive in a straight line from the farm gate to the middle gate and read moisture every 20 m.",
            "Follow a straight line from the farm gate to the middle gate and measure moisture every 20 m.",
            "soil moisture from the farm gate to the middle gate, every 20 m",
            "Go straight from the farm gate to the middle gate, with a moisture reading every 20 metres.",
        ],
        f"for {GATES}, 8): [moisture]": [
            "read soil moisture at 8 points on a straight line from the farm gate to the middle gate",
            "take 8 soil moisture readings on the straight line between the farm gate and the middle gate",
            "8 moisture readings in a straight line from the farm gate to the middle gate",
        ],
        "for StraightLine(InZone(pond), InZone(cowslip patch), 10): [picture(view ground)]": [
            "photograph the ground every 10 m in a straight line from the pond to the cowslip patch",
        ],
        "go GateIs(farm gate); for StraightLine(Here, GateIs(middle gate), 15): [moisture]": [
            "Starting at the farm gate, read moisture every 15 m in a straight line to the middle gate.",
        ],
    }.items()
    for request_ in requests
]
PLANNED += [
    (
        DEMO,
        HUSKY,
        "read CO2 every 10 m in a straight line from tree 4 to tree 60",
        "for StraightLine(TreeIs(4), TreeIs(60), 10): [co2]",
    ),
]
OFF = "for Transect(10, edge, pond, 4): [picture]"
EDGES = [
    (PASTURE, HUSKY, "Go once round the pond, keeping 4 m away from it, with a thermal picture every 10 metres.", OFF),
    (PASTURE, HUSKY, "Circle the pond, 4 metres from the edge, with a thermal picture every 10 metres.", OFF),
    (PASTURE, HUSKY, "Drive around the pond 4 m from its edge and take a thermal picture every 10 m.", OFF),
    (
        PASTURE,
        HUSKY,
        "take a thermal picture every 10 m along the edge of the bank, 2 m from the edge",
        "for Transect(10, edge, bank, 2): [picture]",
    ),
    (PASTURE, TRACTOR, "mow a 2.4 m wide strip around the cow paddock", "mow perimeter InZone(cow paddock), 2 laps"),
    (PASTURE, TRACTOR, "mow a strip of 1.2 m along the edge of the bank", "mow perimeter InZone(bank)"),
    (
        DEMO,
        HUSKY,
        "read CO2 at tree 4, then every 5 m along row 3",
        "co2 @ TreeIs(4); for Spaced(5, of Rows(3, 3)): [co2]",
    ),
    (
        DEMO,
        HUSKY,
        "CO2 at tree 4 and every 10 m along rows 3 and 5",
        "co2 @ TreeIs(4); for UnionOf(Spaced(10, of Rows(3, 3))+Spaced(10, of Rows(5, 5))): [co2]",
    ),
]
CORNERS = [
    (PASTURE, HUSKY, "read CO2 at the four corners of the long pasture", "for Corners(long pasture): [co2]"),
    (PASTURE, HUSKY, "take a thermal picture at each corner of the cow paddock", "for Corners(cow paddock): [picture]"),
    (PASTURE, HUSKY, "read CO2 in the north-west corner of the bank", "co2 @ Corners(nw, bank)"),
    (PASTURE, HUSKY, "thermal pictures at all four corners of the pond, please", "for Corners(pond): [picture]"),
    (PASTURE, HUSKY, "take a thermal picture at the four corners", "for Corners(common): [picture]"),
    (DEMO, HUSKY, "take a thermal picture at the four corners", "for Corners: [picture]"),
]
REFUSED = [
    (PASTURE, AMIGA, "read moisture in a straight line from the farm gate to the middle gate", "at how many places"),
    (PASTURE, AMIGA, "read moisture every 10 m in a straight line from the farm gate to the church", "church"),
    (DEMO, HUSKY, "read CO2 every 10 m from tree 4 to tree 60", "tree"),
]
ALONG = [
    (PASTURE, TRACTOR, request_, plan)
    for plan, requests in {
        "film perimeter InZone(sheep fence), west": [
            "film the sheep fence from the west side",
            "film the sheep fence from the long pasture side",
            "film the west side of the sheep fence",
            "film along the west side of the sheep fence",
            "film the sheep fence on its west side",
            "film the sheep fence on the long pasture side",
            "film the full length of the sheep fence from the long pasture side",
        ],
        "film perimeter InZone(sheep fence), west, heading north": [
            "film the west side of the sheep fence from south to north",
            "film the sheep fence from the west side, from its south end to its north end",
            "film the sheep fence from the long pasture side, going from its south end to its north end",
        ],
        "film perimeter InZone(sheep fence), east": ["film the sheep fence from the cow paddock side"],
        "spray perimeter InZone(sheep fence), rate_l_ha 200, east": [
            "spray along the cow paddock side of the sheep fence at 200 l/ha",
            "spray once along the east side of the sheep fence at 200 l/ha",
        ],
        "film perimeter InZone(pond), north": ["film the pond from the north side", "film the north side of the pond"],
        "mow perimeter InZone(bank), south": [
            "mow along the southern edge of the bank",
            "mow the southern edge of the bank",
        ],
        "mow area Half(north, of InZone(bank))": ["mow the north side of the bank"],
    }.items()
    for request_ in requests
]
ALONG_REFUSED = [
    (PASTURE, TRACTOR, "film the west side of the sheep fence from east to west", ""),
    (PASTURE, TRACTOR, "film the sheep fence from the middle gate to its northern end", "along one side of it"),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_points_on_a_straight_line_are_planned(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_lines_that_are_not_straight_or_have_no_points_are_refused(
    site: Site, robot: RobotProfile, request_: str, why: str
) -> None:
    require_refusal(site, robot, request_, why)


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), ALONG, ids=name)
def test_one_side_of_an_edge_is_worked(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), ALONG_REFUSED, ids=name)
def test_other_parts_of_an_edge_are_refused(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), CORNERS, ids=name)
def test_corners_of_ground_without_plants_are_points_of_it(
    site: Site, robot: RobotProfile, request_: str, plan: str
) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), EDGES, ids=name)
def test_distances_from_edges_and_widths_of_strips_are_planned(
    site: Site, robot: RobotProfile, request_: str, plan: str
) -> None:
    require_plan(site, robot, request_, plan)


def test_a_strip_between_two_numbers_of_laps_is_asked_about() -> None:
    for width in ("three metres wide", "2 m wide"):
        require_question(PASTURE, TRACTOR, f"Mow a strip {width} all round the cow paddock.", 2)


def test_a_robot_that_only_waits_for_a_time_somewhere_is_refused() -> None:
    require_refusal(
        PASTURE, HUSKY, "Drive to the middle gate, wait there until 14:30 and come back.", "cannot wait for a time"
    )
