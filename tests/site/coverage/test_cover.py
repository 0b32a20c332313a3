"""Test coverage plans of open ground: everything outside the headlands is covered, by a drive that stays inside."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.affinity import rotate
from shapely.geometry import LineString, MultiPolygon, Point, Polygon, box

from fieldhand.errors import PlaceError
from fieldhand.site.coverage.cover import cover
from fieldhand.site.coverage.plan import CoverageParams, CoveragePlan
from support.examples import examples
from support.sites.coverage import is_connected, uncovered_m2
from support.sites.fields import fields

RECTANGLE = box(0.0, 0.0, 100.0, 60.0)
L_SHAPE = Polygon([(0, 0), (90, 0), (90, 20), (20, 20), (20, 90), (0, 90)])
POND = Polygon([(0, 0), (100, 0), (110, 60), (5, 70)]).difference(Point(50, 30).buffer(12))


def stays_inside(plan: CoveragePlan, area: Polygon) -> bool:
    around = area.buffer(1e-5)
    return all(around.covers(leg.line) for leg in plan.legs)


@settings(max_examples=examples(10, thorough=150), deadline=None)
@given(fields(), st.floats(1.5, 8.0), st.integers(1, 3), st.floats(0.0, 0.2))
def test_everything_outside_the_headlands_is_covered(area: Polygon, width: float, passes: int, overlap: float) -> None:
    plan = cover(area, CoverageParams(working_width_m=width, headland_passes=passes, overlap_m=overlap * width))
    if plan.headlands:
        assert uncovered_m2(plan, width) < 1e-3
        assert plan.covered_share == pytest.approx(1.0, abs=1e-6)
    assert is_connected(plan)
    assert stays_inside(plan, area)
    assert sorted(leg.swath for leg in plan.legs if leg.kind == "swath") == list(range(len(plan.swaths)))


@settings(max_examples=examples(4, thorough=60), deadline=None)
@given(fields(holes=1), st.floats(2.0, 5.0), st.floats(1.0, 6.0))
def test_turns_keep_the_turning_radius_and_stay_inside(area: Polygon, width: float, radius: float) -> None:
    plan = cover(area, CoverageParams(working_width_m=width, headland_passes=3, turning_radius_m=radius))
    assert is_connected(plan)
    assert stays_inside(plan, area)
    for before, leg, after in zip(plan.legs, plan.legs[1:], plan.legs[2:], strict=False):
        if leg.works or leg.is_tight:
            continue
        at = np.array([before.points[-2], *leg.points, after.points[1]])
        steps = np.diff(at, axis=0)
        steps = steps[np.hypot(*steps.T) > 1e-6]
        angles = np.arctan2(steps[:, 1], steps[:, 0])
        turned = np.abs((np.diff(angles) + np.pi) % (2.0 * np.pi) - np.pi)
        # Chords of up to 10 degrees: the direction changes by no more than a chord's angle at any of its ends.
        assert turned.max(initial=0.0) < np.radians(10.5)


@settings(max_examples=examples(3, thorough=40), deadline=None)
@given(fields(), st.floats(0.0, 360.0), st.floats(2.0, 6.0))
def test_the_plan_of_a_turned_field_is_as_good(area: Polygon, turn: float, width: float) -> None:
    params = CoverageParams(working_width_m=width)
    one, two = (cover(field, params) for field in (area, rotate(area, turn, origin=(0.0, 0.0))))
    # Of plans that are equally good, rounding decides.
    assert two.length_m == pytest.approx(one.length_m, rel=0.1, abs=10.0 * width)
    assert two.covered_share == pytest.approx(one.covered_share, abs=0.01)
    assert two.covered_m2 == pytest.approx(one.covered_m2, rel=0.02)


@settings(max_examples=examples(2, thorough=30), deadline=None)
@given(fields(), st.floats(2.0, 6.0))
def test_the_same_field_has_the_same_plan(area: Polygon, width: float) -> None:
    params = CoverageParams(working_width_m=width)
    assert cover(area, params).legs == cover(shapely.from_wkb(area.wkb), params).legs


@settings(max_examples=examples(5, thorough=60), deadline=None)
@given(fields(), st.floats(2.0, 6.0))
def test_overlap_is_bounded(area: Polygon, width: float) -> None:
    plan = cover(area, CoverageParams(working_width_m=width))
    # At most half a working width along every edge: of the area, the headland and each cell.
    edges = area.length + plan.inside.length + sum(cell.polygon.length for cell in plan.cells)
    assert plan.overlap_m2 < edges * width


def test_a_rectangle_has_no_overlap_and_one_swath_per_width() -> None:
    plan = cover(RECTANGLE, CoverageParams(working_width_m=3.0))
    assert len(plan.swaths) == 18
    assert len(plan.cells) == 1
    assert plan.cells[0].bearing_deg == pytest.approx(90.0)
    assert plan.overlap_m2 == pytest.approx(0.0, abs=1e-6)
    # Every swath is entered right beside where the one before it ends; the first one from the end of the headland.
    assert plan.transit_m == pytest.approx(17 * 3.0 + np.hypot(1.5, 3.0))


def test_an_l_shape_is_driven_along_both_of_its_arms() -> None:
    plan = cover(L_SHAPE, CoverageParams(working_width_m=3.0))
    assert sorted(round(cell.bearing_deg) % 180 for cell in plan.cells) == [0, 90]
    along_one_arm = cover(L_SHAPE, CoverageParams(working_width_m=3.0, bearing_deg=0.0))
    assert plan.length_m < along_one_arm.length_m


def test_a_given_bearing_is_kept() -> None:
    plan = cover(POND, CoverageParams(working_width_m=4.0, bearing_deg=30.0))
    for swath in plan.swaths:
        (east, north), *_ = np.diff(np.array(swath.points), axis=0).tolist()
        assert np.degrees(np.arctan2(east, north)) % 180.0 == pytest.approx(30.0, abs=1e-6)
    assert plan.covered_share == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("first", [True, False])
def test_the_headland_is_worked_on_first_or_last(first: bool) -> None:
    plan = cover(POND, CoverageParams(working_width_m=4.0, headland_first=first))
    kinds = [leg.kind for leg in plan.legs if leg.works]
    assert kinds == sorted(kinds, key=lambda kind: (kind == "swath") == first)
    assert len(plan.headlands) == 2  # around the field, and around the pond


def test_a_headland_only_for_turning_is_not_worked_on() -> None:
    plan = cover(POND, CoverageParams(working_width_m=4.0, headland_passes=0, headland_m=6.0))
    assert plan.headlands == ()
    assert plan.inside.area < POND.area
    assert plan.covered_share == pytest.approx(1.0, abs=1e-6)
    assert plan.missed == ()


def test_without_headlands_a_rectangle_is_covered_from_edge_to_edge() -> None:
    plan = cover(RECTANGLE, CoverageParams(working_width_m=3.0, headland_passes=0))
    assert plan.covered_share == pytest.approx(1.0, abs=1e-9)
    assert plan.length_m == pytest.approx(20 * 100.0 + 19 * 3.0)


def test_without_headlands_what_cannot_be_reached_is_missed() -> None:
    triangle = Polygon([(0, 0), (80, 0), (20, 60)])
    plan = cover(triangle, CoverageParams(working_width_m=3.0, headland_passes=0))
    assert stays_inside(plan, triangle)
    assert plan.missed_m2 == pytest.approx(triangle.area * (1.0 - plan.covered_share), rel=1e-6)
    assert 0.95 < plan.covered_share < 1.0


@pytest.mark.parametrize("side", [0.3, 1.0, 2.9])
def test_an_area_narrower_than_the_implement_is_one_swath(side: float) -> None:
    plan = cover(box(0.0, 0.0, 40.0, side), CoverageParams(working_width_m=3.0))
    assert len(plan.swaths) == 1
    assert plan.covered_share == pytest.approx(1.0)
    assert plan.length_m == pytest.approx(40.0)


def test_a_start_and_a_goal_choose_the_ends_of_the_drive() -> None:
    params = CoverageParams(working_width_m=3.0, headland_passes=0)
    plan = cover(RECTANGLE, params, start=(100.0, 60.0), goal=(0.0, 0.0))
    assert np.hypot(plan.legs[0].points[0][0] - 100.0, plan.legs[0].points[0][1] - 60.0) < 3.0
    assert plan.legs[-1].points[-1][1] < 3.0


def test_a_wide_turn_skips_swaths() -> None:
    plan = cover(RECTANGLE, CoverageParams(working_width_m=3.0, headland_passes=4, turning_radius_m=6.0))
    first = next(k for k, leg in enumerate(plan.legs) if leg.kind == "swath")
    assert not any(leg.is_tight for leg in plan.legs[first:])
    norths = [swath.points[0][1] for swath in plan.swaths]
    assert min(abs(b - a) for a, b in itertools.pairwise(norths)) > 3.5


def test_two_fields_need_a_way_between_them() -> None:
    both = MultiPolygon([box(0.0, 0.0, 30.0, 30.0), box(50.0, 0.0, 80.0, 30.0)])
    params = CoverageParams(working_width_m=3.0)
    with pytest.raises(PlaceError, match="no way"):
        cover(both, params)
    plan = cover(both, params, ground=both.union(box(29.0, 10.0, 51.0, 14.0)))
    assert plan.covered_share == pytest.approx(1.0, abs=1e-6)
    assert plan.transit_m > 20.0


@pytest.mark.parametrize(
    "change",
    [
        {"working_width_m": 0.0},
        {"working_width_m": float("nan")},
        {"overlap_m": 3.0},
        {"overlap_m": -0.1},
        {"turning_radius_m": -1.0},
        {"headland_passes": -1},
        {"headland_m": -2.0},
        {"headland_m": float("nan")},
        {"bearing_deg": float("inf")},
        {"working_width_m": 0.01},  # more swaths than a plan can have
    ],
)
def test_parameters_out_of_range_are_errors(change: dict[str, float]) -> None:
    with pytest.raises(PlaceError):
        cover(RECTANGLE, replace(CoverageParams(working_width_m=3.0), **change))


@pytest.mark.parametrize("area", [Polygon(), Polygon([(0, 0), (10, 10), (10, 0), (0, 10)])], ids=["empty", "bow tie"])
def test_an_impossible_area_is_an_error(area: Polygon) -> None:
    with pytest.raises(PlaceError):
        cover(area, CoverageParams(working_width_m=3.0))


def test_the_line_of_a_swath_is_its_points() -> None:
    plan = cover(RECTANGLE, CoverageParams(working_width_m=3.0))
    assert plan.swaths[0].line.equals(LineString(plan.swaths[0].points))
    assert plan.working_m == pytest.approx(sum(leg.length_m for leg in plan.legs if leg.works))
