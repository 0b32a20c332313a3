"""Lanes parallel to a line, distances that are not said, and rows that are counted within a section."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import box, fence, mark, pasture
from support.sites.points import read

DEMO, PASTURE = open_site("demo"), pasture()
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")
LANES = "mow area InZone(bank), heading north_south"


def two_bays() -> Site:
    """Rows 1 to 3 in the old bay and 4 to 6 in the new bay, from south to north."""
    plants = [
        mark(6.0 + k, 4.0 + 3.0 * row, kind="plant", id=f"B{row}-{k + 1}", row=row, crop="tomato")
        for row in range(1, 7)
        for k in range(8)
    ]
    bays = [box(4, 4, 18, 14.5, kind="zone", name="old bay"), box(4, 14.5, 18, 26, kind="zone", name="new bay")]
    slanted = fence((22, 2), (30, 12), name="slanted fence")
    return read(
        box(0, 0, 40, 30, kind="boundary", name="yard"), mark(2, 2, kind="start", name="tap"), slanted, *bays, *plants
    )


BAYS = two_bays()

PLANNED = [
    (PASTURE, TRACTOR, "mow the bank parallel to the sheep fence", LANES),
    (PASTURE, TRACTOR, "mow the bank in strips parallel to the sheep fence", LANES),
    (PASTURE, TRACTOR, "mow the bank in lanes running parallel with the sheep fence", LANES),
    (PASTURE, TRACTOR, "mow the bank, with the lanes running in line with the sheep fence", LANES),
    (
        PASTURE,
        TRACTOR,
        "mow the long pasture in strips parallel to the sheep fence, leaving out the cowslip patch",
        "mow area Excluding(InZone(cowslip patch), of InZone(long pasture)), heading north_south",
    ),
    (BAYS, AMIGA, "photograph every plant of row 5 in the new bay", "for InZone(new bay, of Rows(5, 5)): [picture]"),
    (
        BAYS,
        AMIGA,
        "photograph every plant of the first row of the old bay",
        "for InZone(old bay, of Rows(1, 1)): [picture]",
    ),
    (
        BAYS,
        AMIGA,
        "photograph every plant of the second row of the new bay",
        "for InZone(new bay, of Rows(5, 5)): [picture]",
    ),
]

ASKED = [
    (BAYS, AMIGA, "photograph every plant of row 2 in the new bay", 2),
    (BAYS, AMIGA, "photograph every plant of the first row of the new bay", 2),
    (DEMO, HUSKY, "read CO2 every so often along row 3", 0),
]

REFUSED = [
    (BAYS, TRACTOR, "mow the new bay parallel to the slanted fence", "lanes run from north to south"),
    (PASTURE, TRACTOR, "mow the bank parallel to the pond", "lanes run from north to south"),
    (
        PASTURE,
        TRACTOR,
        "film the sheep fence from the middle gate to its northern end",
        "an edge is worked all the way round",
    ),
    (
        PASTURE,
        TRACTOR,
        "starting at the middle gate, film the sheep fence up to its northern end",
        "an edge is worked all the way round",
    ),
    (PASTURE, HUSKY, "take a thermal picture every few metres along the sheep fence", "it does not say how far apart"),
    (DEMO, HUSKY, "take a picture every few trees in row 3", "it does not say how far apart"),
    (PASTURE, TRACTOR, "find the thistles on the bank and spray only those", "to recognise something"),
    (PASTURE, TRACTOR, "mow the bank but watch out for fawns", "to recognise something"),
    (PASTURE, HUSKY, "read CO2 at six random points on the bank, at least 8 m apart", "points keep no least distance"),
    (
        PASTURE,
        HUSKY,
        "read CO2 on the bank and in the boggy corner, switching area after every reading",
        "after each place",
    ),
    (BAYS, AMIGA, "photograph every plant of row 9 in the new bay", "there is no row '9'"),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_lanes_and_rows_are_planned(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "ways"), ASKED, ids=name)
def test_rows_that_may_be_counted_in_two_ways_are_asked_about(
    site: Site, robot: RobotProfile, request_: str, ways: int
) -> None:
    require_question(site, robot, request_, ways)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_what_is_not_said_is_refused(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)
