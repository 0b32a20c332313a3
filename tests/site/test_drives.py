"""Test drives: straight on clear ground, never through a keep-out or the boundary, and of minimal length."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra
from shapely.affinity import rotate, translate
from shapely.geometry import LineString, Point, Polygon, box

from fieldhand.errors import DriveFault
from fieldhand.site.drives import Drive, Drives
from support.sites.points import place_at, site_of

POND = [(-10, -10), (10, -10), (10, 10), (-10, 10)]
#: A keep-out with a bay that opens to the west.
BAY = Polygon([(-10, -10), (10, -10), (10, 10), (-10, 10), (-10, 6), (6, 6), (6, -6), (-10, -6)])


def ground(*keep_outs, boundary=None, clearance=0.5) -> Drives:
    zones = [(f"pond {k}", "keep_out", shape) for k, shape in enumerate(keep_outs)]
    zones += [("fence", "boundary", boundary)] if boundary is not None else []
    return Drives(site_of([(0.0, -200.0), (4.0, -200.0)] if boundary is None else [(0, 0)], zones=zones), clearance)


def spot(x: float, y: float):
    return place_at(x, y, id=f"({x}, {y})")


def test_without_obstacles_a_drive_is_the_straight_line():
    drives = ground()
    drive = drives.between(spot(0, 0), spot(3, 4))
    assert drive == Drive(((0.0, 0.0), (3.0, 4.0)), 5.0, start=drive.start, end=drive.end)
    assert drives.lengths([spot(0, 0), spot(3, 4), spot(0, 4)]).tolist() == [[0, 5, 4], [5, 0, 3], [4, 3, 0]]


def test_a_plain_zone_does_not_affect_drives():
    drives = Drives(site_of([(0, 0)], zones=[("wet", "zone", POND)]), 0.5)
    assert drives.between(spot(-20, 0), spot(20, 0)).length_m == 40.0


def test_the_path_around_a_square_pond_is_the_known_one():
    way = ground(POND, clearance=0.0).between(spot(-20, 0), spot(20, 0))
    assert way.length_m == pytest.approx(2 * math.hypot(10, 10) + 20)
    assert {tuple(round(abs(c), 6) for c in p) for p in way.points[1:-1]} == {(10.0, 10.0)}


def test_the_path_keeps_its_clearance_with_little_extra_length():
    bare = ground(POND, clearance=0.0).between(spot(-20, 0), spot(20, 0))
    way = ground(POND, clearance=1.0).between(spot(-20, 0), spot(20, 0))
    assert LineString(way.points).distance(Polygon(POND)) >= 1.0 - 1e-5
    assert bare.length_m < way.length_m < bare.length_m + 4.0


def test_the_path_back_is_the_path_reversed():
    drives = ground(POND)
    there, back = drives.between(spot(-20, 1), spot(20, 2)), drives.between(spot(20, 2), spot(-20, 1))
    assert there.points == back.points[::-1]
    assert there.length_m == back.length_m


@pytest.mark.parametrize("place", [(10.05, 0.0), (10.0, 3.0), (10.2, 10.2), (5.9, 0.0), (-10.1, 6.1)])
def test_a_place_within_the_clearance_is_reached_and_the_keep_out_never_crossed(place):
    drives = ground(BAY, clearance=1.0)
    way = drives.between(spot(*place), spot(-30, 3))
    assert not LineString(way.points).intersects(BAY.buffer(-1e-4))
    outside = LineString(way.points).difference(Point(place).buffer(6.0))
    assert outside.distance(BAY) >= 1.0 - 1e-5


def test_two_places_side_by_side_on_the_bank_have_a_short_drive():
    drives = ground(POND, clearance=0.5)
    assert drives.between(spot(10.1, 0), spot(10.1, 1)).length_m == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("a", "says"),
    [((0.0, 0.0), "inside the keep-out 'pond 0'"), ((70.0, 0.0), "outside the boundary")],
)
def test_a_place_on_closed_ground_is_named_with_the_reason(a, says):
    drives = ground(POND, boundary=box(-50, -50, 50, 50))
    here = place_at(*a, kind="tree", id="17")
    for call in (lambda: drives.between(here, spot(30, 30)), lambda: drives.lengths([spot(30, 30), here])):
        with pytest.raises(DriveFault, match=says) as caught:
            call()
        assert "tree 17" in str(caught.value)
    assert says in drives.problem(here)
    assert drives.problem(spot(30, 30)) == ""


def test_no_path_leads_through_a_gap_narrower_than_the_robot():
    wall = [box(-1, -50, 1, -0.4), box(-1, 0.4, 1, 50)]
    fence = box(-50, -50, 50, 50)
    slim, wide = ground(*wall, boundary=fence, clearance=0.3), ground(*wall, boundary=fence, clearance=0.6)
    assert slim.between(spot(-20, 0), spot(20, 0)).length_m == pytest.approx(40.0)
    with pytest.raises(DriveFault, match=r"no way .* 1\.2 m wide"):
        wide.between(spot(-20, 0), spot(20, 0))
    with pytest.raises(DriveFault, match="no way"):
        wide.lengths([spot(-20, 0), spot(-10, 0), spot(20, 0)])


def test_the_path_stays_inside_a_concave_boundary():
    fence = Polygon([(0, 0), (40, 0), (40, 10), (10, 10), (10, 40), (0, 40)])
    way = ground(boundary=fence, clearance=0.0).between(spot(38, 8), spot(8, 38))
    assert way.points[1] == pytest.approx((10, 10))
    assert way.length_m == pytest.approx(2 * math.hypot(28, 2))


def test_a_point_along_the_path_is_at_its_distance_in_metres():
    drive = Drive(((0.0, 0.0), (3.0, 0.0), (3.0, 4.0)), 7.0, start=spot(0, 0), end=spot(3, 4))
    assert [drive.at(m) for m in (-1, 0, 1.5, 3, 5, 7, 99)] == [
        (0, 0),
        (0, 0),
        (1.5, 0),
        (3, 0),
        (3, 2),
        (3, 4),
        (3, 4),
    ]


@pytest.mark.parametrize("clearance", [0.0, 0.1])
def test_a_pond_traced_with_thousands_of_points_is_rounded_off_outwards(clearance):
    angle = np.linspace(0, 2 * math.pi, 9001)[:-1]
    radius = 50 + 0.3 * np.sin(900 * angle)
    pond = Polygon(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]))
    way = ground(pond, clearance=clearance).between(spot(-80, 0), spot(80, 0))
    assert LineString(way.points).distance(pond) >= clearance - 1e-5
    r = 50.3 + clearance
    around_a_disk = 2 * math.sqrt(80**2 - r**2) + r * (math.pi - 2 * math.acos(r / 80))
    assert around_a_disk - 0.5 < way.length_m < around_a_disk + 1.5


def star(draw) -> Polygon:
    """Draw a convex or concave keep-out around the origin."""
    n = draw(st.integers(3, 7))
    radii = draw(st.lists(st.floats(3.0, 12.0), min_size=n, max_size=n))
    angles = [2 * math.pi * k / n for k in range(n)]
    return Polygon([(r * math.cos(a), r * math.sin(a)) for r, a in zip(radii, angles, strict=True)])


@st.composite
def grounds(draw):
    """Draw one to three possibly overlapping keep-outs, an optional fence, and places on free ground."""
    shapes = []
    for _ in range(draw(st.integers(1, 3))):
        turned = rotate(star(draw), draw(st.floats(0, 360)), origin=(0, 0))
        shapes.append(translate(turned, draw(st.floats(-20, 20)), draw(st.floats(-20, 20))))
    fence = box(-45, -45, 45, 45) if draw(st.booleans()) else None
    free = st.tuples(st.floats(-40, 40), st.floats(-40, 40)).filter(
        lambda p: all(s.distance(Point(p)) > 0 for s in shapes)
    )
    places = draw(st.lists(free, min_size=3, max_size=6, unique=True))
    return shapes, fence, places


@settings(max_examples=60, deadline=None)
@given(grounds(), st.sampled_from([0.0, 0.4, 1.0]))
def test_no_path_crosses_a_keep_out_or_the_boundary_and_lengths_agree(world, clearance):
    shapes, fence, xy = world
    drives = ground(*shapes, boundary=fence, clearance=clearance)
    places = [spot(*p) for p in xy]
    try:
        lengths = drives.lengths(places)
    except DriveFault:
        assert clearance > 0.0  # keep-outs may leave gaps that are too narrow
        return
    soft = shapely.union_all(shapes).buffer(clearance * 1.1)
    for i, a in enumerate(places):
        for j, b in enumerate(places):
            way = drives.between(a, b)
            line = LineString(way.points)
            assert (way.points[0], way.points[-1]) == (a.xy, b.xy)
            assert all(not line.intersects(s.buffer(-1e-4)) for s in shapes)
            assert fence is None or fence.buffer(1e-4).covers(line)
            straight = math.hypot(a.x - b.x, a.y - b.y)
            assert way.length_m >= straight - 1e-9
            assert way.length_m == pytest.approx(line.length, abs=1e-9)
            assert lengths[i, j] == pytest.approx(way.length_m, abs=1e-6)
            if i != j and not LineString([a.xy, b.xy]).intersects(soft):
                assert way.length_m == pytest.approx(straight)
    assert (lengths == lengths.T).all()
    for k in range(len(places)):  # by way of a place in the band a bit may be saved, as clearance gives way there
        assert (lengths <= lengths[:, [k]] + lengths[[k], :] + 16.0 * clearance + 1e-6).all()


@settings(max_examples=12, deadline=None)
@given(grounds())
@example(
    ([Polygon([(3, 3), (-2, 6), (-6, 3), (-2, 0)]), box(-13, -3, -7, 5)], None, [(0.0, 1.0), (-4.0, 5.0), (0.0, 0.0)])
)
def test_lengths_agree_with_a_dense_grid_search(world):
    shapes, _, xy = world
    blocked = shapely.union_all(shapes)
    a, b = xy[0], xy[1]
    assume(math.dist(a, b) > 5)
    drives = ground(*shapes, clearance=0.0)
    try:
        way = drives.between(spot(*a), spot(*b))
    except DriveFault:
        assume(False)
    shortest = grid_search(blocked, a, b)
    # paths on a 16-connected grid are at most 2.8 % longer than in the plane, and their ends are off by a cell
    assert way.length_m <= shortest + 2.0
    # and the grid may miss a gap that is narrower than its cells, through which no path with room to spare leads
    try:
        roomy = ground(*shapes, clearance=1.5).between(spot(*a), spot(*b))
    except DriveFault:
        return
    assert shortest <= 1.03 * roomy.length_m + 4.0


def grid_search(blocked, a, b, cell: float = 1.0) -> float:
    """Return the shortest path over a dense 16-connected grid that avoids ``blocked``."""
    side = np.arange(-60, 60 + cell, cell)
    n = len(side)
    x, y = (g.ravel() for g in np.meshgrid(side, side, indexing="ij"))
    shapely.prepare(blocked)
    rows, columns, costs = [], [], []
    steps = [(1, 0), (0, 1), (1, 1), (1, -1), (2, 1), (2, -1), (1, 2), (1, -2)]
    index = np.arange(n * n).reshape(n, n)
    for di, dj in steps:
        i0, i1 = max(0, -di), n - max(0, di)
        j0, j1 = max(0, -dj), n - max(0, dj)
        one = index[i0:i1, j0:j1].ravel()
        two = index[i0 + di : i1 + di, j0 + dj : j1 + dj].ravel()
        lines = shapely.linestrings(
            np.stack([np.column_stack([x[one], y[one]]), np.column_stack([x[two], y[two]])], axis=1)
        )
        clear = ~shapely.intersects(blocked, lines)
        rows.append(one[clear])
        columns.append(two[clear])
        costs.append(np.full(clear.sum(), cell * math.hypot(di, dj)))
    graph = csr_matrix((np.concatenate(costs), (np.concatenate(rows), np.concatenate(columns))), shape=(n * n, n * n))
    ends = []
    for p in (a, b):
        lines = shapely.linestrings(
            [[p, q] for q in np.column_stack([x, y])[np.hypot(x - p[0], y - p[1]) <= 1.5 * cell]]
        )
        near = np.flatnonzero(np.hypot(x - p[0], y - p[1]) <= 1.5 * cell)[~shapely.intersects(blocked, lines)]
        assume(len(near) > 0)
        ends.append((near, np.hypot(x[near] - p[0], y[near] - p[1])))
    found = dijkstra(graph, directed=False, indices=ends[0][0])[:, ends[1][0]]
    best = float((found + ends[0][1][:, None] + ends[1][1][None, :]).min())
    assume(math.isfinite(best))
    return best
