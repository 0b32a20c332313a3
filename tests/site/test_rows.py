"""Test the inference of rows: trees grouped correctly in any direction, and no rows where there are none."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fieldhand.site.loader import load_demo, load_site
from fieldhand.site.model import Site
from fieldhand.site.planting import Planting
from fieldhand.site.random_orchards import BlockShape, make_orchard, random_orchard
from fieldhand.testing.generated.orchards import block_shapes, made_orchards, seeds, site_of_made
from support.sites.points import grid, orchard, site_of

FARMS = Path(__file__).parents[3] / "shared" / "data" / "farms"
real = pytest.mark.skipif(not FARMS.exists(), reason="the farms of the shared folder are not here")
quick = settings(max_examples=25, deadline=None)


def wrong(truth: NDArray[np.intp], found: NDArray[np.intp]) -> int:
    """Return the trees in a row mostly of other trees, in no row, or in the smaller piece of their row."""
    own, row = truth[truth >= 0], found[truth >= 0].copy()
    row[row < 0] = row.max(initial=0) + 1 + np.arange((row < 0).sum())
    table = np.zeros((row.max() + 1, own.max() + 1), dtype=int)
    np.add.at(table, (row, own), 1)
    return int(((table.argmax(axis=1)[row] != own) | (table.argmax(axis=0)[own] != row)).sum())


def points_site(xy: NDArray[np.float64]) -> Site:
    return site_of([(float(x), float(y)) for x, y in xy])


def turned(xy: NDArray[np.float64], degrees: float) -> NDArray[np.float64]:
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return xy @ np.array([[c, -s], [s, c]])


def check(planting: Planting, site: Site) -> None:
    """Check the invariants of a planting."""
    assert planting.tree_count == len(site.trees)
    seen = np.concatenate([row.trees for row in planting.rows]) if planting.rows else np.empty(0, dtype=int)
    assert len(np.unique(seen)) == len(seen) == (planting.row_of >= 0).sum()
    assert bool(planting.why) == (len(seen) < len(site.trees))
    for place, block in enumerate(planting.blocks):
        assert 0.0 <= block.bearing_deg < 180.0
        assert block.tree_spacing_m > 0.0
        assert 0.0 <= block.confidence <= 1.0
        assert [row.number for row in block.rows] == list(range(1, len(block.rows) + 1))
        assert math.isnan(block.row_spacing_m) == (len(block.rows) == 1)
        turn = math.radians(block.bearing_deg)
        way = np.array([math.sin(turn), math.cos(turn)])
        way *= 1.0 if (way[0] > 0 if block.runs_east_west else way[1] < 0) else -1.0
        aside = np.array([way[1], -way[0]]) if block.runs_east_west else np.array([-way[1], way[0]])
        middles = [float((site.xy[row.trees] @ aside).mean()) for row in block.rows]
        assert middles == sorted(middles), "rows are counted from west, or from north"
        for row in block.rows:
            assert row.block == place
            assert len(row.trees) == len(row.slots) > 0
            assert 0.0 <= row.confidence <= 1.0
            assert np.all(np.diff(site.xy[row.trees] @ way) >= 0), "trees count from north, or from west"


@pytest.mark.parametrize("seed", range(24))
def test_trees_of_generated_orchards_are_in_their_row(seed):
    made = random_orchard(seed, trees=120 + 25 * seed, blocks=1 + seed % 4)
    site = points_site(made.xy)
    check(site.planting, site)
    assert wrong(made.row_of, site.planting.row_of) <= 0.005 * len(made.xy)


@quick
@given(made_orchards())
def test_small_orchards_with_ponds_have_the_rows_that_were_planted(made):
    site = site_of_made(made)
    check(site.planting, site)
    assert wrong(made.row_of, site.planting.row_of) <= max(2, 0.03 * len(site.trees))


@pytest.mark.parametrize("lattice", ["square", "diamond"])
def test_rows_of_the_hardest_orchards_are_found(lattice):
    lost = planted = 0
    for seed in range(6):
        shape = BlockShape(
            rows=14, trees_a_row=24, row_spacing_m=4.6, tree_spacing_m=4.0, bearing_deg=29.0 * seed, missing=0.2,
            jitter=0.15, lattice=lattice,
        )  # fmt: skip
        made = make_orchard(np.random.default_rng(seed), [shape])
        lost += wrong(made.row_of, points_site(made.xy).planting.row_of)
        planted += len(made.xy)
    assert lost <= 0.005 * planted


def test_scattered_trees_rarely_give_rows():
    """Rows by chance are accepted in about one of several hundred sites."""
    striped = 0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        count = int(rng.integers(1, 150))
        planting = points_site(rng.uniform(0, 5 * math.sqrt(count), (count, 2))).planting
        assert planting.why or planting.blocks
        striped += planting.blocks != ()
        assert planting.blocks or (planting.row_of == -1).all()
    assert striped <= 1


def test_scattered_trees_beside_rows_are_in_no_row_and_counted():
    rng = np.random.default_rng(4)
    made = make_orchard(rng, [BlockShape(rows=8, trees_a_row=15, jitter=0.05)], shuffled=False)
    wild = rng.uniform(0, 60, (40, 2)) + made.xy.max(axis=0) + 30
    planting = points_site(np.vstack([made.xy, wild])).planting
    assert (planting.row_of[: len(made.xy)] >= 0).all()
    assert (planting.row_of[len(made.xy) :] == -1).all()
    assert planting.why == "40 of the 160 trees are not in a row"


@quick
@given(block_shapes(), st.floats(0.0, 360.0), seeds)
def test_rotating_the_site_rotates_its_rows(shape, degrees, seed):
    made = make_orchard(np.random.default_rng(seed), [replace(shape, missing=0.0, ends="even")])
    before, after = points_site(made.xy).planting, points_site(turned(made.xy, degrees)).planting
    assert wrong(before.row_of, after.row_of) == 0
    assert len(before.blocks) == len(after.blocks) == 1
    off = (after.blocks[0].bearing_deg - before.blocks[0].bearing_deg - degrees) % 180.0
    assert min(off, 180.0 - off) < 0.2


@quick
@given(made_orchards(surrounded=False), seeds)
def test_clear_rows_do_not_depend_on_the_file_order(made, seed):
    order = np.random.default_rng(seed).permutation(len(made.xy))
    before, after = points_site(made.xy).planting, points_site(made.xy[order]).planting
    assert wrong(before.row_of[order], after.row_of) == 0


def test_rows_of_a_square_planting_follow_the_file_order():
    columns = grid(12, 12, across=4.0, along=4.0)
    rows = [(y, x) for x, y in columns]
    assert site_of(columns).planting.blocks[0].bearing_deg == pytest.approx(0.0, abs=0.5)
    assert site_of(rows).planting.blocks[0].bearing_deg == pytest.approx(90.0, abs=0.5)


def test_rows_of_a_square_planting_without_order_follow_the_longer_side_with_less_confidence():
    xy = np.random.default_rng(1).permutation(np.array(grid(6, 20, across=4.0, along=4.0)))
    square, clear = points_site(xy).planting, points_site(xy * [1.5, 1.0]).planting
    assert [len(row.trees) for row in square.rows] == [20] * 6
    assert square.blocks[0].confidence < 0.7 < 0.95 < clear.blocks[0].confidence


def test_confidence_decreases_with_irregular_planting():
    def sure(jitter: float, missing: float) -> float:
        shape = BlockShape(rows=9, trees_a_row=16, row_spacing_m=4.8, jitter=jitter, missing=missing)
        planting = points_site(make_orchard(np.random.default_rng(3), [shape]).xy).planting
        return float(np.mean([row.confidence for row in planting.rows]))

    assert sure(0.0, 0.0) > sure(0.08, 0.1) > sure(0.15, 0.2) > 0.3


def test_slots_count_the_missing_trees():
    points = [(0.0, y) for y in range(0, 80, 4)] + [(7.0, y) for y in range(0, 80, 4) if y not in (8, 12, 40)]
    first, second = site_of(points).planting.rows
    assert first.slots.tolist() == list(range(1, 21))
    assert second.slots.tolist() == [s for s in range(1, 21) if s not in (18, 17, 10)]


@pytest.mark.parametrize("bearing", [0.0, 33.0, 90.0, 140.0])
def test_a_single_line_of_trees_is_a_block_of_one_row(bearing):
    line = turned(np.array([(0.0, 4.0 * k) for k in range(9) if k not in (3, 4)]), bearing)
    (block,) = points_site(line).planting.blocks
    assert len(block.rows) == 1
    assert block.rows[0].slots.tolist() in ([1, 2, 3, 6, 7, 8, 9], [1, 2, 3, 4, 7, 8, 9])
    assert block.bearing_deg == pytest.approx(bearing, abs=0.1)


def test_five_missing_trees_do_not_split_a_row_but_a_road_through_all_rows_splits_the_block():
    whole = np.array(grid(8, 24))
    gap = ~((whole[:, 0] == 18.0) & (whole[:, 1] >= 40.0) & (whole[:, 1] < 60.0))
    (block,) = points_site(whole[gap]).planting.blocks
    assert len(block.rows) == 8
    road = ~((whole[:, 1] >= 40.0) & (whole[:, 1] < 52.0))
    north, south = points_site(whole[road]).planting.blocks
    assert len(north.rows) == len(south.rows) == 8


def test_adjacent_blocks_with_different_bearing_and_spacing_are_separate():
    shapes = [
        BlockShape(rows=8, trees_a_row=14, row_spacing_m=5.0, tree_spacing_m=3.0, bearing_deg=20.0, jitter=0.05),
        BlockShape(rows=6, trees_a_row=10, row_spacing_m=9.0, tree_spacing_m=6.0, bearing_deg=75.0, jitter=0.05),
    ]
    made = make_orchard(np.random.default_rng(8), shapes, road_m=12.0)
    planting = points_site(made.xy).planting
    assert wrong(made.row_of, planting.row_of) == 0
    assert sorted(round(b.bearing_deg) for b in planting.blocks) == [20, 75]
    found = sorted((b.row_spacing_m, b.tree_spacing_m) for b in planting.blocks)
    assert found[0] == pytest.approx((5.0, 3.0), rel=0.02)
    assert found[1] == pytest.approx((9.0, 6.0), rel=0.02)


def test_rows_may_curve():
    shape = BlockShape(rows=8, trees_a_row=40, bend=0.05, jitter=0.05, missing=0.05, bearing_deg=50.0)
    made = make_orchard(np.random.default_rng(2), [shape])
    assert wrong(made.row_of, points_site(made.xy).planting.row_of) == 0


def test_a_tree_entered_twice_shares_the_row_and_position():
    points = grid(5, 8)
    site = site_of([*points, points[11], points[30]])
    row_of = site.planting.row_of
    assert len(site.planting.rows) == 5
    assert row_of[40] == row_of[11]
    assert row_of[41] == row_of[30]


@pytest.mark.parametrize("count", [1, 2])
def test_one_or_two_trees_form_no_row(count):
    planting = site_of(grid(1, count)).planting
    assert planting.blocks == ()
    assert "three trees" in planting.why


# ---- names in the file


@quick
@given(made_orchards(named=True))
def test_rows_blocks_and_positions_of_the_file_take_precedence(made):
    site = site_of_made(made)
    planting = site.planting
    check(planting, site)
    assert wrong(made.row_of, planting.row_of) == 0
    assert {row.known for row in planting.rows} == {"file"}
    assert {block.name for block in planting.blocks} == {tree.properties["block"] for tree in site.trees}
    for row in planting.rows:
        for tree in row.trees:
            said = site.trees[tree].properties
            assert row.name == site.trees[tree].row
            assert planting.blocks[row.block].name == said["block"]


def test_equal_row_names_in_two_blocks_are_two_rows():
    shapes = [BlockShape(rows=5, trees_a_row=8), BlockShape(rows=4, trees_a_row=8, bearing_deg=60.0)]
    made = make_orchard(np.random.default_rng(0), shapes, road_m=25.0, named="rows")
    planting = site_of_made(made).planting
    assert wrong(made.row_of, planting.row_of) == 0
    assert sorted(len(block.rows) for block in planting.blocks) == [4, 5]


def test_names_of_some_trees_extend_to_their_row_and_other_rows_are_inferred():
    points = grid(6, 10)
    names = [f"R{k // 10}" if k // 10 < 3 and k % 2 == 0 else "" for k in range(60)]
    planting = site_of(points, row_names=names).planting
    assert [(row.name, row.known, len(row.trees)) for row in planting.rows] == [
        ("R0", "file", 10), ("R1", "file", 10), ("R2", "file", 10),
        ("4", "inferred", 10), ("5", "inferred", 10), ("6", "inferred", 10),
    ]  # fmt: skip
    assert len(planting.blocks) == 1


def test_a_row_property_of_scattered_trees_is_no_row():
    names = [str(k * 7 % 5) for k in range(60)]
    shuffled = np.random.default_rng(0).permutation(names).tolist()
    planting = site_of(grid(6, 10), row_names=shuffled).planting
    assert [row.known for row in planting.rows] == ["inferred"] * 6


def test_a_column_is_the_position_if_rows_are_named_and_else_the_row():
    points = grid(6, 10)
    columns = [{"column": float(k // 10 + 1)} for k in range(60)]
    planting = site_of(points, properties=columns).planting
    assert [(row.name, row.known) for row in planting.rows] == [(str(k), "file") for k in range(1, 7)]
    places = [{"column": float(k % 10 + 3)} for k in range(60)]
    named = site_of(points, properties=places, row_names=[f"{k // 10}" for k in range(60)]).planting
    assert named.rows[0].slots.tolist() == list(range(12, 2, -1))


def test_tree_numbers_of_the_whole_file_are_no_positions():
    numbers = [{"tree_number": float(k + 1)} for k in range(60)]
    planting = site_of(grid(6, 10), properties=numbers, row_names=[f"{k // 10}" for k in range(60)]).planting
    assert all(row.slots.tolist() == list(range(1, 11)) for row in planting.rows)


def test_named_blocks_contain_the_inferred_rows():
    points = grid(6, 10)
    blocks = [{"block": "home" if k < 30 else "river"} for k in range(60)]
    planting = site_of(points, properties=blocks).planting
    assert [(b.name, len(b.rows), b.known) for b in planting.blocks] == [("home", 3, "file"), ("river", 3, "file")]


# ---- real farms


def test_rows_of_the_demo_are_the_same_with_and_without_names():
    named = load_demo()
    bare = replace(named, trees=tuple(replace(tree, row="", properties={}) for tree in named.trees))
    check(named.planting, named)
    check(bare.planting, bare)
    assert [row.name for row in named.planting.rows] == [str(k) for k in range(1, 11)]
    assert wrong(named.planting.row_of, bare.planting.row_of) == 0
    assert len(named.planting.blocks) == len(bare.planting.blocks) == 1
    assert orchard().planting.blocks[0].row_spacing_m == pytest.approx(6.0)


@real
def test_reza_has_fifteen_long_columns_that_run_north():
    site = load_site(FARMS / "reza.geojson")
    (block,) = site.planting.blocks
    assert min(block.bearing_deg, 180.0 - block.bearing_deg) < 2.0
    long = [row for row in block.rows if len(row.trees) >= 15]
    assert len(long) == 15
    assert len(block.rows) <= 16
    assert (site.planting.row_of < 0).sum() <= 8
    walked = site.planting.row_of[100:140]
    assert len(np.unique(walked)) <= 4


@real
@pytest.mark.parametrize("name", ["reza_medium", "reza_attributes"])
def test_the_medium_farm_has_five_rows(name):
    (block,) = load_site(FARMS / f"{name}.geojson").planting.blocks
    assert len(block.rows) == 5
    assert not block.runs_east_west


@real
@pytest.mark.parametrize("name", ["ucm_graph30", "ucm_graph40"])
def test_scattered_farms_have_no_rows(name):
    planting = load_site(FARMS / f"{name}.geojson").planting
    assert planting.blocks == ()
    assert "scattered" in planting.why


def test_rows_of_two_blocks_in_line_across_a_road_stay_separate():
    """Two equal blocks lie end to end; a road at which every row ends separates them, with any missing trees."""
    for seed, road in ((1, 14.0), (2, 18.0), (3, 24.0)):
        rng = np.random.default_rng(seed)
        places = [(6.0 * row, 4.0 * n) for row in range(9) for n in range(14)]
        one = np.array(places) + rng.normal(0, 0.3, (len(places), 2))
        two = np.array(places) + rng.normal(0, 0.3, (len(places), 2)) + [2.0, 13 * 4.0 + road]
        xy = np.vstack([one, two])[rng.random(2 * len(places)) > 0.1]
        assert len(points_site(xy).planting.blocks) == 2


def test_rows_interrupted_by_a_pond_stay_whole():
    places = np.array([(6.0 * row, 4.0 * n) for row in range(10) for n in range(30)])
    rng = np.random.default_rng(5)
    away = np.hypot(*(places - [27.0, 58.0]).T)
    planting = points_site(places[away > 12.0] + rng.normal(0, 0.2, (int((away > 12.0).sum()), 2))).planting
    (block,) = planting.blocks
    assert len(block.rows) == 10
