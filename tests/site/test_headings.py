"""A robot ends a drive along the aisle in which it stands; for a camera on one side it comes in from the right end."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from fieldhand.site.bearings import ahead_of, apart_deg, bearing_of, first_heading, heading_along, last_heading
from fieldhand.site.drives import Drives
from fieldhand.site.model import Place, Site
from support.sites.planted import generated, upright
from support.sites.points import place_at, site_of

CLEARANCE, STANDOFF = 0.35, 1.5
#: Trees on either side by which the direction of a row is judged, and degrees by which uneven trees turn it.
NEAR, OFF_DEG = 4, 15.0


def row_axis(site: Site, tree: Place) -> float:
    """The direction of the row at a tree, by the trees around it alone."""
    number = site.by_id[tree.id].index
    trees = site.planting.rows[int(site.planting.row_of[number])].trees
    rank = int(np.flatnonzero(trees == number)[0])
    one, two = trees[max(rank - NEAR, 0)], trees[min(rank + NEAR, len(trees) - 1)]
    return bearing_of(tuple(site.xy[one]), tuple(site.xy[two]))


def off_axis(heading: float, axis: float) -> float:
    return min(apart_deg(heading, axis), apart_deg(heading, axis + 180.0))


def in_rows(site: Site, drives: Drives) -> list[Place]:
    """The trees of rows of some length that can be reached."""
    long = [row for row in site.planting.rows if len(row.trees) >= 4]
    trees = [site.trees[int(k)].place for row in long for k in row.trees]
    return [p for p, why in zip(trees, drives.problems(trees), strict=True) if not why]


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6))
def test_every_drive_to_a_tree_of_a_row_ends_along_the_row(seed: int) -> None:
    site = generated(seed)
    drives = Drives(site, CLEARANCE, STANDOFF)
    trees = in_rows(site, drives)
    assume(len(trees) > 2 and not drives.problem(site.start))
    rng = np.random.default_rng(seed)
    for _ in range(12):
        one, two = (trees[k] for k in rng.choice(len(trees), 2, replace=False))
        for start in (site.start, one):
            if not drives.reachable([two], start)[0]:
                continue
            drive = drives.between(start, two)
            heading = drives.heading_after(drive)
            if heading is None:
                assert drive.length_m < 0.02
                continue
            assert off_axis(heading, row_axis(site, two)) <= OFF_DEG
            # In the direction of driving: the robot came from behind, if it came along the aisle at all.
            last = last_heading(drive.points)
            assert last is not None
            if off_axis(last, heading) < 60.0:
                assert apart_deg(last, heading) < 60.0


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from(["left", "right"]))
def test_a_robot_comes_in_so_that_the_tree_is_on_the_side_of_its_camera(seed: int, side: str) -> None:
    site = generated(seed)
    drives = Drives(site, CLEARANCE, STANDOFF)
    trees = in_rows(site, drives)
    assume(len(trees) > 2 and not drives.problem(site.start))
    rng = np.random.default_rng(seed)
    for _ in range(8):
        one, two = (trees[k] for k in rng.choice(len(trees), 2, replace=False))
        if not all(drives.reachable([one, two], site.start)):
            continue
        plain, way = drives.between(one, two), drives.arriving(one, two, side)
        assert way.length_m >= plain.length_m - 1e-6
        assert sum(math.dist(a, b) for a, b in itertools.pairwise(way.points)) == pytest.approx(way.length_m)
        heading = drives.heading_after(way)
        if way == plain or heading is None:
            continue
        # Independent of bearings: the tree lies in the half plane on that side of the robot.
        (x, y), (ahead_x, ahead_y) = way.points[-1], ahead_of((0.0, 0.0), heading, 1.0)
        left_of_it = ahead_x * (two.y - y) - ahead_y * (two.x - x)
        assert (left_of_it > 0.0) == (side == "left")


@pytest.mark.parametrize(("side", "heading"), [("left", 180.0), ("right", 0.0)])
def test_a_drive_over_the_headland_ends_along_the_aisle(side: str, heading: float) -> None:
    site = upright(4, 10)
    drives = Drives(site, CLEARANCE, STANDOFF)
    end, third = site.trees[9].place, site.trees[24].place
    drive = drives.between(end, third)
    assert off_axis(drives.heading_after(drive) or 0.0, 0.0) < 1e-6
    assert off_axis(last_heading(drive.points) or 0.0, 0.0) > 1.0
    west = site.trees[34].place  # of the outermost row, beside which there is no aisle
    assert off_axis(drives.heading_after(drives.between(end, west)) or 0.0, 0.0) < 1e-6
    arriving = drives.arriving(end, third, side)
    aisle = (arriving.end.stand or third.xy)[0] < third.x
    assert apart_deg(drives.heading_after(arriving) or 0.0, heading if aisle else heading + 180.0) < 1e-6


def test_on_open_ground_the_last_leg_counts() -> None:
    site = site_of([(0.0, 0.0), (30.0, 40.0), (31.0, 77.0)])
    drives = Drives(site, CLEARANCE, STANDOFF)
    here, there = place_at(0.0, 0.0), place_at(30.0, 40.0)
    drive = drives.between(here, there)
    assert drives.axis_deg(drive.end) is None
    assert drives.heading_after(drive) == pytest.approx(math.degrees(math.atan2(30.0, 40.0)))
    assert drives.heading_after(drives.between(here, here)) is None


@given(st.floats(0.0, 360.0, exclude_max=True), st.floats(0.1, 100.0))
def test_bearings_are_clockwise_from_north(bearing: float, metres: float) -> None:
    there = ahead_of((3.0, -2.0), bearing, metres)
    assert apart_deg(bearing_of((3.0, -2.0), there), bearing) < 1e-6
    assert there[1] - -2.0 == pytest.approx(metres * math.cos(math.radians(bearing)), abs=1e-9)
    path = ((0.0, 0.0), (3.0, -2.0), there, there)
    assert apart_deg(last_heading(path) or 0.0, bearing) < 1e-6
    assert apart_deg(first_heading(path) or 0.0, bearing_of((0.0, 0.0), (3.0, -2.0))) < 1e-6


def test_a_last_leg_across_the_axis_has_no_direction_along_it() -> None:
    # Up the middle of the aisle, then aside to the tree.
    assert heading_along(0.0, [(0.0, 0.0), (0.0, 20.0), (1.5, 20.0)]) == 0.0
    assert heading_along(180.0, [(0.0, 40.0), (0.0, 20.0), (1.5, 20.0)]) == 180.0
    assert heading_along(180.0, [(0.0, 0.0), (0.0, 20.0), (1.5, 20.001)]) == 0.0
