"""Test drives around areas, and patrols along rings and lines."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import LinearRing, LineString, Point, Polygon, box

from fieldhand.errors import PlaceError
from fieldhand.site.coverage.circuits import Circuit, patrol, perimeter
from fieldhand.site.coverage.ground import OpenGround
from support.sites.fields import fields

RECTANGLE = box(0.0, 0.0, 100.0, 60.0)
POND = RECTANGLE.difference(Point(50.0, 30.0).buffer(10.0))


def is_connected(circuit: Circuit) -> bool:
    return all(np.hypot(*np.subtract(a.points[-1], b.points[0])) < 1e-6 for a, b in itertools.pairwise(circuit.legs))


@settings(max_examples=25, deadline=None)
@given(fields(), st.floats(0.2, 2.0), st.booleans())
def test_a_perimeter_keeps_its_distance_and_its_direction(area: Polygon, inset: float, clockwise: bool) -> None:
    around = perimeter(area, inset, holes=True, clockwise=clockwise)
    assert is_connected(around)
    for leg in around.legs:
        if leg.works:
            assert leg.line.is_ring
            assert LinearRing(leg.points).is_ccw != clockwise
            assert leg.line.distance(area.boundary) == pytest.approx(inset, rel=0.01)


def test_a_perimeter_goes_around_holes_only_if_asked() -> None:
    assert sum(leg.works for leg in perimeter(POND, 1.0).legs) == 1
    assert sum(leg.works for leg in perimeter(POND, 1.0, holes=True).legs) == 2


def test_rings_go_inwards() -> None:
    around = perimeter(RECTANGLE, 1.5, rings=3, apart_m=3.0)
    assert [leg.length_m for leg in around.legs if leg.works] == pytest.approx([308.0, 284.0, 260.0])
    assert is_connected(around)


def test_a_perimeter_begins_near_its_start() -> None:
    around = perimeter(RECTANGLE, 2.0, start=(50.0, -7.0))
    assert around.legs[0].points[0] == pytest.approx((50.0, 2.0))
    assert around.working_m == pytest.approx(2 * (96.0 + 56.0))


def test_a_drive_between_rings_goes_around_a_hole() -> None:
    outer = [(1.0, 30.0), (5.0, 30.0), (5.0, 31.0), (1.0, 30.0)]
    inner = [(99.0, 30.0), (95.0, 30.0), (95.0, 31.0), (99.0, 30.0)]
    way = patrol([outer, inner], ground=OpenGround(POND)).legs[1]
    assert way.kind == "transit"
    assert POND.buffer(1e-5).covers(way.line)
    assert len(way.points) > 2


def test_a_line_is_patrolled_there_and_back() -> None:
    rounds = patrol([[(0.0, 0.0), (10.0, 0.0)]], laps=3, start=(9.0, 1.0))
    there, back = ((10.0, 0.0), (0.0, 0.0)), ((0.0, 0.0), (10.0, 0.0))
    assert [leg.points for leg in rounds.legs] == [there, back, there]
    assert rounds.transit_m == 0.0


@given(st.integers(1, 4), st.integers(1, 3))
def test_every_line_is_driven_once_in_each_lap(laps: int, count: int) -> None:
    lines = [[(0.0, 10.0 * k), (30.0, 10.0 * k), (40.0, 10.0 * k + 5.0)] for k in range(count)]
    rounds = patrol(lines, laps=laps)
    assert is_connected(rounds)
    driven = [leg.line for leg in rounds.legs if leg.works]
    assert len(driven) == laps * count
    assert all(LineString(line).equals(driven[k]) for k, line in enumerate(lines * laps))


def test_an_area_too_narrow_for_a_ring_is_an_error() -> None:
    with pytest.raises(PlaceError, match="too narrow for a drive 40 m"):
        perimeter(RECTANGLE, 40.0)
    with pytest.raises(PlaceError, match="too narrow"):
        perimeter(RECTANGLE, 10.0, rings=4, apart_m=10.0)


@pytest.mark.parametrize("change", [{"inset_m": -1.0}, {"inset_m": 1.0, "rings": 0}, {"inset_m": 1.0, "rings": 2}])
def test_a_perimeter_out_of_range_is_an_error(change: dict[str, float]) -> None:
    with pytest.raises(PlaceError):
        perimeter(RECTANGLE, **change)


@pytest.mark.parametrize(
    "lines", [[], [[(1.0, 1.0)]], [[(1.0, 1.0), (1.0, 1.0)]]], ids=["none", "a point", "no length"]
)
def test_a_patrol_without_a_line_is_an_error(lines: list[list[tuple[float, float]]]) -> None:
    with pytest.raises(PlaceError):
        patrol(lines)
