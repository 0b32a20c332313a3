"""Stretches along rows and through aisles: where they run, where the implement is on, and in which direction."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import PlaceError
from fieldhand.forecast.visit_order import drives_for
from fieldhand.site.model import Site
from fieldhand.site.working.order import in_order
from fieldhand.site.working.stretch import Stretch, joined, total_m
from fieldhand.site.working.units import AisleWork, RowWork, WorkUnit, aisle_units, pass_offsets, row_units
from support.missions.rig import orchard
from support.missions.working import gappy, tractor

DEMO = Site.demo()


def trees_of(site: Site, *rows: int) -> list[int]:
    return [k for k in range(len(site.trees)) if site.planting.row_of[k] in rows]


def only(unit: WorkUnit) -> Stretch:
    ((stretch,),) = unit.options[:1]
    return stretch


def test_a_row_is_worked_from_its_first_to_its_last_tree_on_either_side() -> None:
    site = orchard()
    (unit,) = row_units(drives_for(site, tractor()), trees_of(site, 0), RowWork())
    assert [s.name for (s,) in unit.options] == ["row r3, north side", "row r3, south side"]
    for (stretch,) in unit.options:
        assert stretch.length_m == pytest.approx(20.0, abs=0.1)
        assert stretch.on == ((0.0, pytest.approx(20.0, abs=0.1)),)
        away = [shapely.LineString(stretch.points).distance(shapely.Point(x, 15.0)) for x in (0, 5, 10, 15, 20)]
        assert away == pytest.approx([tractor().standoff_m] * 5, abs=0.02)


def test_only_the_trees_selected_are_worked_along() -> None:
    site = orchard()
    few = [site.by_id[name].index for name in ("r0c1", "r0c2", "r0c3")]
    (unit,) = row_units(drives_for(site, tractor()), few, RowWork(sides="north"))
    assert only(unit).length_m == pytest.approx(10.0, abs=0.1)


@pytest.mark.parametrize(("gaps_on", "on_m"), [(False, 15.0), (True, 20.0)])
def test_the_implement_is_off_in_a_gap_unless_told_otherwise(gaps_on: bool, on_m: float) -> None:
    site = gappy()
    row = site.planting.row_of[site.by_id["r1c0"].index]
    (unit,) = row_units(drives_for(site, tractor()), trees_of(site, int(row)), RowWork(gaps_on=gaps_on))
    stretch = only(unit)
    assert stretch.length_m == pytest.approx(20.0, abs=0.1)
    assert stretch.on_m == pytest.approx(on_m, abs=0.1)


def test_both_sides_are_two_units_and_a_side_is_that_of_the_compass() -> None:
    site, drives = orchard(), drives_for(orchard(), tractor())
    both = row_units(drives, trees_of(site, 1), RowWork(sides="both"))
    assert [only(unit).name for unit in both] == ["row r2, north side", "row r2, south side"]
    (south,) = row_units(drives, trees_of(site, 1), RowWork(sides="south"))
    assert all(y < 10.0 for _, y in only(south).points)
    with pytest.raises(PlaceError, match="row r2 has no west side; its sides are north and south"):
        row_units(drives, trees_of(site, 1), RowWork(sides="west"))


@pytest.mark.parametrize("mounted", ["left", "right"])
def test_a_row_is_on_the_side_of_the_implement(mounted: str) -> None:
    units = row_units(drives_for(DEMO, tractor()), trees_of(DEMO, 1, 2, 3), RowWork(mounted=mounted))  # type: ignore[arg-type]
    for unit in units:
        for option in unit.options:
            for stretch in option:
                assert stretch.one_way
                (ax, ay), (bx, by) = stretch.begin, stretch.end
                name = stretch.name.split(",")[0].removeprefix("row ")
                (row,) = (r for r in DEMO.planting.rows if r.name == name)
                x, y = DEMO.xy[row.trees].mean(axis=0)
                is_left = (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0
                assert is_left == (mounted == "left")


def test_an_aisle_lies_between_two_rows_and_is_worked_in_passes_side_by_side() -> None:
    site, drives = orchard(), drives_for(orchard(), tractor())
    units = aisle_units(drives, trees_of(site, 0, 1, 2), AisleWork(width_m=1.2))
    names = [only(unit).name for unit in units]
    assert names[0].startswith("aisle between rows")
    width, clearance = 5.0, tractor().width_m / 2
    lines = [shapely.LineString(only(unit).points) for unit in units]
    per_aisle = len(units) // 2
    ys = sorted(line.centroid.y for line in lines[:per_aisle])
    assert ys[0] - 1.2 / 2 <= 10.0 + clearance - 1.2 / 2 + 0.11
    assert ys[-1] + 1.2 / 2 >= 15.0 - clearance + 1.2 / 2 - 0.11
    assert all(b - a <= 1.2 + 1e-6 for a, b in itertools.pairwise(ys))
    assert all(10.0 + clearance - 1e-6 <= y <= 10.0 + width - clearance + 1e-6 for y in ys)


def test_one_row_has_no_aisle_and_every_second_aisle_is_left_out() -> None:
    site, drives = orchard(), drives_for(orchard(), tractor())
    with pytest.raises(PlaceError, match="no aisle lies between these rows"):
        aisle_units(drives, trees_of(site, 0), AisleWork())
    everyone = range(len(site.trees))
    assert [only(u).name for u in aisle_units(drives, everyone, AisleWork(every=2))] == [
        "aisle between rows r3 and r2",
        "aisle between rows r1 and r0",
    ]


def test_trees_in_no_row_are_refused() -> None:
    site = orchard(1, 1)
    with pytest.raises(PlaceError):
        row_units(drives_for(site, tractor()), [0], RowWork())


@settings(max_examples=40, deadline=None)
@given(room=st.floats(-1, 30), width=st.floats(0.3, 6))
def test_passes_leave_no_ground_between_them(room: float, width: float) -> None:
    offsets = pass_offsets(room, width)
    assert all(-max(0.0, room) / 2 - 1e-9 <= o <= max(0.0, room) / 2 + 1e-9 for o in offsets)
    edges = [(o - width / 2, o + width / 2) for o in offsets]
    assert all(b[0] <= a[1] + 0.1 + 1e-9 for a, b in itertools.pairwise(edges))
    reach = max(0.0, room) / 2 + width / 2
    assert edges[-1][1] >= reach - 0.1 - 1e-9
    # No pass could be left out.
    assert len(offsets) == 1 or (len(offsets) - 1) * width < max(0.0, room) + width


# --- order ------------------------------------------------------------------------------------------------------------


def test_neighbouring_rows_are_driven_there_and_back() -> None:
    site = orchard()
    drives = drives_for(site, tractor())
    units = row_units(drives, range(len(site.trees)), RowWork())
    order = in_order(drives, units, site.start.xy, None, given=False)
    between = [drives.way_between(a.end, b.begin) for a, b in itertools.pairwise(order)]
    assert all(way is not None and way[1] < 10.0 for way in between)
    given = in_order(drives, units, site.start.xy, None, given=True)
    assert [s.name.split(",")[0] for s in given] == ["row r0", "row r1", "row r2", "row r3"]


@settings(max_examples=25, deadline=None)
@given(rows=st.lists(st.integers(0, 9), min_size=1, max_size=6, unique=True), mounted=st.sampled_from(("both", "left")))
def test_an_order_has_each_row_once_and_is_no_longer_than_the_given_one(rows: list[int], mounted: str) -> None:
    drives = drives_for(DEMO, tractor())
    units = row_units(drives, trees_of(DEMO, *rows), RowWork(mounted=mounted))  # type: ignore[arg-type]
    here = DEMO.start.xy

    def metres(order: tuple[Stretch, ...]) -> float:
        points = [here, *(p for s in order for p in (s.begin, s.end))]
        return sum(
            (drives.way_between(a, b) or ((), math.inf))[1] for a, b in zip(points[::2], points[1::2], strict=False)
        )

    best = in_order(drives, units, here, None, given=False)
    given = in_order(drives, units, here, None, given=True)
    assert {s.name.split(",")[0] for s in best} == {s.name.split(",")[0] for s in given}
    assert metres(best) <= metres(given) + 1e-6


# --- stretches --------------------------------------------------------------------------------------------------------

paths = st.lists(st.tuples(st.floats(-50, 50), st.floats(-50, 50)), min_size=2, max_size=6, unique=True)


@st.composite
def stretches(draw: st.DrawFn) -> Stretch:
    points = tuple(draw(paths))
    length = sum(math.dist(a, b) for a, b in itertools.pairwise(points))
    cuts = sorted(draw(st.lists(st.floats(0, 1), max_size=6)))
    on = joined((a * length, b * length) for a, b in zip(cuts[::2], cuts[1::2], strict=False) if b > a)
    return Stretch(name="s", points=points, on=on)


@settings(max_examples=100, deadline=None)
@given(stretches(), st.floats(0, 1))
def test_two_parts_of_a_stretch_are_the_whole(stretch: Stretch, share: float) -> None:
    at = share * stretch.length_m
    parts = [p for p in (stretch.part(0.0, at), stretch.part(at, stretch.length_m)) if p is not None]
    assert sum(p.length_m for p in parts) == pytest.approx(stretch.length_m, abs=0.11)
    assert sum(p.on_m for p in parts) == pytest.approx(stretch.on_m, abs=0.2)
    assert all(-1e-9 <= a < b <= p.length_m + 1e-6 for p in parts for a, b in p.on)


@settings(max_examples=100, deadline=None)
@given(stretches())
def test_a_stretch_driven_the_other_way_is_on_at_the_same_places(stretch: Stretch) -> None:
    back = stretch.reversed()
    assert back.length_m == pytest.approx(stretch.length_m)
    assert back.on_m == pytest.approx(stretch.on_m)
    again = back.reversed()
    assert again.points == stretch.points
    assert np.allclose(np.array(again.on).ravel(), np.array(stretch.on).ravel())


@settings(max_examples=60, deadline=None)
@given(stretches(), st.floats(0, 1))
def test_a_point_of_a_stretch_is_found_again(stretch: Stretch, share: float) -> None:
    at = share * stretch.length_m
    x, y = stretch.line.interpolate(at).coords[0]
    found = stretch.project((x, y), after_m=at - 1e-3, before_m=at + 1e-3 + 0.1)
    assert found == pytest.approx(at, abs=0.11)


def test_a_ring_is_not_finished_where_it_begins() -> None:
    ring = Stretch(name="r", points=((0, 0), (10, 0), (10, 10), (0, 10), (0, 0)), on=((0, 40),))
    assert ring.project((0.0, 0.1), before_m=2.0) < 2.0
    assert ring.project((0.0, 0.1), after_m=30.0) > 39.0
    assert total_m(ring.on) == 40.0
    assert replace(ring, on=()).on_m == 0.0
