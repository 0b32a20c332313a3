"""Conversion between degrees and the map frame of a robot whose profile states the frame's datum."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from fieldhand.robot.bindings import Datum
from fieldhand.site.projection import Projection

Point = tuple[float, float]


@lru_cache(maxsize=16)
def _around(datum: Datum) -> Projection:
    """Return the projection around a datum; cached, because construction is slow."""
    return Projection(datum.lat, datum.lon)


def degrees_to_map(datum: Datum, degrees: Sequence[Point]) -> tuple[Point, ...]:
    """Return map coordinates in metres of points in (lat, lon); error below 1 cm within 5 km of the datum."""
    east, north = _around(datum).metres(*np.asarray(degrees, dtype=float).T).T
    sin, cos = math.sin(math.radians(datum.heading_deg)), math.cos(math.radians(datum.heading_deg))
    x, y = east * sin + north * cos, north * sin - east * cos
    return tuple((float(a), float(b)) for a, b in zip(x, y, strict=True))


def map_to_degrees(datum: Datum, point: Point) -> Point:
    """Return latitude and longitude of a map point: the inverse of :func:`degrees_to_map`."""
    sin, cos = math.sin(math.radians(datum.heading_deg)), math.cos(math.radians(datum.heading_deg))
    x, y = point
    lat, lon = _around(datum).degrees((x * sin - y * cos, x * cos + y * sin))[0]
    return float(lat), float(lon)
