"""Generate blocks to be covered: convex, concave, with holes, with curved edges, and planted with straight or curved
rows."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
import shapely
from shapely.affinity import rotate, scale
from shapely.geometry import MultiPoint, Point, Polygon, box
from shapely.geometry.base import BaseGeometry

from fieldhand.site.drives import Drives
from fieldhand.site.driving.layout import Layout
from fieldhand.site.loader import parse_site
from fieldhand.site.random_orchards import BlockShape, make_orchard

BlockKind = Literal["convex", "concave", "holes", "curved", "planted"]

#: The kinds in turn.
KINDS: tuple[BlockKind, ...] = ("convex", "concave", "holes", "curved", "planted")

#: Working widths in metres, of which each block gets one.
_WIDTHS_M = (2.0, 3.0, 4.0, 6.0)

#: Least and greatest area of an open block in hectares.
_HECTARES = (0.5, 4.0)

#: Half the width of the robot among rows, and its distance from a tree that it works on, in metres.
_CLEARANCE_M, _STANDOFF_M = 0.4, 1.5


@dataclass(frozen=True, kw_only=True)
class BlockToCover:
    """A generated block.

    Attributes:
        name: Kind and number.
        area: Area in metres.
        width_m: Working width.
        layout: Drivable layout of a planted block; None for an open one.
    """

    name: str
    kind: BlockKind
    area: Polygon
    width_m: float
    layout: Layout | None = None


def make_blocks(count: int, seed: int) -> list[BlockToCover]:
    """Return so many blocks of all kinds in turn; block k is the same for every count."""
    return [_block(k, KINDS[k % len(KINDS)], np.random.default_rng([seed, k])) for k in range(count)]


def _block(number: int, kind: BlockKind, rng: np.random.Generator) -> BlockToCover:
    width = float(rng.choice(_WIDTHS_M))
    name = f"{number + 1} {kind}"
    if kind == "planted":
        area, layout = _planted(rng)
        return BlockToCover(name=name, kind=kind, area=area, width_m=width, layout=layout)
    makers = {"convex": _convex, "concave": _concave, "holes": _with_holes, "curved": _curved}
    return BlockToCover(name=name, kind=kind, area=makers[kind](rng), width_m=width)


def _convex(rng: np.random.Generator) -> Polygon:
    return _sized(rng, MultiPoint(rng.uniform(-1.0, 1.0, (int(rng.integers(4, 9)), 2)) * (1.0, 0.7)).convex_hull)


def _concave(rng: np.random.Generator) -> Polygon:
    """Return an L, T, U or Z of rectangles, or a star-shaped polygon."""
    if rng.random() < 0.5:
        corners = int(rng.integers(6, 11))
        angles = (np.arange(corners) + rng.uniform(-0.3, 0.3, corners)) * 2.0 * np.pi / corners
        radii = rng.uniform(0.4, 1.0, corners)
        return _sized(rng, Polygon(np.column_stack([radii * np.cos(angles), radii * np.sin(angles)])))
    a, b, c = rng.uniform(0.3, 0.6, 3).tolist()
    arms = [box(0.0, 0.0, 2.0, a), box(0.0, 0.0, b, 1.5)]
    if rng.random() < 0.5:
        arms.append(box(2.0 - c, 0.0, 2.0, float(rng.uniform(0.8, 1.5))))
    return _sized(rng, shapely.union_all(arms))


def _with_holes(rng: np.random.Generator) -> Polygon:
    """Return a convex or concave block with one to three ponds or sheds well inside it."""
    field = _convex(rng) if rng.random() < 0.5 else _concave(rng)
    for _ in range(int(rng.integers(1, 4))):
        middle = _inner_point(rng, field)
        size = float(rng.uniform(4.0, 12.0))
        if rng.random() < 0.5:
            obstacle = middle.buffer(size, quad_segs=6)
        else:
            shed = box(middle.x - size, middle.y - size / 2.0, middle.x + size, middle.y + size / 2.0)
            obstacle = rotate(shed, float(rng.uniform(0.0, 180.0)))
        left = field.difference(obstacle)
        if isinstance(left, Polygon):
            field = left
    return field


def _curved(rng: np.random.Generator) -> Polygon:
    """Return a block whose edge is a smooth curve of 90 corners, convex or not."""
    angles = np.linspace(0.0, 2.0 * np.pi, 90, endpoint=False)
    radii = np.ones(90)
    for order in (2, 3, 4, 5):
        radii += float(rng.normal(0.0, 0.3 / order)) * np.cos(order * angles + float(rng.uniform(0.0, 2.0 * np.pi)))
    radii = np.maximum(radii, 0.35)
    return _sized(rng, Polygon(np.column_stack([1.4 * radii * np.cos(angles), radii * np.sin(angles)])))


def _planted(rng: np.random.Generator) -> tuple[Polygon, Layout]:
    """Return the outline of an orchard of one block, straight or bent, and its layout."""
    shape = BlockShape(
        rows=int(rng.integers(8, 25)),
        trees_a_row=int(rng.integers(12, 40)),
        row_spacing_m=float(rng.uniform(2.5, 7.0)),
        tree_spacing_m=float(rng.uniform(1.5, 4.0)),
        bearing_deg=float(rng.uniform(0.0, 180.0)),
        ends=("even", "slanted")[int(rng.integers(2))],
        bend=float(rng.choice([0.0, 0.03, 0.06])),
        missing=0.03,
    )
    site = parse_site(make_orchard(rng, [shape], named="rows", shuffled=False).to_bytes(), name="orchard")
    layout = Drives(site, _CLEARANCE_M, _STANDOFF_M).layout
    return MultiPoint(site.xy).convex_hull.buffer(8.0, quad_segs=2), layout


def _sized(rng: np.random.Generator, shape: BaseGeometry) -> Polygon:
    """Return a shape without holes, turned to a random bearing, with a random area."""
    square_metres = 1e4 * float(rng.uniform(*_HECTARES))
    factor = math.sqrt(square_metres / shape.area)
    sized = scale(shape, factor, factor, origin=(0.0, 0.0))
    return Polygon(shapely.get_coordinates(rotate(sized, float(rng.uniform(0.0, 360.0)), origin=(0.0, 0.0))))


def _inner_point(rng: np.random.Generator, field: Polygon) -> Point:
    """Return a point that is not within 15 m of the edge, if there is one."""
    inner = field.buffer(-15.0)
    inner = field if inner.is_empty else inner
    west, south, east, north = inner.bounds
    while True:
        point = Point(float(rng.uniform(west, east)), float(rng.uniform(south, north)))
        if inner.contains(point):
            return point
