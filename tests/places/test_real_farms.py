"""Selectors on the real farms, judged by the independent reading of the same definitions in the shared referee."""

from __future__ import annotations

import importlib.util
import math
from collections.abc import Callable
from pathlib import Path

import pytest
from shapely import MultiPoint

from fieldhand.errors import PlaceError
from fieldhand.places.resolution import resolve, resolve_one
from fieldhand.places.selectors import (
    Across,
    Adjacent,
    AlongRow,
    AmongExtreme,
    Corners,
    EdgeMiddle,
    EveryNth,
    Extreme,
    Farthest,
    First,
    Half,
    InBlock,
    InRow,
    Last,
    Middle,
    Nearest,
    Quarter,
    RowOf,
    Rows,
    Spaced,
    Successive,
    TreeIs,
)
from fieldhand.site.loader import load_site
from fieldhand.site.model import Place, Site, Tree
from support.examples import examples
from support.sites.points import at_start

SHARED = Path(__file__).parents[3] / "shared"
FARMS = sorted((SHARED / "data" / "farms").glob("*.geojson"))
SIDES = ("north", "east", "south", "west")
CORNERS = ("nw", "ne", "se", "sw")

pytestmark = pytest.mark.skipif(not FARMS, reason="the shared farms are not here")


@pytest.fixture(scope="module", params=FARMS, ids=lambda p: p.stem)
def farm(request):
    spec = importlib.util.spec_from_file_location("referee", SHARED / "tools" / "referee.py")
    referee = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(referee)
    theirs, ours = referee.Site(request.param), load_site(request.param)

    def holds(place: dict, tree_id: str, labels: dict[str, int] | None = None) -> bool:
        return referee.place_holds(theirs, place, ours.by_id[tree_id].index, labels or {})

    return ours, holds


def ids(selector, site) -> list[str]:
    return [p.id for p in resolve(selector, site, at_start(site))]


def lies_askew(site: Site) -> bool:
    """Return True if the trees leave corners of the box around them empty, so that its sides are not theirs."""
    trees = MultiPoint([tree.place.xy for tree in site.trees])
    return trees.convex_hull.area < 0.8 * trees.envelope.area


def beside_along_its_row(site: Site, tree: Tree, next_to: Callable[[str], bool]) -> bool:
    """Return True if a tree of the same row is next to it, gaps in the row included; in no row, if any tree is."""
    row = int(site.planting.row_of[tree.index]) if site.planting.blocks else -1
    beside = [site.trees[k] for k in site.planting.rows[row].trees] if row >= 0 else site.trees
    return any(next_to(other.place.id) for other in beside)


def total_distance(places: list[Place], origin: Place) -> float:
    return sum(math.dist(place.xy, origin.xy) for place in places)


@pytest.mark.parametrize(
    ("selector", "place"),
    [
        *[(Corners(which=(c,)), {"corner": c}) for c in CORNERS],
        *[(Quarter(quarter=c), {"quarter": c}) for c in CORNERS],
        *[(Half(side=s), {"half": s}) for s in SIDES],
        *[(Extreme(side=s), {"most": s, "tol_m": 0.01}) for s in SIDES],
        *[(AmongExtreme(side=s), {"most": s}) for s in SIDES],
        *[(EdgeMiddle(side=s), {"mid_edge": s}) for s in SIDES],
        (Middle(), {"center": 0.25}),
        (First(), {"first": True}),
        (Last(), {"last": True}),
    ],
    ids=str,
)
def test_places_of_the_extent_hold(farm, selector, place):
    site, holds = farm
    if isinstance(selector, EdgeMiddle) and lies_askew(site):
        pytest.skip("the referee's edges are those of the compass; this farm's outline is turned against it")
    assert [tree for tree in ids(selector, site) if not holds(place, tree)] == []


def test_neighbours_and_far_trees_hold(farm):
    """Of every tree; on a large farm of each so many, since the referee measures to all trees for each of them."""
    site, holds = farm
    for tree in site.trees[:: max(1, len(site.trees) // examples(50, thorough=150))]:
        me, label = TreeIs(tree=tree.place.id), {"A": tree.index}
        assert all(holds({"near": "A"}, k, label) for k in ids(Nearest(to=me, count=6), site))
        assert holds({"far": "A"}, resolve_one(Farthest(origin=me), site, at_start(site)).id, label)
        if beside_along_its_row(site, tree, lambda k, label=label: holds({"next_to": "A"}, k, label)):
            assert holds({"next_to": "A"}, ids(Nearest(to=me, adjacent=True), site)[0], label)
            first, second = ids(Adjacent(near=me, count=2), site)
            assert first == tree.place.id
            assert holds({"next_to": "A"}, second, label)


def test_rows_hold_each_of_their_trees_once_and_count_alike_whichever_way_they_are_asked_for(farm):
    site, _ = farm
    planting = site.planting
    if not planting.blocks:
        with pytest.raises(PlaceError, match="no rows"):
            ids(Rows(first="1", last="1"), site)
        return
    seen: list[str] = []
    for block in planting.blocks:
        for row in block.rows:
            trees = [site.trees[k].place.id for k in row.trees]
            alone = Rows(first=row.name, last=row.name, of=InBlock(block=block.name))
            found = ids(alone, site)
            seen += found
            assert sorted(found) == sorted(trees)
            assert sorted(ids(RowOf(origin=TreeIs(tree=trees[0])), site)) == sorted(trees)
            assert set(ids(EveryNth(nth=3, of=alone), site)) == set(trees[::3])
            assert set(ids(InRow(first=1, last=2, counted_from="usual", of=alone), site)) <= set(trees)
    assert len(seen) == len(set(seen)) == sum(len(row.trees) for row in planting.rows)


def test_relative_places_along_the_rows_are_where_a_person_would_walk(farm):
    site, _ = farm
    for row in site.planting.rows:
        trees = [site.trees[k].place for k in row.trees]
        for k, tree in enumerate(trees):
            me = TreeIs(tree=tree.id)
            down = resolve_one(AlongRow(trees=1, origin=me), site, at_start(site))
            up = resolve_one(AlongRow(trees=1, towards="up", origin=me), site, at_start(site))
            assert {down, up} == {trees[max(k - 1, 0)], trees[min(k + 1, len(trees) - 1)]} - ({tree} - {down, up})
        block = site.planting.blocks[row.block]
        if len(block.rows) > 1:
            beside = resolve_one(Across(origin=TreeIs(tree=trees[0].id)), site, at_start(site))
            assert beside.id not in {t.id for t in trees}
        if len(trees) > 4:
            five = ids(Successive(count=5, near=TreeIs(tree=trees[2].id)), site)
            runs = [trees[k : k + 5] for k in range(len(trees) - 4)]
            least = min(total_distance(run, trees[2]) for run in runs)
            nearest = [[t.id for t in run] for run in runs if total_distance(run, trees[2]) <= least + 0.01]
            assert five in [*nearest, *(run[::-1] for run in nearest)]


def test_points_beside_a_row_stand_on_no_tree(farm):
    site, _ = farm
    found = resolve(Spaced(apart_m=4.0, near=TreeIs(tree=site.trees[0].place.id)), site, at_start(site))
    assert len(found) > 1
    if site.planting.blocks:
        assert min(min((p.x - t.place.x) ** 2 + (p.y - t.place.y) ** 2 for t in site.trees) for p in found) > 0.7**2
