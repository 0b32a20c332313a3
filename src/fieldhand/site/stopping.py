"""Find where on its way a robot can stop without being in anybody's way."""

from __future__ import annotations

import itertools
import math

import numpy as np

from fieldhand.language import message
from fieldhand.site.drives import XY, Drive, Drives
from fieldhand.site.driving.network import aisle_name

#: Metres to keep from the ends of an aisle, where others cross the headland, and from the opening of a gate.
CLEAR_M = 2.0

#: Metres within which the robot is at a marker.
_AT_MARKER_M = 3.0

#: Metres between the points of a way that are looked at.
_STEP_M = 0.5


def safe_stop(drives: Drives, way: Drive, within_m: float) -> float | None:
    """Return how far along a way, at most so many metres, the robot can stand safely; as far as can be.

    It stands safely at a marker, such as the start, and inside an aisle between two rows, clear of the aisle's ends and
    of gates. A way never leads through a keep-out, so no point of it lies in one.

    Args:
        drives: Of the site and the robot.
        way: That it drives along.
        within_m: How far it can drive.

    Returns:
        Metres along the way; None where no point is safe.
    """
    most = min(within_m, way.length_m)
    steps = np.append(np.arange(0.0, max(most, 0.0), _STEP_M), max(most, 0.0))
    points = [way.at(float(metres)) for metres in steps]
    aisles = drives.layout.aisles.at(np.array(points))
    busy = [(x, y) for aisle in drives.layout.aisles.all for x, y in aisle.entries.tolist()]
    markers = [place.xy for place in drives.site.markers.values()]
    gates = [(gate.place.xy, gate.width_m / 2.0) for gate in drives.site.gates]
    for metres, point, aisle in sorted(zip(steps.tolist(), points, aisles, strict=True), key=lambda one: -one[0]):
        in_aisle = aisle is not None and _is_clear(point, busy, gates)
        if in_aisle or any(math.dist(point, at) <= _AT_MARKER_M for at in markers):
            return float(metres)
    return None


def location_words(drives: Drives, at: XY) -> str:
    """Say where a point lies: "the aisle between rows 3 and 4", "the open"."""
    aisle = drives.layout.aisle(at)
    if aisle is None:
        return message("the open", context="log")
    return message("the {known}", context="log", known=aisle_name(drives.site, aisle))


def _is_clear(point: XY, busy: list[XY], gates: list[tuple[XY, float]]) -> bool:
    apart = itertools.chain(((at, 0.0) for at in busy), gates)
    return all(math.dist(point, at) >= CLEAR_M + half_m for at, half_m in apart)
