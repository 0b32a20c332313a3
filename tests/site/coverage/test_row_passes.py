"""Test coverage plans of planted areas: all aisles are covered, and no row is crossed."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString, MultiPoint, Polygon, box

from fieldhand.errors import PlaceError
from fieldhand.site.coverage.plan import CoverageParams, CoveragePlan
from fieldhand.site.coverage.row_passes import cover_rows
from fieldhand.site.drives import Drives
from fieldhand.site.model import Site
from support.examples import examples
from support.sites.coverage import is_connected, uncovered_m2
from support.sites.planted import generated, planted, upright

CLEARANCE, STANDOFF = 0.35, 1.5


def outline(site: Site, around_m: float = 8.0) -> Polygon:
    return MultiPoint(site.xy).convex_hull.buffer(around_m)


def plan_of(site: Site, area: Polygon, params: CoverageParams, **more) -> CoveragePlan:
    return cover_rows(Drives(site, CLEARANCE, STANDOFF).layout, area, params, **more)


def crossed_rows(plan: CoveragePlan, site: Site) -> list[str]:
    """Return the rows whose line of plants a leg crosses."""
    legs = shapely.STRtree([leg.line for leg in plan.legs])
    rows = [row for row in site.planting.rows if len(row.trees) > 1]
    return [row.name for row in rows if len(legs.query(LineString(site.xy[row.trees]), predicate="intersects"))]


@settings(max_examples=examples(12, thorough=120), deadline=None)
@given(st.integers(0, 10_000), st.floats(0.8, 6.0), st.sampled_from([0.0, 2.5]))
def test_no_leg_crosses_a_row(seed: int, width: float, radius: float) -> None:
    site = generated(seed)
    try:
        plan = plan_of(site, outline(site), CoverageParams(working_width_m=width, turning_radius_m=radius))
    except PlaceError:
        assume(False)
    assert crossed_rows(plan, site) == []
    assert is_connected(plan)
    free = Drives(site, CLEARANCE, STANDOFF).layout.free
    assert not free.bounded or all(free.covers(leg.line, soft=False)[0] for leg in plan.legs)


@pytest.mark.parametrize(("width", "passes"), [(6.0, 1), (5.0, 2), (3.0, 2), (2.5, 3), (1.5, 4)])
def test_an_aisle_gets_as_many_passes_as_its_width_needs(width: float, passes: int) -> None:
    site = upright(5, 12)
    plan = plan_of(site, box(-0.5, -9.0, 24.5, 53.0), CoverageParams(working_width_m=width))
    inner = [cell for cell, polygon in enumerate(plan.cells) if polygon.polygon.area > 100.0]
    assert len(inner) == 4
    for cell in inner:
        assert sum(swath.cell == cell for swath in plan.swaths) == passes
    ground = shapely.union_all([plan.cells[cell].polygon for cell in inner])
    assert ground.difference(plan.covered.buffer(1e-6)).area < 1e-6


@pytest.mark.parametrize("width", [6.1, 2.2])
def test_curved_aisles_are_followed(width: float) -> None:
    along = np.arange(0.0, 80.0, 4.0)
    rows = [np.column_stack([k * 6.0 + 0.004 * (along - 40.0) ** 2, along]) for k in range(5)]
    site = planted([(0.0, rows)])
    plan = plan_of(site, outline(site), CoverageParams(working_width_m=width))
    assert crossed_rows(plan, site) == []
    assert all(len(swath.points) > 3 for swath in plan.swaths)
    inner = shapely.union_all([cell.polygon for cell in plan.cells][1:-1])
    # The passes keep their width across the aisle, which the aisle has along its axis.
    assert inner.intersection(plan.covered).area > 0.995 * inner.area


def test_the_outer_sides_of_a_block_are_worked_on_where_the_area_reaches() -> None:
    site = upright(3, 10)
    params = CoverageParams(working_width_m=2.0)
    assert len(plan_of(site, box(-8.0, -8.0, 20.0, 44.0), params).cells) == 4
    assert len(plan_of(site, box(0.0, -8.0, 12.0, 44.0), params).cells) == 2


def test_only_the_part_of_an_aisle_in_the_area_is_worked_on() -> None:
    site = upright(4, 20)
    plan = plan_of(site, box(-8.0, 10.0, 30.0, 50.0), CoverageParams(working_width_m=6.0))
    for swath in plan.swaths:
        assert swath.line.bounds[1] == pytest.approx(10.0, abs=1e-3)
        assert swath.line.bounds[3] == pytest.approx(50.0, abs=1e-3)


def test_the_number_of_passes_can_be_given() -> None:
    site = upright(4, 10)
    area = box(0.0, -8.0, 18.0, 44.0)
    plan = plan_of(site, area, CoverageParams(working_width_m=2.0, passes_per_aisle=1))
    assert len(plan.swaths) == 3
    assert plan.covered_share == pytest.approx(2.0 / 6.0, rel=1e-3)
    assert plan.missed_m2 == pytest.approx(plan.inside.area - plan.covered_m2, rel=1e-3)


def test_a_gap_to_the_plants_is_not_part_of_the_ground() -> None:
    site = upright(3, 10)
    area = box(0.0, -8.0, 12.0, 44.0)
    plan = plan_of(site, area, CoverageParams(working_width_m=2.0, row_gap_m=0.5))
    assert plan.inside.area == pytest.approx(2 * 5.0 * 36.0)
    assert plan.covered_share == pytest.approx(1.0, abs=1e-6)
    assert uncovered_m2(plan, 2.0) < 1e-3


def test_a_turning_robot_skips_aisles() -> None:
    site = upright(8, 15, across=3.0)
    params = CoverageParams(working_width_m=3.0, turning_radius_m=4.0)
    plan = plan_of(site, outline(site, 20.0), params)
    assert crossed_rows(plan, site) == []
    assert plan.tight_turns == 0


def test_an_area_without_aisles_is_an_error() -> None:
    site = upright(3, 10)
    with pytest.raises(PlaceError, match="no aisle"):
        plan_of(site, box(100.0, 100.0, 120.0, 120.0), CoverageParams(working_width_m=2.0))


def test_aisles_too_narrow_for_the_robot_are_missed() -> None:
    rows = [np.column_stack([np.full(10, east), np.arange(10) * 3.0]) for east in (0.0, 4.0, 4.5, 8.5)]
    site = planted([(0.0, rows)])
    plan = plan_of(site, box(0.0, -8.0, 8.5, 36.0), CoverageParams(working_width_m=4.0))
    assert len(plan.swaths) == 2
    assert plan.missed_m2 == pytest.approx(0.5 * 27.0, rel=1e-3)


def test_no_passes_are_an_error() -> None:
    site = upright(3, 10)
    with pytest.raises(PlaceError, match="at least one pass"):
        plan_of(site, outline(site), CoverageParams(working_width_m=2.0, passes_per_aisle=0))
