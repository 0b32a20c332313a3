"""Small orchards with rows, for requests about rows: two blocks, rows with names, rows that run east-west, no rows."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from fieldhand.site.loader import parse_site
from fieldhand.site.model import Site

LAT, LON = 37.07, -120.25
#: Degrees of a metre there, near enough for a test.
NORTH, EAST = 1 / 111_320, 1 / (111_320 * math.cos(math.radians(LAT)))


def two_blocks() -> Site:
    """Blocks A and B of 5 rows of 12 trees, which the file numbers from 1 in each."""
    trees = [
        _point(60 * b + 6 * row, -4 * k, id=60 * b + 12 * row + k + 1, block="AB"[b], row=row + 1, age=5 + (7 * k) % 9)
        for b in range(2)
        for row in range(5)
        for k in range(12)
    ]
    return _site("two blocks", trees)


def rewarded() -> Site:
    """Two rows of 10 trees, each with a reward."""
    trees = [
        _point(6 * row, -4 * k, id=10 * row + k + 1, reward=(7 * k + 3 * row) % 20)
        for row in range(2)
        for k in range(10)
    ]
    return _site("rewarded", trees)


def crossed() -> Site:
    """Block home of rows A1 to A5 that run north-south, and block river of rows B1 to B5 that run east-west."""
    home = [
        _point(6 * row, -4 * k, id=f"T{12 * row + k + 1}", block="home", row=f"A{row + 1}")
        for row in range(5)
        for k in range(12)
    ]
    river = [
        _point(60 + 4 * k, -6 * row, id=f"T{12 * row + k + 61}", block="river", row=f"B{row + 1}")
        for row in range(5)
        for k in range(12)
    ]
    return _site("crossed", [*home, *river])


def named_rows() -> Site:
    """8 rows of 10 trees, called A10 to A17; the trees' ids are no plain numbers."""
    trees = [
        _point(6 * row, -4 * k, id=f"T{10 * row + k + 1}", row=f"A{row + 10}") for row in range(8) for k in range(10)
    ]
    return _site("named rows", trees)


def east_west() -> Site:
    """7 rows of 15 trees that run east-west."""
    return _site("east-west", [_point(4 * k, -7 * row, id=15 * row + k + 1) for row in range(7) for k in range(15)])


def scattered() -> Site:
    """25 trees in no rows."""
    places = np.random.default_rng(2).uniform(0, 100, (25, 2)).tolist()
    return _site("scattered", [_point(x, y, id=k) for k, (x, y) in enumerate(places, start=1)])


def _site(name: str, trees: Iterable[dict[str, Any]]) -> Site:
    markers = [_point(-10, 10, **{"marker-symbol": "start"}), _point(100, -70, **{"marker-symbol": "end"})]
    return parse_site(json.dumps({"type": "FeatureCollection", "features": [*trees, *markers]}).encode(), name=name)


def _point(x: float, y: float, **properties: Any) -> dict[str, Any]:
    place = {"type": "Point", "coordinates": [LON + x * EAST, LAT + y * NORTH]}
    return {"type": "Feature", "geometry": place, "properties": properties}
