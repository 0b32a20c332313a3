"""Selectors on the real farms, judged by the independent reading of the same definitions in the shared referee."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

from fieldhand.site.geojson import load_site
from fieldhand.site.places import resolve, resolve_one
from fieldhand.task.selectors import (
    Adjacent,
    AmongExtreme,
    Corners,
    EdgeMiddle,
    Extreme,
    Farthest,
    First,
    Half,
    Last,
    Middle,
    Nearest,
    Quarter,
    TreeIs,
)
from sites import at_start

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
    assert [tree for tree in ids(selector, site) if not holds(place, tree)] == []


def test_neighbours_and_far_trees_of_every_tree_hold(farm):
    site, holds = farm
    for tree in site.trees:
        me, label = TreeIs(tree=tree.place.id), {"A": tree.index}
        assert all(holds({"near": "A"}, k, label) for k in ids(Nearest(to=me, count=6), site))
        assert holds({"far": "A"}, resolve_one(Farthest(origin=me), site, at_start(site)).id, label)
        if any(holds({"next_to": "A"}, t.place.id, label) for t in site.trees):
            assert holds({"next_to": "A"}, ids(Nearest(to=me, adjacent=True), site)[0], label)
            first, second = ids(Adjacent(near=me, count=2), site)
            assert first == tree.place.id
            assert holds({"next_to": "A"}, second, label)
