"""Rows and aisles that are driven towards one side of the compass, and lanes of a given direction."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from fieldhand.approval.checks import examine
from fieldhand.errors import PlaceError
from fieldhand.forecast.estimate import estimate
from fieldhand.forecast.visit_order import drives_for
from fieldhand.places.selectors import InZone, Rows
from fieldhand.robot.loader import load_robot
from fieldhand.site.model import Site
from fieldhand.site.working.areas import area_work
from fieldhand.site.working.heading import LANE_BEARINGS, headed
from fieldhand.site.working.stretch import Stretch
from fieldhand.site.working.units import RowWork, WorkUnit, row_units
from fieldhand.task.plan import InOrder, WorkAlong
from support.missions.rig import orchard, task_for
from support.missions.working import tractor
from support.sites.gardens import pasture


def bearings_of(units) -> list[float]:
    """Return the bearings of the longest lines of units, in degrees from 0 up to 180."""
    found = []
    for unit in units:
        for stretch in unit.options[0]:
            (ax, ay), (bx, by) = stretch.begin, stretch.end
            if math.dist(stretch.begin, stretch.end) > 10.0:
                found.append(math.degrees(math.atan2(bx - ax, by - ay)) % 180.0)
    return found


@pytest.mark.parametrize("heading", ["north_south", "east_west"])
def test_the_lanes_of_an_area_run_as_they_should(heading: str) -> None:
    site = pasture()
    drives = drives_for(site, tractor())
    ground = max((zone.polygon for zone in site.zones_of("zone")), key=lambda polygon: polygon.area)
    work = area_work(drives, ground, 2.0, (0.0, 0.0), None, bearing_deg=LANE_BEARINGS[heading])
    lanes = [unit for unit in work.units if "lane" in unit.options[0][0].name]
    assert len(lanes) > 5
    assert all(abs((found - LANE_BEARINGS[heading] + 90.0) % 180.0 - 90.0) < 1.0 for found in bearings_of(lanes))


@pytest.mark.parametrize("side", ["east", "west"])
def test_rows_are_driven_towards_a_side(side: str) -> None:
    site = orchard()  # whose rows run east to west
    drives = drives_for(site, tractor())
    units = headed(row_units(drives, list(range(len(site.trees))), RowWork()), side, site.name)  # type: ignore[arg-type]
    ways = [stretch for unit in units for option in unit.options for stretch in option]
    assert ways
    assert all(s.one_way and (s.end[0] > s.begin[0]) == (side == "east") for s in ways)


def test_a_row_that_runs_across_is_refused_by_name() -> None:
    site = orchard()
    units = row_units(drives_for(site, tractor()), list(range(len(site.trees))), RowWork())
    with pytest.raises(PlaceError, match=r"row r\d, .* side cannot be driven to the north"):
        headed(units, "north", site.name)


def test_a_stretch_that_is_driven_one_way_only_is_not_turned() -> None:
    there = Stretch(name="a", points=((0.0, 0.0), (10.0, 0.0)), on=((0.0, 10.0),), one_way=True)
    unit = WorkUnit(options=((there,),))
    assert headed([unit], "east", "here") == (unit,)
    with pytest.raises(PlaceError):
        headed([unit], "west", "here")


@given(
    st.lists(st.tuples(st.floats(-50, 50), st.floats(-50, 50)), min_size=2, max_size=6),
    st.sampled_from(["north", "east", "south", "west"]),
)
@settings(max_examples=60)
def test_a_headed_unit_keeps_its_work_and_never_leads_away(points, side) -> None:
    assume(sum(math.dist(a, b) for a, b in pairwise(points)) >= 1.0)
    stretch = Stretch(name="a", points=tuple(points), on=((0.0, 1.0),))
    try:
        (unit,) = headed([WorkUnit(options=((stretch,),))], side, "here")
    except PlaceError:
        return
    ((made,),) = unit.options
    assert sorted(made.points) == sorted(stretch.points)
    assert made.on_m == pytest.approx(stretch.on_m)
    towards = {"north": (0, 1), "east": (1, 0), "south": (0, -1), "west": (-1, 0)}[side]
    away = sum(t * (b - a) for t, a, b in zip(towards, made.begin, made.end, strict=True))
    assert away >= 0.5 * math.dist(made.begin, made.end) - 1e-6


def test_a_mission_films_a_row_in_its_direction_with_the_camera_on_the_row() -> None:
    site, robot = Site.demo(), load_robot("tractor")
    for heading, north in (("north", True), ("south", False)):
        node = WorkAlong(action="film", along=Rows(first="5", last="5"), heading=heading)  # type: ignore[arg-type]
        forecast = estimate(task_for(InOrder(steps=(node,))), site, robot)
        ways = {step.stretch for step in forecast.branches[0].walk.steps if step.stretch is not None}
        assert ways
        assert all((way.end[1] > way.begin[1]) == north and way.one_way for way in ways)


@pytest.mark.parametrize(
    ("node", "problem"),
    [
        (WorkAlong(action="mow", mode="area", along=InZone(zone="wet corner"), heading="north"), "no such direction"),
        (WorkAlong(action="spray", along=Rows(first="3", last="3"), heading="east_west"), "no such direction"),
        (WorkAlong(mode="perimeter", along=InZone(zone="pond"), heading="north"), "no such direction"),
        (WorkAlong(action="spray", along=Rows(first="3", last="3"), heading="east"), "cannot be driven to the east"),
        (WorkAlong(action="mow", mode="area", along=InZone(zone="wet corner"), heading="east_west"), "run another way"),
    ],
)
def test_a_direction_that_cannot_be_is_an_error_of_the_plan(node: WorkAlong, problem: str) -> None:
    examined = examine(task_for(InOrder(steps=(node,))), Site.demo(), load_robot("tractor"))
    assert any(problem in one.what for one in examined.problems if one.severity == "error")
