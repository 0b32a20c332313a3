"""Orchards on a grid, of any size, for tests that need attributes, a zone, and names of their own choosing."""

from __future__ import annotations

import json
from typing import Any

from fieldhand.site.loader import parse_site
from fieldhand.site.model import Site

LAT, LON = 37.3, -120.5
#: Degrees that are five metres here, about.
STEP_NORTH, STEP_EAST = 4.5e-5, 5.65e-5


def grid(rows: int, columns: int, *, name: str = "grid", extra: dict[str, Any] | None = None) -> Site:
    """Rows along east-west, counted from the south; varieties by halves, ages by row, a zone around the first tree.

    Args:
        extra: Further properties of every tree.
    """
    features = [
        _feature(
            "Point",
            [LON + column * STEP_EAST, LAT + row * STEP_NORTH],
            {"variety": "Kerman" if column < columns / 2 else "Golden Hills", "age": 5.0 + row, **(extra or {})},
        )
        for row in range(rows)
        for column in range(columns)
    ]
    west, south = LON - STEP_EAST, LAT - STEP_NORTH
    for kind, east in (("start", 0), ("end", columns)):
        features.append(_feature("Point", [LON + east * STEP_EAST, south], {"marker-symbol": kind}))
    ring = [
        [west, south], [west + 2 * STEP_EAST, south], [west + 2 * STEP_EAST, south + 2 * STEP_NORTH],
        [west, south + 2 * STEP_NORTH], [west, south],
    ]  # fmt: skip
    features.append(_feature("Polygon", [ring], {"kind": "zone", "name": "wet corner"}))
    document = {"type": "FeatureCollection", "features": features}
    return parse_site(json.dumps(document).encode(), name=name)


def _feature(kind: str, coordinates: Any, properties: dict[str, Any]) -> dict[str, Any]:
    return {"type": "Feature", "geometry": {"type": kind, "coordinates": coordinates}, "properties": properties}
