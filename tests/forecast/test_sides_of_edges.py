"""Work along the part of an edge that faces one side of the compass, driven towards another."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import affinity
from shapely.geometry import LineString, Point, box

import fieldhand as fh
from fieldhand.errors import PlaceError
from fieldhand.forecast.visit_order import drives_for
from fieldhand.forecast.working import stretches_of
from fieldhand.places.context import Context
from fieldhand.robot.loader import load_robot
from fieldhand.site.working.areas import perimeter_units
from fieldhand.site.working.heading import TOWARDS
from fieldhand.site.working.stretch import Stretch
from fieldhand.task.plan import walk
from fieldhand.terms import Side
from support.sites.gardens import pasture

SITE, TRACTOR = pasture(), load_robot("tractor")
SIDES: tuple[Side, ...] = ("north", "east", "south", "west")


def along(zone: str, **more: object) -> tuple[Stretch, ...]:
    node = fh.steps.WorkAlong(along=fh.selectors.InZone(zone=zone), mode="perimeter", **more)
    task = fh.build_task(node, SITE, TRACTOR, request="along its side")
    (planned,) = [step for step in walk(task.composition.plan) if isinstance(step, fh.steps.WorkAlong)]
    return stretches_of(planned, task, SITE, TRACTOR, drives_for(SITE, TRACTOR), Context(here=SITE.start))


@pytest.mark.parametrize("side", SIDES)
def test_one_side_of_a_pond_is_worked_outside_of_it_and_of_a_paddock_inside(side: Side) -> None:
    east, north = TOWARDS[side]
    for zone in ("pond", "cow paddock"):
        polygon = next(one.polygon for one in SITE.zones if one.name == zone)
        middle, (west, south, right, top) = polygon.centroid, polygon.bounds
        (stretch,) = along(zone, sides=side)
        line = LineString(stretch.points)
        aside = line.interpolate(0.5, normalized=True)
        assert polygon.contains(Point(aside)) == (zone == "cow paddock")
        assert (aside.x - middle.x) * east + (aside.y - middle.y) * north > 0
        width = (top - south) if east else (right - west)
        assert 0.6 * width < line.length < width + 8.0


@pytest.mark.parametrize(("side", "heading"), [("west", "north"), ("west", "south"), ("east", "north")])
def test_a_side_of_a_fence_is_driven_in_the_direction_that_is_said(side: Side, heading: Side) -> None:
    found = along("sheep fence", sides=side, heading=heading)
    for stretch in found:
        assert (stretch.end[1] > stretch.begin[1]) == (heading == "north")
        assert all((x < 0.0) == (side == "west") for x, _ in stretch.points)
    assert sum(stretch.length_m for stretch in found) > 80.0


def test_a_camera_on_one_side_of_the_robot_sets_the_direction() -> None:
    (stretch, *_) = along("sheep fence", action="film", sides="west")  # the tractor's camera looks to the right
    assert stretch.end[1] > stretch.begin[1]
    with pytest.raises(PlaceError, match="cannot be driven to the south; name the other direction"):
        along("sheep fence", action="film", sides="west", heading="south")


def test_a_side_along_which_the_robot_cannot_drive_is_an_error() -> None:
    drives = drives_for(SITE, TRACTOR)
    (west, south, _, north) = SITE.zones_of("boundary")[0].polygon.bounds
    shed = box(west, south, west + 10, north)
    assert perimeter_units(drives, shed, 0.5, outside=True, mounted="both", side="east")
    with pytest.raises(PlaceError, match="cannot drive along the west side of this area; name another side"):
        perimeter_units(drives, shed, 0.5, outside=True, mounted="both", side="west")


@settings(max_examples=30, deadline=None)
@given(st.floats(8, 40), st.floats(8, 40), st.floats(-40, 40))
def test_the_four_sides_of_an_area_are_its_edge(wide: float, high: float, turned: float) -> None:
    drives = drives_for(SITE, TRACTOR)
    area = affinity.rotate(box(-50 - wide / 2, -high / 2, -50 + wide / 2, high / 2), turned)
    lengths = []
    for side in SIDES:
        units = perimeter_units(drives, area, 0.5, outside=True, mounted="both", side=side)
        lengths.append(sum(stretch.length_m for unit in units for stretch in unit.options[0]))
    whole = perimeter_units(drives, area, 0.5, outside=True, mounted="both")
    total = sum(stretch.length_m for unit in whole for stretch in unit.options[0])
    assert total * 0.8 < sum(lengths) < total * 1.15
    assert math.isclose(lengths[0], lengths[2], rel_tol=0.1) or np.ptp(lengths) < 4.0


def _turns_right(stretches: tuple[Stretch, ...]) -> bool:
    ring = [xy for stretch in stretches for xy in stretch.points]
    return sum(ax * by - bx * ay for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1], strict=True)) < 0.0


@pytest.mark.parametrize("zone", ["pond", "cow paddock"])
@pytest.mark.parametrize("action", ["", "film", "mow"])
def test_a_round_is_driven_in_the_direction_that_is_said(zone: str, action: str) -> None:
    for heading in ("clockwise", "counterclockwise"):
        found = along(zone, action=action, heading=heading)
        assert _turns_right(found) == (heading == "clockwise")
        assert all(stretch.one_way for stretch in found)
    if action == "film":  # to the right of the tractor: the pond, or the edge of the paddock
        assert _turns_right(along(zone, action=action)) == (zone == "pond")
