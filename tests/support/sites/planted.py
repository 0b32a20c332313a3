"""Sites whose rows are given: by hand, and of any kind by a seed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from shapely.geometry import LineString, MultiPoint, Point, box

from fieldhand.site.model import Gate, Site
from fieldhand.site.planting import Block, Planting, Row
from support.sites.points import place_at, site_of


def planted(blocks: Sequence[tuple[float, Sequence[Sequence[tuple[float, float]]]]], *, lone=(), **more) -> Site:
    """A site whose blocks are given as (bearing, rows of points)."""
    points: list[tuple[float, float]] = []
    found = []
    for b, (bearing, rows) in enumerate(blocks):
        numbered = []
        for k, row in enumerate(rows):
            trees = len(points) + np.arange(len(row))
            points.extend((float(x), float(y)) for x, y in row)
            numbered.append(
                Row(
                    name=str(k + 1), number=k + 1, block=b, trees=trees, slots=trees - trees[0] + 1,
                    known="file", confidence=1.0,
                )
            )  # fmt: skip
        spacing = math.nan
        if len(rows) > 1:
            across = np.array([math.cos(math.radians(bearing)), -math.sin(math.radians(bearing))])
            middles = [float((np.array(row) @ across).mean()) for row in rows]
            spacing = float(np.median(np.abs(np.diff(middles))))
        found.append(
            Block(
                name="AB"[b] if b < 2 else str(b), rows=tuple(numbered), bearing_deg=bearing, row_spacing_m=spacing,
                tree_spacing_m=4.0, known="file", confidence=1.0,
            )
        )  # fmt: skip
    site = site_of([*points, *lone], **more)
    site.__dict__["planting"] = Planting(blocks=tuple(found), tree_count=len(site.trees))
    return site


def upright(rows: int, trees: int, *, across: float = 6.0, along: float = 4.0, **more) -> Site:
    """Rows that run north, the first at x = 0; trees from the south, at y = 0, 4, 8 ..."""
    return planted([(0.0, [[(r * across, k * along) for k in range(trees)] for r in range(rows)])], **more)


def generated(seed: int) -> Site:
    """One to three blocks with any bearing: uneven, ragged, bent; ponds, wires, a fence near the row ends, markers."""
    rng = np.random.default_rng(seed)
    blocks, east = [], 0.0
    for _ in range(rng.integers(1, 4)):
        rows, trees = int(rng.integers(1, 8)), int(rng.integers(3, 12))
        across, along = rng.uniform(3.0, 7.0), rng.uniform(2.0, 6.0)
        uneven = rng.choice([0.0, 0.025, 0.075]) * min(across, along)
        bend = rng.choice([0.0, 0.0, 1.0 / (2.0 * rng.uniform(30.0, 200.0))])
        ragged = int(rng.choice([0, 0, 2, 4]))
        local = [row_of(rng, r * across, trees, along, uneven, bend, ragged) for r in range(rows)]
        bearing = rng.uniform(0.0, 180.0)
        turn = math.radians(bearing)
        axes = np.array([[math.sin(turn), math.cos(turn)], [math.cos(turn), -math.sin(turn)]])
        turned = [uv @ axes for uv in local]
        everything = np.vstack(turned)
        origin = np.array([east - everything[:, 0].min(), -everything[:, 1].mean()])
        east += np.ptp(everything[:, 0]) + rng.uniform(6.0, 15.0)
        blocks.append((bearing, [xy + origin for xy in turned]))
    xy = np.vstack([row for _, rows_ in blocks for row in rows_])
    return planted(blocks, zones=zones_about(rng, xy), markers=markers_about(rng, xy))


def row_of(rng, v: float, trees: int, along: float, uneven: float, bend: float, ragged: int):
    first, last = int(rng.integers(0, ragged + 1)), trees - int(rng.integers(0, ragged + 1))
    k = np.arange(first, max(last, first + 1))
    k = k[rng.random(len(k)) > 0.1] if len(k) > 2 else k
    k = k if len(k) else np.array([first])
    u = k * along
    uv = np.column_stack([u, v + bend * (u - trees * along / 2.0) ** 2]) + rng.uniform(-uneven, uneven, (len(k), 2))
    if len(uv) > 2 and rng.random() < 0.1:  # a tree entered twice
        uv = np.vstack([uv[:2], uv[1:2] + rng.uniform(-0.1, 0.1, 2), uv[2:]])
    return uv


def zones_about(rng, xy):
    (west, south), (east, north) = xy.min(axis=0), xy.max(axis=0)
    zones = []
    if rng.random() < 0.7:
        zones.append(("fence", "boundary", MultiPoint(xy).convex_hull.buffer(rng.choice([1.5, 3.0, 8.0]))))
    for k in range(int(rng.integers(0, 5))):
        middle = rng.uniform([west - 3, south - 3], [east + 3, north + 3])
        zones.append((f"pond {k}", "keep_out", Point(middle).buffer(rng.choice([0.3, 1.0, 4.0]), quad_segs=3)))
    if rng.random() < 0.3:
        wire = LineString([rng.uniform([west, south], [east, north]) for _ in range(2)])
        zones.append(("wire", "keep_out", wire.buffer(0.05)))
    return zones


def markers_about(rng, xy):
    low, high = xy.min(axis=0) - 1.0, xy.max(axis=0) + 1.0
    return {name: tuple(rng.uniform(low, high)) for name in ("start", "end")} if rng.random() < 0.7 else {}


def scattered(seed: int) -> Site:
    """Trees in no row, on open ground with ponds; perhaps two fenced parts with a gate between them."""
    rng = np.random.default_rng(seed)
    xy = rng.uniform(0.0, 80.0, (int(rng.integers(3, 30)), 2))
    zones = [zone for zone in zones_about(rng, xy) if zone[1] == "keep_out"]
    if rng.random() < 0.5:
        zones += [(f"part {k}", "boundary", box(x, -5.0, x + 45.0, 85.0)) for k, x in enumerate((-5.0, 40.0))]
    gate = Gate(place=place_at(40.0, rng.uniform(5.0, 75.0), kind="marker", id="gate"), width_m=4.0)
    site = replace(planted([], lone=[(float(x), float(y)) for x, y in xy], zones=zones), gates=(gate,))
    site.__dict__["planting"] = Planting(blocks=(), tree_count=len(xy))
    return site
