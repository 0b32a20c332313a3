"""The benchmark's orchard is the one that was asked for, and its selectors are all that there are."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import shapely

from fieldhand.errors import InputError
from fieldhand.places.context import Context
from fieldhand.places.reading_series import EXAMPLE_QUANTITY, EXAMPLE_READING, ReadingSeries, TakenReading
from fieldhand.places.resolution import resolve
from fieldhand.places.selectors import SELECTORS
from fieldhand.places.sources.bound import EXAMPLE_LABEL
from fieldhand.site.loader import parse_site
from fieldhand_bench.site import benchmark_orchard, measure_site, samples
from fieldhand_bench.site.samples import with_records


@pytest.mark.parametrize("trees", [20, 137, 1000, 4000])
def test_the_orchard_has_exactly_as_many_trees_outside_its_pond_and_inside_its_fence(trees):
    site = parse_site(benchmark_orchard(trees, 5), name="orchard")
    assert len(site.trees) == trees
    assert set(site.markers) == {"start", "end", "charger"}
    (pond,), (fence,) = site.zones_of("keep_out"), site.zones_of("boundary")
    x, y = site.xy[:, 0], site.xy[:, 1]
    assert not shapely.intersects_xy(pond.polygon, x, y).any()
    assert shapely.contains_xy(fence.polygon, x, y).all()
    assert all(shapely.contains_xy(fence.polygon, *m.xy) for m in site.markers.values())
    assert not any(t.row for t in site.trees)


def test_the_same_seed_gives_the_same_orchard_and_another_seed_another():
    assert benchmark_orchard(300, 1) == benchmark_orchard(300, 1)
    assert benchmark_orchard(300, 1) != benchmark_orchard(300, 2)


def test_a_larger_orchard_has_several_blocks_that_run_their_own_way():
    planting = parse_site(benchmark_orchard(4000, 2), name="orchard").planting
    # A pond may cut the corner off a block; what is left of it there is no block of the plan.
    large = [block for block in planting.blocks if sum(len(row.trees) for row in block.rows) > 100]
    assert len(large) == 4
    assert len({round(block.bearing_deg) for block in large}) == 4
    positions = sum(int(np.ptp(row.slots)) + 1 for row in planting.rows)
    assert 0.03 < 1 - 4000 / positions < 0.25


def test_too_few_trees_are_refused():
    with pytest.raises(InputError, match="19 trees"):
        benchmark_orchard(19, 1)


def test_every_kind_of_selector_is_measured():
    site = parse_site(benchmark_orchard(200, 1), name="orchard")
    measured = {type(part) for selector in samples(site).values() for part in selector.walk()}
    assert measured == set(SELECTORS)
    assert {kind.__name__ for kind in SELECTORS} <= samples(site).keys()


@pytest.mark.parametrize("trees", [200, 3000])
def test_every_measured_selector_finds_places(trees):
    site = parse_site(benchmark_orchard(trees, 1), name="orchard")
    here = site.trees[trees // 3].place
    context = Context(
        here=here,
        visited=("1", "2"),
        bound={EXAMPLE_LABEL: (here,)},
        series={EXAMPLE_READING: ReadingSeries((TakenReading(place=here, values={EXAMPLE_QUANTITY: 30.0}),))},
    )
    for name, selector in samples(site).items():
        assert resolve(selector, with_records(site), context), name


def test_each_figure_is_what_the_clock_says():
    ticks = itertools.count()
    measured = measure_site(60, seed=1, repeats=3, clearance_m=0.3, standoff_m=1.0, clock=lambda: float(next(ticks)))
    *parts, whole = measured.steps
    assert [part.median_s for part in parts] == [1.0, 1.0, 1.0]  # the clock ticks once from one reading to the next
    assert (whole.median_s, whole.worst_s) == (3.0, 3.0)
    assert all(t.median_s == 1.0 for t in (*measured.selectors, measured.drives))
    assert measured.load is whole
    found = {t.name: t.places for t in measured.selectors}
    assert (found["Trees"], found["First"], found["Take"]) == (60, 1, 10)
