"""Test fences and other barrier lines, which robots cross only at gates."""

from __future__ import annotations

import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import DriveFault
from fieldhand.site.drives import Drives
from support.sites.gisfiles import degrees, line
from support.sites.points import area, point, read

LON, LAT = -120.42, 37.26


@pytest.mark.parametrize("kind", ["fence", "Stone wall", "hedge", "drainage ditch", "canal", "water_pipe", "no-go"])
def test_a_barrier_line_becomes_a_thin_keep_out(kind):
    site = read(point(LON, LAT), line((-10, 5), (10, 5), kind=kind))
    (zone,) = site.zones
    assert zone.kind == "keep_out"
    assert zone.polygon.area == pytest.approx(20 * 0.1, rel=0.01)
    assert site.notes == ()


@settings(max_examples=40, deadline=None)
@given(st.floats(1.0, 12.0), st.floats(-30.0, 30.0), st.floats(-1.5, 1.5))
def test_a_gate_opens_its_fence_by_its_width(width, along, beside):
    (gate,) = degrees((along, 5.0 + beside))
    site = read(
        point(LON, LAT), line((-50, 5), (50, 5), kind="fence"), point(*gate, kind="gate", name="main", width_m=width)
    )
    assert [(g.place.id, g.width_m) for g in site.gates] == [("main", width)]
    left, right = sorted((z.polygon for z in site.zones), key=lambda p: p.centroid.x)
    assert left.distance(right) == pytest.approx(width, abs=0.01)
    assert left.area + right.area == pytest.approx((100 - width) * 0.1, rel=0.01)


def test_a_fence_drawn_as_a_ring_opens_at_its_seam_too():
    ring = [(-20, -20), (20, -20), (20, 20), (-20, 20), (-20, -20)]
    closed = read(point(LON, LAT), line(*ring, kind="fence"))
    assert [len(z.polygon.interiors) for z in closed.zones] == [1]
    (corner,) = degrees((-20, -20))
    opened = read(point(LON, LAT), line(*ring, kind="fence"), point(*corner, kind="gate", width=2))
    assert not any(z.polygon.interiors or z.polygon.contains(shapely.Point(-20, -20)) for z in opened.zones)


@pytest.mark.parametrize(("said", "width"), [({}, 4.0), ({"width": "3,5 m"}, 3.5), ({"Width (m)": 6}, 6.0)])
def test_a_gate_without_a_width_has_a_usual_one(said, width):
    site = read(point(LON, LAT), point(LON, LAT + 1e-4, kind="farm gate", **said))
    assert [(g.place.id, g.width_m) for g in site.gates] == [("gate 1", width)]
    assert len(site.trees) == 1


def test_a_gate_far_from_every_fence_is_noted():
    (far,) = degrees((0, 60))
    site = read(point(LON, LAT), line((-10, 5), (10, 5), kind="fence"), point(*far, kind="gate", name="north gate"))
    assert "'north gate' is not on a fence" in site.notes[0]


@pytest.mark.parametrize(("width", "through"), [(None, False), (0.5, False), (1.0, True), (4.0, True)])
def test_a_robot_crosses_a_fence_only_at_a_wide_enough_gate(width, through):
    """The fence spans the field from boundary to boundary; the robot is 0.7 m wide."""
    field = degrees((-60, -40), (60, -40), (60, 40), (-60, 40), (-60, -40))
    gate = [] if width is None else [point(*degrees((30, 0))[0], kind="gate", width_m=width)]
    site = read(
        *(point(*degrees((x, y))[0], row=x) for x in (-6, 0, 6) for y in (-20, -15, -10, 10, 15, 20)),
        area(field, kind="boundary"),
        line((-60, 0), (60, 0), kind="fence"),
        *gate,
    )
    drives, south, north = Drives(site, 0.35, 1.5), site.trees[0].place, site.trees[5].place
    if not through:
        with pytest.raises(DriveFault, match="fence"):
            drives.between(south, north)
        return
    way = shapely.LineString(drives.between(south, north).points)
    assert not any(way.intersects(zone.polygon) for zone in site.zones_of("keep_out"))
    crossing = way.intersection(shapely.LineString([(-100, site.gates[0].place.y), (100, site.gates[0].place.y)]))
    assert abs(crossing.centroid.x - site.gates[0].place.x) <= width / 2


@pytest.mark.parametrize("barrier", ["boundary", "fence"])
def test_a_robot_drives_to_a_gate_and_keeps_off_the_fence_beside_it(barrier):
    """The gate lies on its fence; the robot stops at the gate on ground with enough room."""
    (gate,) = degrees((-60, 10) if barrier == "boundary" else (30, 0))
    site = read(
        *(point(*degrees((x, y))[0], row=x) for x in (-6, 0, 6) for y in (-20, -15, -10, 10, 15, 20)),
        area(degrees((-60, -40), (60, -40), (60, 40), (-60, 40), (-60, -40)), kind="boundary"),
        *([line((-60, 0), (60, 0), kind="fence")] if barrier == "fence" else []),
        point(*gate, kind="gate", name="gate"),
    )
    drives, place = Drives(site, 0.35, 1.5), site.gates[0].place
    assert drives.problem(place) == ""
    drive = drives.between(site.trees[0].place, place)
    end = shapely.Point(drive.points[-1])
    assert end.distance(shapely.Point(place.xy)) < 1.0
    (boundary,) = (z.polygon for z in site.zones_of("boundary"))
    assert boundary.contains(end)
    assert boundary.exterior.distance(end) >= 0.35 - 1e-6
    assert all(z.polygon.distance(end) >= 0.35 - 1e-6 for z in site.zones_of("keep_out"))


def test_a_gate_far_outside_the_boundary_cannot_be_driven_to():
    (gate,) = degrees((-80, 10))
    site = read(
        *(point(*degrees((x, y))[0], row=x) for x in (-6, 0, 6) for y in (-20, -15, -10, 10, 15, 20)),
        area(degrees((-60, -40), (60, -40), (60, 40), (-60, 40), (-60, -40)), kind="boundary"),
        point(*gate, kind="gate", name="gate"),
    )
    assert Drives(site, 0.35, 1.5).problem(site.gates[0].place) == "outside the boundary"
