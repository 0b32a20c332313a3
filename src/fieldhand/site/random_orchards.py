"""Generate random orchards with known rows, for tests and benchmarks.

Blocks, bearings, gaps, uneven planting and the names in the file vary. :mod:`fieldhand.site.demo_orchard` generates the
built-in orchard.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from shapely import MultiPoint
from shapely.affinity import translate
from shapely.geometry.base import BaseGeometry

from fieldhand.errors import SiteError
from fieldhand.site.projection import Projection

Points = NDArray[np.float64]
Indices = NDArray[np.intp]
Ends = Literal["even", "slanted", "ragged"]
Lattice = Literal["square", "diamond", "free"]
Named = Literal["none", "rows", "rows and blocks", "everything"]

_ENDS: tuple[Ends, ...] = ("even", "slanted", "ragged")
_DECIMALS = 8
#: Distance in metres from the outermost trees to the fence; a pond never extends that far beyond them.
_HEADLAND_M = 12.0


@dataclass(frozen=True, kw_only=True)
class BlockShape:
    """Planting parameters of a block. Rows run along the bearing, in degrees clockwise from true north.

    Attributes:
        ends: Row ends on a line across the rows, on a slanted line, or irregular.
        lattice: Trees of neighbouring rows aligned, offset by half a spacing, or at random offsets.
        bend: Deviation of a row from a straight line at its middle, as a fraction of its length.
        missing: Fraction of missing trees.
        jitter: Standard deviation of a tree about its planting position, along and across, as a fraction of the tree
            spacing.
        lost_rows: Fraction of missing rows (never the outermost).
    """

    rows: int
    trees_a_row: int
    row_spacing_m: float = 6.0
    tree_spacing_m: float = 4.0
    bearing_deg: float = 0.0
    ends: Ends = "even"
    lattice: Lattice = "square"
    bend: float = 0.0
    missing: float = 0.0
    jitter: float = 0.0
    lost_rows: float = 0.0


@dataclass(frozen=True, eq=False, kw_only=True)
class GeneratedOrchard:
    """A generated orchard with its true rows and blocks.

    Attributes:
        collection: GeoJSON FeatureCollection; trees in the order of the arrays below.
        xy: Metres east and north of the orchard's middle, shape (n, 2).
        row_of: Row of each tree, counted through all blocks from 0; -1 for a stray tree. Shape (n,).
        block_of: Block of each tree; -1 for a stray tree. Shape (n,).
        shapes: Planting parameters of the blocks.
    """

    collection: dict[str, Any]
    xy: Points
    row_of: Indices
    block_of: Indices
    shapes: tuple[BlockShape, ...]

    def to_bytes(self) -> bytes:
        """Return the GeoJSON file."""
        return json.dumps(self.collection, separators=(",", ":")).encode()


def random_shapes(
    rng: np.random.Generator,
    *,
    trees: int = 300,
    blocks: int = 1,
    bearing_deg: float | None = None,
    missing: float | None = None,
    jitter: float | None = None,
    single_rows: float = 0.15,
) -> tuple[BlockShape, ...]:
    """Return shapes of blocks with about that many trees in total; parameters that are None are random per block.

    Args:
        rng: Random generator.
        trees: Approximate number of trees in all blocks.
        blocks: Number of blocks.
        bearing_deg, missing, jitter: Values for all blocks, see :class:`BlockShape`; None for random ones.
        single_rows: Probability that a block other than the first is a single row.
    """
    if trees < 1 or blocks < 1:
        raise SiteError("an orchard needs a tree and a block", advice="ask for one or more of each")
    share = rng.dirichlet(np.full(blocks, 4.0))
    shapes = []
    for k in range(blocks):
        count = max(int(trees * share[k]), 12)
        single = k > 0 and rng.random() < single_rows
        rows = 1 if single else max(int(math.sqrt(count) * rng.uniform(0.5, 1.3)), 2)
        along = min(max(count // rows, 6), 400 if single else 10**6)
        spacing = rng.uniform(2.0, 8.0)
        shapes.append(
            BlockShape(
                rows=rows,
                trees_a_row=along,
                row_spacing_m=float(spacing * rng.uniform(1.15, 3.0)),
                tree_spacing_m=float(spacing),
                bearing_deg=float(rng.uniform(0.0, 180.0)) if bearing_deg is None else bearing_deg,
                ends=_ENDS[int(rng.integers(len(_ENDS)))],
                lattice=("square", "diamond", "free")[int(rng.choice(3, p=(0.7, 0.15, 0.15)))],
                missing=float(rng.uniform(0.0, 0.2)) if missing is None else missing,
                jitter=float(rng.uniform(0.0, 0.15)) if jitter is None else jitter,
            )
        )
    return tuple(shapes)


def make_orchard(
    rng: np.random.Generator,
    shapes: Sequence[BlockShape],
    *,
    road_m: float | None = None,
    named: Named = "none",
    shuffled: bool = True,
    strays: int = 0,
    latitude: float = 37.0,
    longitude: float = -120.0,
    pond_m: float = 0.0,
    fenced: bool = False,
    markers: bool = False,
) -> GeneratedOrchard:
    """Generate an orchard with these blocks beside each other.

    Args:
        rng: Random generator; the same state gives the same orchard.
        shapes: Planting parameters of each block.
        road_m: Least distance in metres between trees of different blocks; None draws 1.3 to 3 times the wider row
            spacing.
        named: Properties of the trees: none, ``row``, ``row`` and ``block``, or ``position`` as well. Rows are numbered
            from 1 in each block.
        shuffled: True for trees in random file order, False for row by row.
        strays: Number of trees beside the blocks that belong to no row.
        latitude: Latitude of the middle in degrees.
        longitude: Longitude of the middle in degrees.
        pond_m: Radius in metres of a pond (a keep-out) around a random tree; trees in it are left out. 0 for no pond.
        fenced: Add a boundary around everything, a headland away from the trees.
        markers: Add a start and an end in the south-west and south-east of the headland.
    """
    if not shapes:
        raise SiteError("an orchard needs a block", advice="give one shape or more")
    planted = [_plant(rng, shape) for shape in shapes]
    moved = _side_by_side(rng, [p for p, _, _ in planted], shapes, road_m)
    xy = np.concatenate(moved)
    block_of = np.repeat(np.arange(len(shapes)), [len(p) for p in moved])
    rows_before = np.concatenate([[0], np.cumsum([shape.rows for shape in shapes])])
    row_of = np.concatenate([row + rows_before[k] for k, (_, row, _) in enumerate(planted)])
    position = np.concatenate([slot for _, _, slot in planted])
    if strays:
        xy = np.vstack([xy, _strays(rng, moved, shapes, strays)])
        none = np.full(strays, -1)
        row_of, block_of, position = (np.concatenate([a, none]) for a in (row_of, block_of, position))
    order = rng.permutation(len(xy)) if shuffled else np.arange(len(xy))
    xy = xy - (xy.min(axis=0) + xy.max(axis=0)) / 2
    pond = xy[int(rng.integers(len(xy)))] if pond_m > 0 else None
    if pond is not None:
        order = order[np.hypot(*(xy[order] - pond).T) > pond_m + 1.0]
        if not len(order):
            raise SiteError("the pond covers every tree", advice="make it smaller")
    projection = Projection(latitude, longitude)
    features = _around(projection, xy, pond, pond_m, fenced, markers)
    xy, row_of, block_of, position = xy[order], row_of[order], block_of[order], position[order]
    degrees = projection.positions(xy, _DECIMALS)
    properties = [
        _properties(named, int(r - rows_before[b]) + 1, int(b), int(s))
        for r, b, s in zip(row_of, block_of, position, strict=True)
    ]
    points = [
        {"type": "Feature", "properties": tree, "geometry": {"type": "Point", "coordinates": place}}
        for tree, place in zip(properties, degrees, strict=True)
    ]
    return GeneratedOrchard(
        collection={"type": "FeatureCollection", "name": "made orchard", "features": [*features, *points]},
        xy=xy,
        row_of=row_of.astype(np.intp),
        block_of=block_of.astype(np.intp),
        shapes=tuple(shapes),
    )


def _around(
    projection: Projection, xy: Points, pond: Points | None, pond_m: float, fenced: bool, markers: bool
) -> list[dict[str, Any]]:
    """Return the features other than trees."""
    (west, south), (east, north) = xy.min(axis=0) - _HEADLAND_M, xy.max(axis=0) + _HEADLAND_M
    features: list[dict[str, Any]] = []
    if fenced:
        fence = np.array([(west, south), (east, south), (east, north), (west, north), (west, south)])
        features.append(_area(projection.positions(fence, _DECIMALS), "boundary", "fence"))
    if pond is not None:
        turn = np.append(np.arange(16), 0) * (math.pi / 8)
        shore = pond + pond_m * np.column_stack([np.cos(turn), np.sin(turn)])
        features.append(_area(projection.positions(shore, _DECIMALS), "keep-out", "pond"))
    if markers:
        inside = _HEADLAND_M / 2
        for kind, x in (("start", west + inside), ("end", east - inside)):
            place = projection.positions(np.array([(x, south + inside)]), _DECIMALS)[0]
            point = {"type": "Point", "coordinates": place}
            features.append({"type": "Feature", "properties": {"marker-symbol": kind}, "geometry": point})
    return features


def _area(ring: list[list[float]], kind: str, name: str) -> dict[str, Any]:
    shape = {"type": "Polygon", "coordinates": [ring]}
    return {"type": "Feature", "properties": {"kind": kind, "name": name}, "geometry": shape}


def random_orchard(
    seed: int,
    *,
    trees: int = 300,
    blocks: int = 1,
    bearing_deg: float | None = None,
    missing: float | None = None,
    jitter: float | None = None,
    road_m: float | None = None,
    named: Named = "none",
    shuffled: bool = True,
    strays: int = 0,
) -> GeneratedOrchard:
    """Generate an orchard of about that many trees: :func:`random_shapes`, then :func:`make_orchard`."""
    rng = np.random.default_rng(seed)
    shapes = random_shapes(rng, trees=trees, blocks=blocks, bearing_deg=bearing_deg, missing=missing, jitter=jitter)
    return make_orchard(rng, shapes, road_m=road_m, named=named, shuffled=shuffled, strays=strays)


def _plant(rng: np.random.Generator, shape: BlockShape) -> tuple[Points, Indices, Indices]:
    """Return the trees of a block about the origin: positions, rows from 0, and positions in the row from 1."""
    kept = [k for k in range(shape.rows) if k in (0, shape.rows - 1) or rng.random() >= shape.lost_rows]
    slant = rng.uniform(-0.8, 0.8)
    places, rows, slots = [], [], []
    for k in kept:
        first, last = _ends(rng, shape, k, slant)
        slot = np.arange(first, last)
        there = rng.random(len(slot)) >= shape.missing
        there[:2] |= ~there.any()  # a row has at least one tree
        slot = slot[there]
        shift = {"square": 0.0, "diamond": 0.5 * (k % 2), "free": float(rng.uniform(0, 1))}[shape.lattice]
        v = (slot + shift - (shape.trees_a_row - 1) / 2) * shape.tree_spacing_m
        length = max(shape.trees_a_row * shape.tree_spacing_m, 1e-9)
        u = (k - (shape.rows - 1) / 2) * shape.row_spacing_m + shape.bend * length * (1 - (2 * v / length) ** 2)
        places.append(np.column_stack([u, v]))
        rows.append(np.full(len(slot), k))
        slots.append(slot - slot[0] + 1 if len(slot) else slot)
    local = np.vstack(places)
    local = local + rng.normal(0.0, 1.0, local.shape) * shape.jitter * shape.tree_spacing_m
    turn = math.radians(shape.bearing_deg)
    c, s = math.cos(turn), math.sin(turn)
    return local @ np.array([[c, -s], [s, c]]), np.concatenate(rows), np.concatenate(slots)


def _ends(rng: np.random.Generator, shape: BlockShape, row: int, slant: float) -> tuple[int, int]:
    """Return the first planting position of a row, and the one after its last."""
    n = shape.trees_a_row
    if shape.ends == "slanted":
        moved = round(slant * row * shape.row_spacing_m / shape.tree_spacing_m)
        moved = max(min(moved, n // 2), -(n // 2))
        return max(moved, 0), min(n + moved, n)
    if shape.ends == "ragged":
        return int(rng.integers(0, max(n // 4, 1))), n - int(rng.integers(0, max(n // 4, 1)))
    return 0, n


def _side_by_side(
    rng: np.random.Generator, blocks: Sequence[Points], shapes: Sequence[BlockShape], road_m: float | None
) -> list[Points]:
    """Move each block towards the earlier ones, from a random side, until only the road is between them."""
    placed: list[Points] = []
    taken: BaseGeometry | None = None
    for points, shape in zip(blocks, shapes, strict=True):
        outline = MultiPoint(points).convex_hull
        if taken is None:
            placed.append(points)
            taken = outline
            continue
        widest = max(s.row_spacing_m for s in shapes[: len(placed)])
        road = road_m if road_m is not None else float(rng.uniform(1.3, 3.0) * max(widest, shape.row_spacing_m))
        way = rng.uniform(0.0, 2 * math.pi)
        toward = np.array([math.cos(way), math.sin(way)])
        west, south, east, north = taken.bounds
        far = math.hypot(east - west, north - south)
        near, off = 0.0, 2 * far + 4 * float(np.hypot(*np.ptp(points, axis=0))) + 4 * road + 100.0
        for _ in range(40):
            middle = (near + off) / 2
            x, y = toward * middle
            if taken.distance(translate(outline, x, y)) > road:
                off = middle
            else:
                near = middle
        x, y = toward * off
        placed.append(points + toward * off)
        taken = taken.union(translate(outline, x, y))
    return placed


def _strays(rng: np.random.Generator, blocks: Sequence[Points], shapes: Sequence[BlockShape], count: int) -> Points:
    """Return single trees at least three spacings away from all others."""
    everything = np.vstack(blocks)
    apart = 3.0 * max(max(s.tree_spacing_m, s.row_spacing_m) for s in shapes)
    low, high = everything.min(axis=0) - 3 * apart, everything.max(axis=0) + 3 * apart
    found: list[Points] = []
    while len(found) < count:
        place = rng.uniform(low, high)
        others = np.vstack([everything, *found]) if found else everything
        if np.hypot(*(others - place).T).min() > apart:
            found.append(place)
        else:
            low, high = low - 0.05 * apart, high + 0.05 * apart
    return np.array(found)


def _properties(named: Named, row: int, block: int, position: int) -> dict[str, Any]:
    if named == "none" or block < 0:
        return {"kind": "tree"}
    properties: dict[str, Any] = {"kind": "tree", "row": row}
    if named != "rows":
        properties["block"] = chr(ord("A") + block % 26) + "A" * (block // 26)
    if named == "everything":
        properties["position"] = position
    return properties
