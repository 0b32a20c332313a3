"""Generate orchards as GeoJSON: rows of trees with a pond, a boundary, markers and attributes.

The built-in orchard is one of them (``scripts/make_demo_orchard.py`` writes it).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fieldhand.hidden_characters import json_text
from fieldhand.site.projection import Projection

_DEMO_SEED = 1872
#: Seven decimals of a degree are 1 cm.
_DECIMALS = 7

Feature = dict[str, Any]
Points = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Variety:
    """A variety of trees: mean yield in kg, and age in years."""

    name: str
    yield_kg: float
    age_years: int


@dataclass(frozen=True, kw_only=True)
class OrchardShape:
    """Layout parameters of an orchard. Rows run along the rotated north axis; distances in metres.

    Attributes:
        turned_deg: Bearing of the rows, in degrees clockwise from true north.
        pond: Centre (across rows, along rows, from the orchard's middle) and half axes.
        bank_m: Width of the bank around the pond, which has no trees.
        missing: Fraction of missing trees.
        jitter_m: Standard deviation of a tree about its grid point.
    """

    rows: int = 10
    trees_a_row: int = 19
    row_spacing_m: float = 6.4
    tree_spacing_m: float = 5.0
    turned_deg: float = 7.0
    headland_m: float = 8.0
    pond: tuple[float, float, float, float] = (4.0, 6.0, 11.0, 8.0)
    bank_m: float = 1.5
    missing: float = 0.04
    jitter_m: float = 0.15


def demo_orchard(seed: int = _DEMO_SEED) -> dict[str, Any]:
    """Return the built-in orchard: almonds of two varieties in the Central Valley of California."""
    return generate_orchard(
        np.random.default_rng(seed),
        name="Demo orchard",
        tree="almond-tree",
        latitude=37.0713,
        longitude=-120.2581,
        shape=OrchardShape(),
        varieties=(
            Variety(name="Nonpareil", yield_kg=14.0, age_years=12),
            Variety(name="Carmel", yield_kg=10.5, age_years=8),
        ),
    )


def generate_orchard(
    rng: np.random.Generator,
    *,
    name: str,
    tree: str,
    latitude: float,
    longitude: float,
    shape: OrchardShape,
    varieties: Sequence[Variety],
) -> dict[str, Any]:
    """Generate an orchard as a GeoJSON FeatureCollection.

    Varieties alternate row by row, as growers plant them for pollination. Trees near the pond are more often yellow
    and yield less, so that queries over attributes find a pattern.

    Args:
        rng: Random generator; the same state gives the same orchard.
        name: Name of the collection.
        tree: ``marker-symbol`` of the trees.
        latitude: Latitude of the orchard's middle in degrees.
        longitude: Longitude of the orchard's middle in degrees.
        shape: Layout parameters.
        varieties: Varieties of the rows; at least one.
    """
    frame = _Frame(Projection(latitude, longitude), math.radians(shape.turned_deg))
    across, along = _grid(shape.rows, shape.row_spacing_m), _grid(shape.trees_a_row, shape.tree_spacing_m)
    features = [
        *_areas(frame, shape, across[-1], along[-1], rng),
        *_markers(frame, shape, across, along),
        *_planted(frame, shape, across, along, tree, varieties, rng),
    ]
    return {"type": "FeatureCollection", "name": name, "features": features}


def to_text(collection: dict[str, Any]) -> str:
    """Return compact GeoJSON with one line per feature, so that differences show tree by tree."""
    head = {k: v for k, v in collection.items() if k != "features"}
    lines = ",\n".join(json_text(f, separators=(", ", ": ")) for f in collection["features"])
    return f'{json_text(head)[:-1]}, "features": [\n{lines}\n]}}\n'


@dataclass(frozen=True)
class _Frame:
    """Axes of the orchard: across the rows and along them, in metres from its middle."""

    projection: Projection
    turned: float

    def degrees(self, local: Points) -> list[list[float]]:
        """Convert local metres to GeoJSON positions."""
        c, s = math.cos(self.turned), math.sin(self.turned)
        east_north = np.atleast_2d(local) @ np.array([[c, -s], [s, c]])
        return self.projection.positions(east_north, _DECIMALS)


def _grid(count: int, spacing: float) -> Points:
    """Return evenly spaced coordinates centred on 0."""
    return np.array([(k - (count - 1) / 2) * spacing for k in range(count)])


def _areas(
    frame: _Frame, shape: OrchardShape, half_width: float, half_length: float, rng: np.random.Generator
) -> list[Feature]:
    w, h = half_width + shape.headland_m, half_length + shape.headland_m
    fence = np.array([(-w, -h), (w, -h), (w, h), (-w, h), (-w, -h)])
    x, y, a, b = shape.pond
    turn = np.arange(14) * (2 * math.pi / 14)
    swell = 1.0 + 0.08 * rng.uniform(-1.0, 1.0, len(turn))
    shore = np.column_stack([x + a * swell * np.cos(turn), y + b * swell * np.sin(turn)])
    wet = np.array([(-w, -h), (-w / 3, -h), (-w / 3, -h / 2), (-w, -h / 2), (-w, -h)])
    return [
        _feature("Polygon", [frame.degrees(fence)], {"kind": "boundary", "name": "fence"}),
        _feature("Polygon", [frame.degrees(np.vstack([shore, shore[:1]]))], {"kind": "keep-out", "name": "pond"}),
        _feature("Polygon", [frame.degrees(wet)], {"kind": "zone", "name": "wet corner"}),
    ]


def _markers(frame: _Frame, shape: OrchardShape, across: Points, along: Points) -> list[Feature]:
    """Return the start in the south-east headland, and the end and charger in the south-west one."""
    south = along[0] - shape.headland_m / 2
    at = {"start": (across[-1], south), "end": (across[0], south), "charger": (across[0] + 9.0, south - 0.5)}
    return [_feature("Point", frame.degrees(np.array(p))[0], {"marker-symbol": kind}) for kind, p in at.items()]


def _planted(
    frame: _Frame,
    shape: OrchardShape,
    across: Points,
    along: Points,
    tree: str,
    varieties: Sequence[Variety],
    rng: np.random.Generator,
) -> list[Feature]:
    x, y, a, b = shape.pond
    features: list[Feature] = []
    for row, u in enumerate(across, start=1):
        variety = varieties[(row - 1) % len(varieties)]
        for v in along:
            du, dv = rng.normal(0.0, shape.jitter_m, 2)
            gone, replanted, vigour, pale = rng.random(4)
            shore = math.hypot((u - x) / (a + shape.bank_m), (v - y) / (b + shape.bank_m))
            if shore < 1.15 or gone < shape.missing:
                continue
            age = variety.age_years if replanted > 0.12 else 2 + int(replanted * 25)
            wet = math.exp(-((shore - 1.0) ** 2))
            colour = "yellow" if pale < 0.08 + 0.5 * wet**2 else "pale green" if pale > 0.9 else "green"
            grown = min(age / 9.0, 1.0) * {"green": 1.0, "pale green": 0.85, "yellow": 0.6}[colour]
            properties = {
                "marker-symbol": tree,
                "id": len(features) + 1,
                "row": row,
                "variety": variety.name,
                "age_years": age,
                "leaf_color": colour,
                "yield_kg": round(variety.yield_kg * grown * (0.75 + 0.5 * vigour), 1),
            }
            position = frame.degrees(np.array([u + du, v + dv]))[0]
            features.append(_feature("Point", position, properties))
    return features


def _feature(kind: str, coordinates: Any, properties: dict[str, Any]) -> Feature:
    return {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": coordinates}}
