"""Free points: at a spacing on a line beside a row or through an area, and spread over a zone."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import affinity
from shapely.geometry import MultiPoint, Point, Polygon, box

from fieldhand.errors import PlaceError
from fieldhand.places.context import Context
from fieldhand.places.explanation import explain
from fieldhand.places.resolution import resolve
from fieldhand.places.selectors import (
    Corners,
    Here,
    InZone,
    Marker,
    PointAt,
    PointsIn,
    Rows,
    Spaced,
    StraightLine,
    Transect,
    TreeIs,
)
from fieldhand.site.model import Place, Site
from support.sites.points import at_start, place_at, planted, site_of, without_rows

ORCHARD = [(f"{c + 1}", [(6.0 * c, -4.0 * k) for k in range(11)]) for c in range(4)]


def orchard(**more) -> Site:
    """Four rows 6 m apart, of eleven trees 4 m apart: 1 to 11 from the north in the westernmost, and so on."""
    return planted([("1", 0.0, ORCHARD)], **more)


def points(selector, site: Site, here: Place | None = None) -> tuple[Place, ...]:
    found = resolve(selector, site, Context(here=here) if here else at_start(site))
    assert all(p.kind == "point" for p in found)
    return found


def xy(found) -> np.ndarray:
    return np.array([p.xy for p in found])


@settings(max_examples=80)
@given(
    st.floats(0.5, 60), st.integers(0, 12), st.integers(1, 44), st.sampled_from([0.0, 17.0, 44.0, 63.0, 90.0, 140.0])
)
def test_points_are_exactly_so_far_apart_in_an_aisle_beside_the_row_and_nearer_to_it(apart, count, tree, bearing):
    """The row of the tree in hand is 40 m long, so they fit or the message says how many would."""
    turn = math.radians(bearing)
    along = np.array([math.sin(turn), math.cos(turn)])
    along *= 1 if (along[0] > 0 if 45 < bearing < 135 else along[1] < 0) else -1
    across = np.array([along[1], -along[0]] if 45 < bearing < 135 else [-along[1], along[0]])
    rows = [[tuple(6.0 * c * across + 4.0 * k * along) for k in range(11)] for c in range(4)]
    site = planted([("1", bearing, [(str(c + 1), row) for c, row in enumerate(rows)])])
    fit = int(40.0 / apart + 1e-6) + 1
    selector = Spaced(apart_m=apart, count=count, near=TreeIs(tree=str(tree)))
    if count > fit:
        with pytest.raises(PlaceError, match=rf"do not fit beside row .: {fit} (do|does) on its 40 m; ask for at most"):
            points(selector, site)
        return
    found = xy(points(selector, site))
    assert len(found) == (count or fit)
    assert np.hypot(*np.diff(found, axis=0).T) == pytest.approx(apart, abs=1e-6)
    own = (tree - 1) // 11
    offsets = found @ across - 6.0 * own
    assert np.abs(offsets) == pytest.approx(2.4, abs=1e-6)
    if own not in (0, 3):
        assert np.abs(site.xy @ across - found[0] @ across).min() == pytest.approx(2.4, abs=1e-6)
    reach = found @ along
    assert reach.min() >= -1e-6
    assert reach.max() <= 40 + 1e-6
    at = 4.0 * ((tree - 1) % 11)
    assert reach[0] == pytest.approx(0.0 if at <= 20.0 else 40.0, abs=1e-6)


@pytest.mark.parametrize(
    ("near", "east"),
    [((-8.0, -20.0), -2.0), ((1.0, -20.0), 2.4), ((4.0, -20.0), 3.6), ((20.0, -20.0), 20.0), ((17.0, -2.0), 15.6)],
)
def test_a_line_lies_on_the_side_of_whoever_asks_and_half_a_tree_spacing_outside_an_outer_row(near, east):
    found = xy(points(Spaced(apart_m=10.0), orchard(), place_at(*near)))
    assert found[:, 0] == pytest.approx(east, abs=1e-6)


def test_points_have_readable_names_of_their_own_and_are_the_same_again():
    site = orchard(markers={"start": (7.0, 5.0)})
    selector = Spaced(apart_m=15.0, count=3, of=Rows(first="3", last="3"))
    found = points(selector, site)
    assert [p.id for p in found] == [f"15 m point {k} west of row 3" for k in (1, 2, 3)]
    assert points(selector, site) == found
    back = site.projection.metres([p.lat for p in found], [p.lon for p in found])
    assert back == pytest.approx(xy(found), abs=1e-6)


def test_a_keep_out_and_the_boundary_cut_the_line():
    pond = ("pond", "keep_out", [(1, -11), (5, -11), (5, -15), (1, -15)])
    fence = ("fence", "boundary", [(-5, 5), (25, 5), (25, -33), (-5, -33)])
    site = orchard(zones=[pond, fence])
    near = TreeIs(tree="12")
    kept_off = [Polygon(pond[2]), Polygon(fence[2])]
    for count in (2, 3, 0):
        found = points(Spaced(apart_m=7.0, count=count, near=near, of=Rows(first="2", last="2")), site)
        assert len(found) == (count or 5)
        for p in found:
            assert kept_off[0].distance(Point(p.xy)) >= 1.0 - 1e-6
            assert kept_off[1].contains(Point(p.xy))
    beside = Spaced(apart_m=7.0, near=Here())
    assert xy(points(beside, site, place_at(1.9, -8.0)))[:, 1] == pytest.approx([-16.0, -23.0, -30.0])
    told = explain(beside, site, place_context(1.9, -8.0))
    assert any("cut the line beside row 1 into 2 pieces" in note for note in told.notes)


def place_context(x: float, y: float) -> Context:
    return Context(here=place_at(x, y))


@settings(max_examples=40)
@given(
    st.lists(st.tuples(st.integers(-40, 40), st.integers(-40, 40)), min_size=1, max_size=12, unique=True),
    st.floats(1, 30),
    st.integers(1, 8),
)
def test_without_rows_they_are_on_a_straight_line_through_the_trees(trees, apart, count):
    site = without_rows(site_of([(float(x), float(y)) for x, y in trees], markers={"start": (-50.0, 0.0)}))
    hull = MultiPoint(site.xy).convex_hull
    selector = Spaced(apart_m=apart, count=count, near=Marker(name="start"))
    widest = max(math.dist(a, b) for a in site.xy.tolist() for b in site.xy.tolist()) + 2 * site.spacing_m
    if (count - 1) * apart > widest:
        with pytest.raises(PlaceError, match="do not fit through the trees"):
            points(selector, site)
        return
    if (count - 1) * apart > widest / 4:
        return
    found = points(selector, site)
    line = xy(found)
    assert len(found) == count
    if count > 1:
        assert np.hypot(*np.diff(line, axis=0).T) == pytest.approx(apart, abs=1e-6)
        assert np.hypot(*(line[-1] - line[0])) == pytest.approx((count - 1) * apart, abs=1e-6)
    assert all(hull.distance(Point(p.xy)) <= site.spacing_m for p in found)
    assert len({p.id for p in found}) == count


ZONES = [
    [(0, 0), (30, 0), (30, 20), (0, 20)],
    [(0, 0), (30, 0), (30, 20), (0, 20), (0, 15), (25, 15), (25, 5), (0, 5)],  # a C: its middle is not in it
    [(3, 3), (4, 3), (4, 3.5), (3, 3.5)],
]


@settings(max_examples=40)
@given(st.sampled_from(ZONES), st.integers(1, 30), st.booleans())
def test_points_of_a_zone_are_in_it_off_the_trees_clear_of_keep_outs_and_apart(ring, count, pond):
    out = [(10, 8), (14, 8), (14, 18), (10, 18)]
    zones = [("wet", "zone", ring), *([("pond", "keep_out", out)] if pond else [])]
    site = orchard_over_the_zone(zones)
    found = points(PointsIn(zone="Wet", count=count), site)
    assert len({p.id for p in found}) == len(found) == count
    area = Polygon(ring)
    assert all(area.covers(Point(p.xy)) for p in found)
    if pond:
        assert all(Polygon(out).distance(Point(p.xy)) >= 1.0 - 1e-6 for p in found)
    if area.area > 100:
        assert all(min(math.dist(p.xy, t.place.xy) for t in site.trees) >= 1.0 for p in found)
    if count > 1 and area.area > 100:
        share = math.sqrt((area.area - (40 if pond else 0)) / count)
        apart = min(math.dist(a.xy, b.xy) for k, a in enumerate(found) for b in found[:k])
        assert apart >= 0.25 * share
    assert points(PointsIn(zone="Wet", count=count), site) == found


def orchard_over_the_zone(zones) -> Site:
    return planted(
        [("1", 0.0, [(str(c), [(6.0 * c, 24.0 - 4.0 * k) for k in range(9)]) for c in range(7)])], zones=zones
    )


def test_one_point_is_the_middle_of_the_zone_or_the_nearest_place_to_it():
    (middle,) = points(PointsIn(zone="wet"), orchard_over_the_zone([("wet", "zone", [(1, 1), (5, 1), (5, 3), (1, 3)])]))
    assert (middle.id, *middle.xy) == ("the middle of wet", pytest.approx(3.0), pytest.approx(2.0))
    (beside,) = points(PointsIn(zone="wet"), orchard_over_the_zone([("wet", "zone", [(3, 1), (9, 1), (9, 7), (3, 7)])]))
    assert 1.0 <= math.dist(beside.xy, (6.0, 4.0)) <= 1.3  # a tree stands in the middle


def test_points_spread_over_a_square_stand_as_a_person_would_put_them():
    site = orchard_over_the_zone([("far", "zone", [(100, 0), (140, 0), (140, 40), (100, 40)])])
    found = xy(points(PointsIn(zone="far", count=4), site))
    assert sorted(map(tuple, np.round(found - 100 * np.array([1, 0]), -1).tolist())) == [
        (10, 10), (10, 30), (30, 10), (30, 30),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("selector", "says"),
    [
        (Spaced(apart_m=0.0), "points cannot be 0 m apart"),
        (Spaced(apart_m=1.0, count=-1), "too many for one line"),
        (Spaced(apart_m=5.0, zone="nowhere"), "no zone 'nowhere'.*zones are wet, pond"),
        (Spaced(apart_m=15.0, count=9, zone="wet"), "9 points 15 m apart do not fit inside wet: . does on its"),
        (PointsIn(zone="pond"), "pond is a keep-out zone"),
        (PointsIn(zone="wet", count=0), "0 points in a zone"),
        (PointsIn(zone="drowned"), "no room for 1 point in drowned; all of it is inside keep-outs"),
        (Spaced(apart_m=5.0, zone="drowned"), "no free line there"),
    ],
)
def test_points_that_cannot_be_are_said_to_be_so(selector, says):
    zones = [
        ("wet", "zone", [(1, -3), (29, -3), (29, -17), (1, -17)]),
        ("pond", "keep_out", [(40, 0), (60, 0), (60, 20), (40, 20)]),
        ("drowned", "zone", [(45, 5), (50, 5), (50, 10), (45, 10)]),
    ]
    with pytest.raises(PlaceError, match=says):
        points(selector, orchard(zones=zones))


def test_a_line_inside_a_zone_runs_along_the_aisles():
    site = orchard(zones=[("wet", "zone", [(1, -3), (29, -3), (29, -37), (1, -37)])])
    found = xy(points(Spaced(apart_m=8.0, zone="wet"), site, place_at(9.0, -50.0)))
    assert np.ptp(found[:, 0]) == pytest.approx(0.0, abs=1e-6)
    assert np.abs(site.xy[:, 0] - found[0, 0]).min() >= 1.5
    assert found[0, 1] == found[:, 1].min()


WORDS = ("north-west", "north-east", "south-east", "south-west")
FIELD = [
    ("east shed", "zone", [(60, -5), (70, -5), (70, 5), (60, 5)]),
    ("west shed", "zone", [(-70, -5), (-60, -5), (-60, 5), (-70, 5)]),
    ("pond", "keep_out", [(10, -10), (30, -10), (30, 10), (10, 10)]),
]


@settings(max_examples=60, deadline=None)
@given(
    st.tuples(st.floats(-50, 50), st.floats(20, 90)),
    st.tuples(st.floats(-50, 50), st.floats(-90, -20)),
    st.floats(0.5, 60),
    st.integers(1, 12),
)
def test_points_between_two_places_lie_on_the_straight_line_from_one_to_the_other(begin, end, apart, count):
    site = site_of([begin, end])
    start, stop = TreeIs(tree="1"), TreeIs(tree="2")
    length = math.dist(begin, end)
    along = np.subtract(end, begin) / length
    spaced = xy(points(StraightLine(start=start, end=stop, apart_m=apart), site))
    assert len(spaced) == int(length / apart + 1e-6) + 1
    assert spaced == pytest.approx(np.add(begin, np.arange(len(spaced))[:, None] * apart * along), abs=1e-6)
    counted = xy(points(StraightLine(start=start, end=stop, count=count), site))
    wanted = np.linspace(0, length, count) if count > 1 else np.array([length / 2])
    assert counted == pytest.approx(np.add(begin, wanted[:, None] * along), abs=1e-6)


def test_a_line_between_zones_begins_and_ends_at_their_edges_and_leaves_out_what_lies_in_a_keep_out():
    site = site_of([(0.0, 50.0)], zones=FIELD)
    ends = {"start": InZone(zone="west shed"), "end": InZone(zone="east shed")}
    selector = StraightLine(apart_m=10.0, **ends)
    found = xy(points(selector, site))
    assert found[:, 0].tolist() == pytest.approx([-60, -50, -40, -30, -20, -10, 0, 9, 31, 40, 50, 60], abs=1e-6)
    assert "1 point of the line is left out" in str(explain(selector, site, at_start(site)))
    named = points(selector, site)
    assert [named[0].id, named[-1].id] == [f"point {k} of 12 from west shed to east shed" for k in (1, 12)]


@pytest.mark.parametrize(
    ("start", "end", "more", "says"),
    [
        (TreeIs(tree="1"), TreeIs(tree="1"), {"apart_m": 5.0}, "they are at the same place; name two places"),
        (TreeIs(tree="1"), Rows(), {"apart_m": 5.0}, "only one is allowed here"),
        (TreeIs(tree="1"), TreeIs(tree="9"), {}, "0 points 0 m apart on a line are not possible"),
        (TreeIs(tree="1"), TreeIs(tree="9"), {"apart_m": -2.0}, "not possible"),
        (TreeIs(tree="1"), TreeIs(tree="9"), {"apart_m": math.inf}, "not possible"),
        (TreeIs(tree="1"), TreeIs(tree="9"), {"apart_m": 1e-6}, "not possible"),
        (TreeIs(tree="1"), TreeIs(tree="9"), {"apart_m": 5.0, "count": 3}, "a number or a distance, not both"),
    ],
)
def test_lines_that_cannot_be_are_said_to_be_so(start, end, more, says):
    with pytest.raises(PlaceError, match=says):
        points(StraightLine(start=start, end=end, **more), orchard())


@settings(max_examples=40, deadline=None)
@given(st.floats(10, 80), st.floats(10, 80), st.floats(-40, 40), st.booleans())
def test_corners_of_ground_lie_inside_a_zone_and_outside_a_keep_out_near_its_corners(wide, high, turned, out):
    shape = affinity.rotate(box(-wide / 2, -high / 2, wide / 2, high / 2), turned)
    kind = "keep_out" if out else "zone"
    site = site_of([(0.0, 200.0)], zones=[("plot", kind, shape)])
    found = points(Corners(zone="plot"), site)
    assert [place.id for place in found] == [f"{name} corner of plot" for name in WORDS]
    corners = [Point(xy) for xy in shape.exterior.coords[:-1]]
    for place in found:
        at = Point(place.xy)
        assert shape.contains(at) != out
        assert min(at.distance(corner) for corner in corners) < 3.0
    assert len({round(place.xy[0], 3) for place in found}) >= 2
    (one,) = points(Corners(which=("nw",), zone="plot"), site)
    assert one.xy == pytest.approx(found[0].xy)


def test_corners_without_free_ground_are_an_error():
    zones = [("moor", "zone", [(0, 0), (50, 0), (50, 50), (0, 50)])]
    zones.append(("lake", "keep_out", [(-300, -300), (300, -300), (300, 300), (-300, 300)]))
    with pytest.raises(PlaceError, match="no free ground in a corner of moor"):
        points(Corners(zone="moor"), site_of([(0.0, 400.0)], zones=zones))
    with pytest.raises(PlaceError, match="no zone 'nowhere'"):
        points(Corners(zone="nowhere"), orchard(zones=zones))


STEPS = {"north": (0, 1), "east": (1, 0), "south": (0, -1), "west": (-1, 0)}


@settings(max_examples=40, deadline=None)
@given(st.floats(0.5, 80), st.sampled_from(sorted(STEPS)), st.tuples(st.floats(-50, 50), st.floats(20, 90)))
def test_a_point_at_a_distance_lies_that_far_to_that_side(metres, side, tree):
    (found,) = points(PointAt(metres=metres, towards=side, origin=TreeIs(tree="1")), site_of([tree]))
    assert found.xy == pytest.approx(np.add(tree, np.multiply(metres, STEPS[side])), abs=1e-6)


def test_a_point_at_a_distance_from_a_zone_is_measured_from_its_edge():
    site = site_of([(0.0, 50.0)], zones=FIELD)
    found = {side: points(PointAt(metres=4.0, towards=side, origin=InZone(zone="pond")), site)[0] for side in STEPS}
    assert {side: place.xy for side, place in found.items()} == {
        "north": pytest.approx((20, 14), abs=1e-6),
        "east": pytest.approx((34, 0), abs=1e-6),
        "south": pytest.approx((20, -14), abs=1e-6),
        "west": pytest.approx((6, 0), abs=1e-6),
    }
    assert found["east"].id == "4 m east of pond"


@pytest.mark.parametrize(
    ("selector", "says"),
    [
        (PointAt(metres=0.0, towards="north", origin=TreeIs(tree="1")), "0 m away is not possible"),
        (PointAt(metres=math.inf, towards="north", origin=TreeIs(tree="1")), "is not possible"),
        (PointAt(metres=20.0, towards="east", origin=TreeIs(tree="1")), "inside a keep-out or outside the boundary"),
        (Transect(count=1, shape="edge", zone="pond", part="nw"), "no part of this edge faces that side"),
        (Transect(count=1, shape="edge", zone="pond", off_m=-2.0), "cannot lie -2 m from an edge"),
        (Transect(count=1, shape="edge", off_m=-2.0), "cannot lie -2 m from an edge"),
    ],
)
def test_points_beside_places_that_cannot_be_are_said_to_be_so(selector, says):
    with pytest.raises(PlaceError, match=says):
        points(selector, site_of([(0.0, 0.0)], zones=FIELD))


def test_one_side_of_an_edge_is_inside_of_a_zone_and_outside_of_a_keep_out():
    site = site_of([(0.0, 50.0)], zones=FIELD)
    (north,) = points(Transect(count=1, shape="edge", zone="pond", part="north"), site)
    (south,) = points(Transect(count=1, shape="edge", zone="east shed", part="south"), site)
    assert (north.xy, south.xy) == (pytest.approx((20, 11.5), abs=0.1), pytest.approx((65, -3.5), abs=0.1))
    west = xy(points(Transect(apart_m=5.0, shape="edge", zone="pond", part="west"), site))
    assert len(west) == 4
    assert west[:, 0].max() <= 10.0


def test_a_point_beside_a_zone_is_outside_of_it():
    site = site_of([(0.0, 50.0)], zones=FIELD)
    (found,) = points(Transect(count=1, shape="edge", zone="east shed", off_m=-1.5), site)
    assert box(60, -5, 70, 5).distance(Point(found.xy)) == pytest.approx(1.5, abs=0.05)
