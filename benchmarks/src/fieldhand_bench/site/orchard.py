"""Generate the benchmark orchard: blocks without named rows, missing trees, pond, fence, markers, attributes."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from shapely import MultiPoint, Polygon, box

from fieldhand.errors import InputError
from fieldhand.site.projection import Projection
from fieldhand.site.random_orchards import BlockShape, Ends, make_orchard

LEAST_TREES = 20
_MISSING = 0.05
_HEADLAND_M = 9.0
_BANK_M = 2.0
_HOME = Projection(36.2, -119.6)
_ENDS: tuple[Ends, ...] = ("even", "slanted")

Points = NDArray[np.float64]


def benchmark_orchard(trees: int, seed: int) -> bytes:
    """Return the GeoJSON of an orchard of exactly so many trees; the same seed gives the same orchard.

    It has one block for up to about 200 trees, two for up to 2,000, else four, each with its own bearing. About one
    tree in twenty is missing, besides those in the pond. Rows are not named in the file.

    Raises:
        InputError: There are fewer than 20 trees.
    """
    if trees < LEAST_TREES:
        raise InputError(f"an orchard of {trees} trees says nothing", advice=f"take {LEAST_TREES} or more")
    rng = np.random.default_rng(seed)
    dry, pond = _planted(rng, trees)
    # The missing trees are random, the number of remaining trees is exact.
    xy = dry[np.sort(rng.permutation(len(dry))[:trees])]
    return json.dumps(
        {
            "type": "FeatureCollection",
            "name": f"Benchmark orchard of {trees} trees",
            "features": [*_surroundings(xy, pond), *_trees(rng, xy)],
        },
        separators=(",", ":"),
    ).encode()


def _planted(rng: np.random.Generator, trees: int) -> tuple[Points, Polygon]:
    """Return positions for somewhat more trees than required, none of them in the pond, and the pond."""
    wanted = trees / (1.0 - _MISSING)
    room = 1.0
    while True:
        planted = make_orchard(rng, _shapes(rng, wanted * room)).xy
        pond = _pond(rng, planted)
        dry = planted[~_inside(planted, pond.buffer(_BANK_M))]
        if len(dry) >= wanted:
            return dry, pond
        room *= 1.02 * wanted / len(dry)


def _shapes(rng: np.random.Generator, trees: float) -> tuple[BlockShape, ...]:
    """Return blocks with about so many trees in total, somewhat fewer if their rows end unevenly."""
    blocks = 1 if trees < 250 else 2 if trees < 2500 else 4
    wanted = trees / blocks
    shapes = []
    for k in range(blocks):
        row_m, tree_m = float(rng.uniform(5.5, 7.0)), float(rng.uniform(4.0, 5.0))
        rows = max(round(math.sqrt(wanted * tree_m / row_m)), 3)
        shapes.append(
            BlockShape(
                rows=rows,
                trees_a_row=math.ceil(wanted / rows),
                row_spacing_m=row_m,
                tree_spacing_m=tree_m,
                bearing_deg=float(rng.uniform(0.0, 180.0)),
                ends=_ENDS[k % len(_ENDS)],
                jitter=0.05,
            )
        )
    return tuple(shapes)


def _pond(rng: np.random.Generator, xy: Points) -> Polygon:
    """Return a pond near the middle of the orchard, a few percent of its size, up to a mean radius of about 25 m."""
    middle = xy[int(np.argmin(np.hypot(*(xy - np.median(xy, axis=0)).T)))]
    size = min(0.08 * float(np.ptp(xy, axis=0).min()), 20.0)
    turn = np.linspace(0.0, 2 * math.pi, 24, endpoint=False)
    reach = size * (1.0 + 0.15 * rng.uniform(-1.0, 1.0, len(turn)))
    return Polygon(middle + np.column_stack([1.4 * reach * np.cos(turn), reach * np.sin(turn)]))


def _inside(xy: Points, area: Polygon) -> NDArray[np.bool_]:
    import shapely

    return np.asarray(shapely.intersects_xy(area, xy[:, 0], xy[:, 1]))


def _surroundings(xy: Points, pond: Polygon) -> list[dict[str, Any]]:
    hull = MultiPoint(xy).convex_hull
    fence = hull.buffer(_HEADLAND_M, join_style="mitre")
    path = hull.buffer(_HEADLAND_M / 2).exterior
    east, north = xy[int(np.argmin(xy @ (1.0, 2.0)))]
    reach = 0.25 * float(np.ptp(xy, axis=0).max())
    wet = box(east - reach, north - reach, east + reach, north + reach).intersection(fence)
    markers = {"start": 0.0, "end": 0.4, "charger": 0.05}
    return [
        _area(fence, "boundary", "fence"),
        _area(pond, "keep-out", "pond"),
        _area(wet, "zone", "wet corner"),
        *(
            _point(np.array(path.interpolate(part, normalized=True).coords[0]), {"kind": name})
            for name, part in markers.items()
        ),
        _point(np.array(fence.exterior.interpolate(0.7, normalized=True).coords[0]), {"kind": "gate", "name": "gate"}),
    ]


def _trees(rng: np.random.Generator, xy: Points) -> list[dict[str, Any]]:
    degrees = np.round(_HOME.degrees(xy)[:, ::-1], 8).tolist()
    age, crop = rng.integers(2, 25, len(xy)).tolist(), np.round(rng.uniform(2.0, 20.0, len(xy)), 1).tolist()
    second = (rng.random(len(xy)) < 0.3).tolist()
    return [
        {
            "type": "Feature",
            "properties": {
                "kind": "tree",
                "id": k + 1,
                "variety": "Kerman" if second[k] else "Golden Hills",
                "age_years": age[k],
                "yield_kg": crop[k],
            },
            "geometry": {"type": "Point", "coordinates": degrees[k]},
        }
        for k in range(len(xy))
    ]


def _area(shape: Polygon, kind: str, name: str) -> dict[str, Any]:
    ring = np.round(_HOME.degrees(np.array(shape.exterior.coords)[:, :2])[:, ::-1], 8)
    ring[-1] = ring[0]
    return {
        "type": "Feature",
        "properties": {"kind": kind, "name": name},
        "geometry": {"type": "Polygon", "coordinates": [ring.tolist()]},
    }


def _point(xy: Points, properties: dict[str, Any]) -> dict[str, Any]:
    lat, lon = _HOME.degrees(xy[:2])[0].tolist()
    return {
        "type": "Feature",
        "properties": properties,
        "geometry": {"type": "Point", "coordinates": [round(lon, 8), round(lat, 8)]},
    }
