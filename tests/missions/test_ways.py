"""No drive of any mission crosses a tree line or a keep-out, or leaves the boundary: held against what was planted."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString, Point, Polygon, box
from shapely.ops import unary_union

from fieldhand.execution.drivers.simulation.world import Blocked, TreeRef, World
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import (
    AlongRow,
    Corners,
    EveryNth,
    Farthest,
    Here,
    Marker,
    Nearest,
    NotVisited,
    Rows,
    Spaced,
    Take,
    TreeIs,
)
from fieldhand.site.loader import parse_site
from fieldhand.site.model import Site
from fieldhand.site.projection import Projection
from fieldhand.site.random_orchards import make_orchard, random_shapes
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, InOrder, Node, Try
from fieldhand.task.results import Arrived, Driving, Ended, Faulted
from support.examples import examples
from support.missions.rig import Rig, husky, of_type

HOME = Projection(37.0, -120.0)


@dataclass(frozen=True)
class Planted:
    """An orchard, and what must not be driven through, as it was planted."""

    site: Site
    tree_lines: tuple[LineString, ...]
    keep_outs: tuple[Polygon, ...]
    boundary: Polygon | None


def planted(seed: int, *, named: bool = True) -> Planted:
    """Blocks at any angle with gaps and ragged ends, ponds among and beside the trees, a fence, a start and an end."""
    rng = np.random.default_rng(seed)
    blocks = int(rng.integers(1, 4))
    shapes = random_shapes(rng, trees=int(rng.integers(30, 140)), blocks=blocks)
    made = make_orchard(rng, shapes, named="rows and blocks" if named else "none")
    spacing = min(s.row_spacing_m for s in shapes)
    keep_outs = list(_ponds(rng, made.xy, spacing))
    around = box(*made.xy.min(axis=0), *made.xy.max(axis=0)).buffer(float(rng.uniform(1.5, 9.0)), join_style="mitre")
    boundary = around if rng.random() < 0.6 else None
    features = [_area("keep out", f"pond {k + 1}", shape) for k, shape in enumerate(keep_outs)]
    if boundary is not None:
        features.append(_area("boundary", "fence", boundary))
    free = around.buffer(-0.6).difference(unary_union([*keep_outs, Point(0, 0).buffer(0.01)]).buffer(0.6))
    free = free.difference(shapely.MultiPoint(made.xy).buffer(1.0))
    for kind in ("start", "end"):
        x, y = _somewhere(rng, free)
        features.append(_point(x, y, kind))
    document = {**made.collection, "features": [*features, *made.collection["features"]]}
    site = parse_site(json.dumps(document).encode(), name="planted")
    shift = site.xy.mean(axis=0) - made.xy.mean(axis=0)
    seen = [LineString(site.xy[row.trees]) for row in site.planting.rows if len(row.trees) > 1]
    return Planted(
        site=site,
        # Where the file names no rows, the lines are those that can be seen in how the trees stand.
        tree_lines=tuple(_tree_lines(made.xy + shift, made.row_of) if named else seen),
        keep_outs=tuple(shapely.affinity.translate(p, *shift) for p in keep_outs),
        boundary=None if boundary is None else shapely.affinity.translate(boundary, *shift),
    )


def _ponds(rng: np.random.Generator, xy: np.ndarray[Any, Any], spacing: float) -> Iterator[Polygon]:
    trees = shapely.MultiPoint(xy)
    for _ in range(int(rng.integers(0, 4))):
        x, y = rng.uniform(xy.min(axis=0), xy.max(axis=0))
        pond = Point(x, y).buffer(float(rng.uniform(0.2, 1.5)) * spacing, quad_segs=3)
        pond = pond.difference(trees.buffer(0.4))
        if isinstance(pond, Polygon) and not pond.interiors and pond.area > 0.2:
            yield pond


def _tree_lines(xy: np.ndarray[Any, Any], row_of: np.ndarray[Any, Any]) -> Iterator[LineString]:
    """Through the trees of each true row, one after the other, as far as they go."""
    for row in np.unique(row_of[row_of >= 0]):
        trees = xy[row_of == row]
        if len(trees) > 1:
            way = np.linalg.svd(trees - trees.mean(axis=0), full_matrices=False)[2][0]
            yield LineString(trees[np.argsort(trees @ way)])


def _somewhere(rng: np.random.Generator, free: Any) -> tuple[float, float]:
    west, south, east, north = free.bounds
    while True:
        x, y = float(rng.uniform(west, east)), float(rng.uniform(south, north))
        if shapely.contains_xy(free, x, y):
            return x, y


def _degrees(points: Any) -> list[list[float]]:
    return [[lon, lat] for lat, lon in HOME.degrees(np.asarray(points)).tolist()]


def _area(kind: str, name: str, shape: Polygon) -> dict[str, Any]:
    geometry = {"type": "Polygon", "coordinates": [_degrees(shape.exterior.coords)]}
    return {"type": "Feature", "geometry": geometry, "properties": {"kind": kind, "name": name}}


def _point(x: float, y: float, kind: str) -> dict[str, Any]:
    return {
        "type": "Feature",
        "geometry": {"type": "Point", "coordinates": _degrees([(x, y)])[0]},
        "properties": {"kind": kind},
    }


def random_plan(rng: np.random.Generator, site: Site) -> Node:
    """Steps that go to places said in every way; what cannot be reached is passed over."""
    tree = TreeIs(tree=site.trees[int(rng.integers(len(site.trees)))].place.id)
    ones: list[Selector] = [
        tree,
        Nearest(to=Here(), fresh=True),
        Farthest(origin=Here()),
        AlongRow(trees=int(rng.integers(1, 6))),
        Corners(which=("ne",)),
        Marker(name="end"),
        Spaced(apart_m=5.0, count=1),
    ]
    many: list[Selector] = [
        Take(count=4, of=NotVisited()),
        Corners(),
        EveryNth(nth=int(rng.integers(5, 15))),
        Rows(first="1", last="1"),
        Spaced(apart_m=4.0, count=3),
    ]

    def step(k: int) -> Node:
        if rng.random() < 0.6:
            place = ones[int(rng.integers(len(ones)))]
            wanted: Node = GoTo(id=f"g{k}", place=place)
        else:
            select = many[int(rng.integers(len(many)))]
            body = Act(id=f"a{k}", action="read_co2", reading=f"r{k}")
            order = "best" if rng.random() < 0.7 else "given"
            wanted = ForEach(
                id=f"f{k}", select=select, body=body, order=order, optional=bool(rng.random() < 0.3), at_most=12
            )
        return Try(id=f"t{k}", body=wanted, otherwise=GoTo(id=f"o{k}", place=Here()))

    steps = tuple(step(k) for k in range(int(rng.integers(2, 6))))
    return AnyOrder(id="all", steps=steps) if rng.random() < 0.2 else InOrder(id="all", steps=steps)


def crossings(ground: Planted, path: Any) -> list[str]:
    """Return the areas that a driven path goes through and must not."""
    line = LineString(path)
    found = [f"tree line {k}" for k, row in enumerate(ground.tree_lines) if line.intersects(row)]
    found += [f"keep-out {k}" for k, p in enumerate(ground.keep_outs) if line.intersection(p.buffer(-0.02)).length > 0]
    if ground.boundary is not None and line.difference(ground.boundary.buffer(0.02)).length > 0:
        found.append("boundary")
    return found


@pytest.mark.parametrize("named", [True, False])
@settings(max_examples=examples(12, thorough=40), deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(seed=st.integers(0, 2**32 - 1))
def test_no_drive_of_any_mission_crosses_a_tree_line_or_a_keep_out(named: bool, seed: int) -> None:
    ground = planted(seed, named=named)
    rng = np.random.default_rng(seed + 1)
    faults = ()
    if rng.random() < 0.5:
        tree = ground.site.trees[int(rng.integers(len(ground.site.trees)))].place.id
        faults = (Blocked(at=TreeRef(id=tree), within_m=float(rng.uniform(0.5, 6.0)), times=2),)
    rig = Rig(site=ground.site, robot=husky(alpha=0.5), world=World(faults=faults), seed=seed)
    events = rig.fly(random_plan(rng, ground.site)).events
    assert of_type(events, Ended)
    drives = of_type(events, Driving)
    for event in drives:
        degrees = np.asarray(event.path)
        path = ground.site.projection.metres(degrees[:, 0], degrees[:, 1])
        assert not crossings(ground, path), event
    # The path that was announced is the path that was driven: each drive begins where the one before it ended.
    where = {(e.lat, e.lon) for e in of_type(events, Arrived)}
    assert all(any(math.dist(e.path[-1], at) < 1e-6 for at in where) for e in drives if not _cut_off(events, e))


def _cut_off(events: Any, drive: Driving) -> bool:
    """Return True if a drive did not come to its end."""
    after = events[events.index(drive) + 1 :]
    following = next((e for e in after if isinstance(e, Arrived | Driving | Faulted | Ended)), None)
    return not isinstance(following, Arrived)
