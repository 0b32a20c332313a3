"""Sampling plans: quotas of groups, paths and grids across areas, random points, gaps where plants are missing."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Point, Polygon

from fieldhand.errors import PlaceError
from fieldhand.places.explanation import explain
from fieldhand.places.resolution import resolve
from fieldhand.places.selectors import (
    Grid,
    InBlock,
    InZone,
    Missing,
    PointsIn,
    Quota,
    RandomSample,
    Rows,
    Transect,
    Where,
)
from fieldhand.site.describe.rows import row_table
from fieldhand.site.drives import Drives
from fieldhand.site.gaps import empty_positions
from fieldhand.site.loader import open_site
from fieldhand.site.model import Place, Site, Zone
from support.sites.gardens import pasture
from support.sites.points import at_start, planted, site_of, without_rows

VINEYARD = open_site("vineyard")
NORTH = InBlock(block="North")
MEADOW = [(-20.0, 0.0), (100.0, 0.0), (100.0, 60.0), (40.0, 60.0), (40.0, 30.0), (-20.0, 30.0)]


def found(selector, site: Site = VINEYARD) -> tuple[Place, ...]:
    places = resolve(selector, site, at_start(site))
    assert len(set(places)) == len(places)
    return places


def spread_m(places) -> float:
    """Return the mean distance of a place to the nearest other one."""
    xy = np.array([p.xy for p in places])
    away = np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1))
    np.fill_diagonal(away, np.inf)
    return float(away.min(axis=1).mean())


rows = st.lists(st.integers(1, 9), min_size=1, max_size=6)


def field(lengths: list[int], seed: int) -> Site:
    """Rows of these lengths in two blocks, with a colour for most trees."""
    rng = np.random.default_rng(seed)
    lines = [[(6.0 * k, -4.0 * j) for j in range(n)] for k, n in enumerate(lengths)]
    half = (len(lines) + 1) // 2
    blocks = [("A", 0.0, [(str(k + 1), line) for k, line in enumerate(lines[:half])])]
    if lines[half:]:
        blocks.append(("B", 0.0, [(str(k + 1), line) for k, line in enumerate(lines[half:])]))
    colours = rng.choice(["red", "blue", "green", ""], sum(lengths))
    return planted(blocks, properties=[{"colour": str(c)} if c else {"lit": True} for c in colours])


@settings(max_examples=150, deadline=None)
@given(
    rows, st.integers(0, 99), st.sampled_from(["row", "block", "colour"]), st.integers(1, 6),
    st.sampled_from(["spread", "random", "first", "last"]),
)  # fmt: skip
def test_a_quota_takes_its_number_of_each_group_or_the_whole_of_a_smaller_one(lengths, seed, per, count, how):
    site = field(lengths, seed)
    row_of = site.planting.row_of
    key = {
        "row": lambda t: row_of[t.index],
        "block": lambda t: site.planting.rows[row_of[t.index]].block,
        "colour": lambda t: t.properties.get("colour"),
    }[per]
    sizes = Counter(key(t) for t in site.trees if key(t) is not None)
    if not sizes:
        return
    selector = Quota(per=per, count=count, how=how, seed=seed)
    chosen = found(selector, site)
    assert Counter(key(site.by_id[p.id]) for p in chosen) == {k: min(count, n) for k, n in sizes.items()}
    assert found(selector, site) == chosen


@settings(max_examples=60, deadline=None)
@given(rows, st.floats(0.5, 100), st.sampled_from(["spread", "random", "first"]))
def test_a_share_of_each_row_is_rounded_and_never_empty(lengths, percent, how):
    site = field(lengths, 1)
    chosen = found(Quota(per="row", percent=percent, how=how), site)
    per_row = Counter(int(site.planting.row_of[site.by_id[p.id].index]) for p in chosen)
    expected = {k: max(1, int(np.floor(percent * n / 100 + 0.5))) for k, n in enumerate(lengths)}
    assert per_row == expected


@pytest.mark.parametrize("per", ["row", "block", "variety", ""])
@pytest.mark.parametrize("count", [1, 3, 8])
def test_a_spread_quota_is_spread_better_than_random_ones(per, count):
    if (per, count) == ("", 1):
        return
    ours = spread_m(found(Quota(per=per, count=count)))
    drawn = [spread_m(found(Quota(per=per, count=count, how="random", seed=seed))) for seed in range(20)]
    assert ours > (np.mean(drawn) if per == "row" or count == 1 else max(drawn))


def test_the_best_of_each_group_are_those_with_the_highest_or_lowest_value():
    chosen = found(Quota(per="variety", count=3, how="lowest", by="vigor"))
    for variety in VINEYARD.attributes["variety"]:
        own = sorted(t.properties["vigor"] for t in VINEYARD.trees if t.properties["variety"] == variety)
        taken = [
            VINEYARD.by_id[p.id].properties for p in chosen if VINEYARD.by_id[p.id].properties["variety"] == variety
        ]
        assert sorted(t["vigor"] for t in taken) == own[:3]


def test_the_first_of_each_row_are_those_at_its_usual_end():
    chosen = found(Quota(per="row", count=2, how="first"))
    assert {p.id for p in chosen} == {
        VINEYARD.trees[k].place.id for row in VINEYARD.planting.rows for k in row.trees[:2]
    }


def test_zones_are_groups_too_and_a_tree_belongs_to_one():
    chosen = found(Quota(per="zone", count=4))
    inside = {p.id for p in found(InZone(zone="wet corner"))}
    assert len(chosen) == 4
    assert {p.id for p in chosen} <= inside


@pytest.mark.parametrize(
    ("selector", "what"),
    [
        (Quota(per="rootstock", count=5), "no tree has an attribute 'rootstock'; the trees have .*variety"),
        (Quota(per="row"), "a count of at least 1 or a percentage"),
        (Quota(per="row", count=2, percent=5.0), "a count of at least 1 or a percentage"),
        (Quota(per="row", percent=120.0), "a percentage from above 0 to 100"),
        (Quota(per="row", count=2, how="highest"), "need the attribute"),
        (Quota(per="row", count=2, how="highest", by="variety"), "not a number"),
        (Transect(), "0 points along a path is not possible"),
        (Transect(count=3, legs=0), "0 legs is not possible"),
        (Transect(count=2000), "2000 were asked for, but there are only 1006"),
        (Transect(count=5, zone="orchard"), "no zone 'orchard'"),
        (Transect(count=5, zone="pond"), "is a keep-out zone"),
        (Transect(count=5, shape="edge", off_m=-1.0), "points cannot lie -1 m from an edge"),
        (Transect(count=5, shape="edge", off_m=float("nan")), "points cannot lie nan m from an edge"),
        (Grid(every_m=0.0), "a grid cannot be 0 m wide"),
        (Grid(every_m=0.01), "has .* cells there"),
        (Grid(every_m=1e-275), "has too many cells there"),
        (PointsIn(zone="meadow", count=0, random=True), "0 points in a zone"),
        (Missing(of=Rows(first="1", last="1", of=NORTH)), "no position is empty there; .* 30 gaps"),
    ],
)
def test_an_impossible_sample_is_refused_with_what_there_is_instead(selector, what):
    with pytest.raises(PlaceError, match=what):
        resolve(selector, VINEYARD, at_start(VINEYARD))


def test_rows_are_needed_for_quotas_of_rows_and_for_gaps():
    site = without_rows(site_of([(0, 0), (5, 7), (11, 3)]))
    for selector in (Quota(per="row", count=1), Quota(per="block", count=1), Missing()):
        with pytest.raises(PlaceError, match="this site has no rows"):
            resolve(selector, site, at_start(site))


def test_a_group_with_too_few_trees_is_named():
    site = field([5, 2, 5], 3)
    told = explain(Quota(per="row", count=4), site, at_start(site))
    assert told.notes == ("1 group has fewer than 4 trees, and all of them are chosen: row 2 of block A (2)",)


@settings(max_examples=40, deadline=None)
@given(
    st.integers(1, 60), st.sampled_from(["zigzag", "z", "x"]), st.integers(1, 8), st.sampled_from(["North", "South"])
)
def test_a_path_gives_its_number_of_vines_in_its_order_near_the_path(count, shape, legs, block):
    group = InBlock(block=block)
    chosen = found(Transect(count=count, shape=shape, legs=legs, of=group))
    assert len(chosen) == count
    assert {p.id for p in chosen} <= {p.id for p in found(group)}
    if shape == "zigzag" and legs == 1 and 1 < count < 20:
        xy = np.array([p.xy for p in chosen])
        line = np.array([xy[0], xy[-1]])
        along = (xy - line[0]) @ (line[1] - line[0])
        assert (np.diff(along) > -VINEYARD.spacing_m * np.hypot(*(line[1] - line[0]))).all()


def test_a_w_has_four_legs_between_the_long_sides():
    site = site_of([(float(x), float(y)) for x in range(0, 101, 2) for y in range(0, 41, 2)])
    chosen = np.array([p.xy for p in found(Transect(count=40), site)])
    assert (np.diff(chosen[:, 0]) >= 0).all()
    down = np.sign(np.diff(chosen[:, 1]))
    down = down[down != 0]
    turns = [k for k in range(1, len(down)) if down[k] * down[k - 1] < 0]
    assert len(turns) == 3
    assert down[0] < 0
    assert chosen[:, 1].min() <= 2
    assert chosen[:, 1].max() >= 38


@settings(max_examples=40, deadline=None)
@given(st.integers(1, 40), st.sampled_from(["zigzag", "z", "x"]), st.integers(1, 6))
def test_free_points_of_a_path_lie_in_the_zone_however_it_is_bent(count, shape, legs):
    site = site_of([(-60.0, -60.0)], zones=[("meadow", "zone", MEADOW)], markers={"start": (-60.0, -50.0)})
    points = found(Transect(count=count, shape=shape, legs=legs, zone="meadow"), site)
    assert len(points) == count
    area = Polygon(MEADOW).buffer(1e-6)
    assert all(p.kind == "point" and area.contains(Point(p.xy)) for p in points)


@settings(max_examples=40, deadline=None)
@given(st.floats(4.0, 14.0))
def test_points_of_a_grid_are_that_far_apart_and_cover_the_zone(every):
    site = site_of([(-60.0, -60.0)], zones=[("meadow", "zone", MEADOW)])
    xy = np.array([p.xy for p in found(Grid(every_m=every, zone="meadow"), site)])
    away = np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1))
    np.fill_diagonal(away, np.inf)
    if len(xy) > 1:
        assert away.min() >= every - 1e-6
    area = Polygon(MEADOW).buffer(1e-6)
    assert all(area.contains(Point(at)) for at in xy.tolist())
    inside = [Point(x, y) for x in range(-18, 99, 6) for y in range(2, 59, 6) if Polygon(MEADOW).contains(Point(x, y))]
    reach = every / 2 * np.sqrt(2)
    covered = [min(np.hypot(p.x - x, p.y - y) for x, y in xy.tolist()) <= 2 * reach for p in inside]
    assert all(covered)


@settings(max_examples=30, deadline=None)
@given(st.floats(6.0, 40.0))
def test_a_grid_takes_one_vine_of_each_cell(every):
    chosen = found(Grid(every_m=every, of=NORTH))
    told = explain(Grid(every_m=every, of=NORTH), VINEYARD, at_start(VINEYARD))
    empty = int(told.notes[0].split()[0]) if told.notes else 0
    xy = np.array([p.xy for p in found(NORTH)])
    assert len(chosen) + empty >= np.ptp(xy[:, 0]) * np.ptp(xy[:, 1]) / every**2 / 3
    assert len(chosen) <= len(xy)


def test_random_points_are_the_same_for_a_seed_and_fill_the_zone():
    draw = PointsIn(zone="meadow", count=400, random=True, seed=5)
    points = found(draw)
    assert points == found(draw)
    assert points != found(PointsIn(zone="meadow", count=400, random=True, seed=6))
    (meadow,) = [z.polygon for z in VINEYARD.zones if z.name == "meadow"]
    assert all(meadow.contains(Point(p.xy)) for p in points)
    middle = meadow.centroid
    east = sum(p.x > middle.x for p in points)
    assert 150 < east < 250


def test_without_a_zone_points_are_spread_over_the_site():
    (fence,) = [z.polygon for z in VINEYARD.zones_of("boundary")]
    pond = next(z.polygon for z in VINEYARD.zones if z.name == "pond")
    for selector in (PointsIn(count=9), PointsIn(count=9, random=True)):
        assert all(fence.contains(Point(p.xy)) and not pond.contains(Point(p.xy)) for p in found(selector))


@settings(max_examples=80, deadline=None)
@given(st.lists(st.sets(st.integers(1, 10), max_size=4), min_size=2, max_size=5))
def test_gaps_are_where_trees_were_taken_out_between_others(removed):
    lines = [[(6.0 * k, -4.0 * j) for j in range(12) if j not in out] for k, out in enumerate(removed)]
    site = site_of(
        [at for line in lines for at in line], row_names=[str(k) for k, line in enumerate(lines) for _ in line]
    )
    expected = {(6.0 * k, -4.0 * j) for k, out in enumerate(removed) for j in out}
    gaps = empty_positions(site)
    assert {(round(x, 6), round(y, 6)) for x, y in gaps.xy.tolist()} == expected
    assert len(gaps) == sum(row.missing for row in row_table(site))
    if expected:
        assert {(round(p.x, 6), round(p.y, 6)) for p in found(Missing(), site)} == expected
        assert {p.kind for p in found(Missing(), site)} == {"gap"}


def test_where_a_row_passes_a_pond_no_tree_is_missing():
    lines = [[(6.0 * k, -4.0 * j) for j in range(12) if (k, j) not in {(0, 3), (1, 7), (2, 7)}] for k in range(3)]
    site = site_of(
        [at for line in lines for at in line], row_names=[str(k) for k, line in enumerate(lines) for _ in line]
    )
    pond = Zone(name="pond", kind="keep_out", polygon=Point(9.0, -28.0).buffer(4.5))
    watered = replace(site, zones=(*site.zones, pond))
    assert {(round(p.x), round(p.y)) for p in found(Missing(), site)} == {(0, -12), (6, -28), (12, -28)}
    assert {(round(p.x), round(p.y)) for p in found(Missing(), watered)} == {(0, -12)}


def test_gaps_belong_to_what_both_their_neighbours_belong_to():
    every = found(Missing())
    south = found(Missing(of=InBlock(block="South")))
    north = found(Missing(of=NORTH))
    assert len(every) == len(north) + len(south) == 30
    syrah = found(Missing(of=Where(attribute="variety", test="eq", value="Syrah")))
    rows = [row.number for row in VINEYARD.planting.blocks[0].rows if row.number > 18]
    assert all(p.id.split()[4] in map(str, [*rows, *range(9, 15)]) for p in syrah)


def test_a_robot_works_on_a_gap_from_the_aisle_beside_it():
    drives = Drives(VINEYARD, 0.75, 1.8)
    gaps = found(Missing())
    assert drives.problems(gaps) == ("",) * len(gaps)
    stands = drives.stands(gaps, VINEYARD.start)
    away = [np.hypot(s.stand[0] - s.x, s.stand[1] - s.y) for s in stands if s.stand]
    assert len(away) == len(gaps)
    assert min(away) > 1.0
    assert max(away) < 2.0
    rows = drives.layout.aisles.row_lines.geometries
    assert min(line.distance(Point(s.stand)) for s in stands if s.stand for line in rows) > 0.75


def test_a_random_sample_of_gaps_and_nearest_gaps_work_like_those_of_trees():
    assert {p.kind for p in found(RandomSample(count=4, of=Missing()))} == {"gap"}


def test_the_vines_of_a_quota_are_named_by_their_group_unless_they_are_many():
    quota = Quota(per="variety", count=2)
    chosen = found(quota)
    said = quota.say_groups(chosen, VINEYARD)
    groups = dict(part.split(": ") for part in said.split("; "))
    assert set(groups) == set(VINEYARD.attributes["variety"])
    for variety, ids in groups.items():
        assert all(VINEYARD.by_id[tree].properties["variety"] == variety for tree in ids.split(", "))
    assert sorted(tree for ids in groups.values() for tree in ids.split(", ")) == sorted(p.id for p in chosen)
    many = Quota(per="row", count=2)
    assert many.say_groups(found(many), VINEYARD) == ""
    assert Quota(percent=1.0).say_groups(chosen, VINEYARD) == ""


@pytest.mark.parametrize(("zone", "inside"), [("cow paddock", True), ("", True), ("pond", False)])
@pytest.mark.parametrize(("apart_m", "off_m"), [(6.0, 1.5), (15.0, 1.5), (6.0, 4.0)])
def test_points_along_an_edge_are_evenly_spaced_beside_it(
    zone: str, apart_m: float, off_m: float, inside: bool
) -> None:
    site = pasture()
    called = [one.polygon for one in site.zones if one.name == (zone or "common")]
    places = found(Transect(shape="edge", apart_m=apart_m, zone=zone), site)
    edge = called[0].exterior
    for place in places:
        assert called[0].contains(Point(place.xy)) == inside
        assert 1.0 <= edge.distance(Point(place.xy)) <= 2.0
    length = edge.length
    assert len(places) == pytest.approx(length / apart_m, abs=0.2 * length / apart_m + 1)
    along = sorted(edge.project(Point(place.xy)) for place in places)
    gaps = np.diff([*along, along[0] + length])
    assert gaps == pytest.approx([length / len(places)] * len(places), abs=4.0)


def test_so_many_points_along_an_edge_are_named_by_their_zone() -> None:
    places = found(Transect(shape="edge", count=5, zone="bank"), pasture())
    assert [place.id for place in places] == [f"point {k} of 5 in bank" for k in range(1, 6)]
    with pytest.raises(PlaceError, match="wood"):
        found(Transect(shape="edge", count=5, zone="wood"), pasture())


@pytest.mark.parametrize(("zone", "inside"), [("cow paddock", True), ("pond", False)])
@pytest.mark.parametrize("off_m", [1.5, 4.0, 7.5])
def test_points_along_an_edge_keep_the_distance_from_it_that_is_asked_for(
    zone: str, inside: bool, off_m: float
) -> None:
    site = pasture()
    ground = next(one.polygon for one in site.zones if one.name == zone)
    for place in found(Transect(shape="edge", apart_m=6.0, off_m=off_m, zone=zone), site):
        assert ground.contains(Point(place.xy)) == inside
        assert ground.exterior.distance(Point(place.xy)) == pytest.approx(off_m, abs=0.1)
