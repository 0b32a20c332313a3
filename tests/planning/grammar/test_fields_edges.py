"""Fences, walls and ponds that are filmed; ground that was probed and then mown; ends on ground; compared areas."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import require_plan, require_refusal
from support.sites.gardens import box, fence, mark, pasture, vegetable_garden
from support.sites.points import read

GARDEN, PASTURE = vegetable_garden(), pasture()
AMIGA, HUSKY, TRACTOR = load_robot("amiga"), load_robot("husky"), load_robot("tractor")


def _fenced_yard() -> Site:
    ring = ((0, 0), (60, 0), (60, 40), (0, 40), (0, 0))
    house = ((20, 10), (40, 10), (40, 30), (20, 30), (20, 10))
    return read(
        box(0, 0, 60, 40, kind="boundary", name="yard"),
        fence(*ring, name="hare fence"),
        fence(*house, name="brick wall"),
        box(46, 5, 52, 10, kind="building", name="pump house"),
        mark(5, 5, kind="start", name="yard door"),
    )


YARD = _fenced_yard()
HARE = "film perimeter InZone(hare fence)"
PROBED = "for PointsIn(bank, 4): [moisture = r1]; if mean(r1 < 30 percent): [mow area InZone(bank)]"
COMPARED = (
    "for PointsIn(bank, 4, True): [nitrate = r2]; for PointsIn(boggy corner, 4, True): [nitrate = r1]; "
    "if mean(r1) > mean(r2): [for PointsIn(boggy corner, 2): [sample_leaf]]"
)
BOTH = "Read nitrate on the bank and in the boggy corner, four random places each."

PLANNED = [
    (YARD, TRACTOR, "Film the hare fence.", HARE),
    (YARD, TRACTOR, "Film the hare fence from the inside.", HARE),
    (YARD, TRACTOR, "Film the hare fence all the way round.", HARE),
    (YARD, TRACTOR, "Film the hare fence all the way round, keeping to the inside.", HARE),
    (YARD, TRACTOR, "Check the hare fence for holes: film it all the way round from the inside.", HARE),
    (YARD, TRACTOR, "Inspect the hare fence for gnawing: film it from inside.", HARE),
    (YARD, TRACTOR, "Film the hare fence from the inside at half a metre per second.", f"{HARE} | speed 0.5"),
    (YARD, TRACTOR, "Film the hare fence twice.", f"{HARE}, 2 laps"),
    (YARD, TRACTOR, "Film the pump house from the outside.", "film perimeter InZone(pump house)"),
    (YARD, TRACTOR, "Film the pump house from all sides.", "film perimeter InZone(pump house)"),
    (YARD, TRACTOR, "Film the brick wall.", "film perimeter InZone(brick wall)"),
    (PASTURE, TRACTOR, "Film the pond all the way round.", "film perimeter InZone(pond)"),
    (PASTURE, TRACTOR, "Film the sheep fence.", "film perimeter InZone(sheep fence)"),
    (PASTURE, TRACTOR, "Probe the bank at four points. If the mean moisture is under 30 percent, mow it.", PROBED),
    (PASTURE, TRACTOR, "Read soil moisture at four points on the bank and mow it if the mean is below 30 %.", PROBED),
    (
        PASTURE,
        TRACTOR,
        "Drive to the boggy corner, then mow the bank.",
        "go PointsIn(boggy corner); mow area InZone(bank)",
    ),
    (
        PASTURE,
        TRACTOR,
        "Mow the bank, then drive to the boggy corner.",
        "mow area InZone(bank); go PointsIn(boggy corner)",
    ),
    (
        PASTURE,
        HUSKY,
        "Read CO2 on the bank and finish in the boggy corner.",
        "co2 @ PointsIn(bank); go PointsIn(boggy corner) | stay",
    ),
    (
        PASTURE,
        HUSKY,
        "Walk a W across the long pasture with nine CO2 readings on it.",
        "for Transect(9, long pasture): [co2]",
    ),
    (PASTURE, HUSKY, "Walk a W over the bank, taking nine CO2 readings on the way.", "for Transect(9, bank): [co2]"),
    (PASTURE, AMIGA, f"{BOTH} Should the boggy corner average higher, take two leaf samples there.", COMPARED),
    (PASTURE, AMIGA, f"{BOTH} If the boggy corner is higher on average, take two leaf samples from it.", COMPARED),
    (PASTURE, AMIGA, f"{BOTH} If the average in the boggy corner is higher, take two leaf samples there.", COMPARED),
    (
        PASTURE,
        AMIGA,
        f"{BOTH} If the boggy corner averages higher than the bank, take two leaf samples in the boggy corner.",
        COMPARED,
    ),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED)
def test_ground_and_its_edges_are_worked(site: Site, robot: object, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(
    ("site", "robot", "request_", "why"),
    [
        (YARD, TRACTOR, "Film the brick wall from outside.", "on which side"),
        (YARD, TRACTOR, "Film the hare fence from outside.", "on which side"),
        (YARD, TRACTOR, "Film the pump house from the inside.", "on which side"),
        (PASTURE, TRACTOR, "Film the sheep fence from the inside.", "on which side"),
    ],
)
def test_other_sides_of_an_edge_are_refused(site: Site, robot: object, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)


def test_the_edge_of_an_orchard_has_an_inside() -> None:
    require_plan(open_site("demo"), TRACTOR, "Film the fence from the inside.", "film perimeter Trees")
