"""Choose safe stopping points along a drive, and describe locations in words."""

from __future__ import annotations

import itertools
import math

import numpy as np

from fieldhand.language import message
from fieldhand.site.drives import XY, Drive, Drives
from fieldhand.site.driving.network import aisle_name

#: Metres to keep from the ends of an aisle, where others cross the headland, and from the opening of a gate.
CLEAR_M = 2.0

#: Within this distance in metres the robot counts as at a marker.
_AT_MARKER_M = 3.0

#: Distance in metres between the points of a path that are examined.
_STEP_M = 0.5


def safe_stop(drives: Drives, way: Drive, within_m: float) -> float | None:
    """Return the distance to the farthest safe stopping point within a given distance along a path.

    Safe points are at a marker, such as the start, or inside an aisle between two rows, clear of the aisle's ends and
    of gates. Paths never lead through keep-outs.

    Args:
        drives: Drives of the site and the robot.
        way: Path of the robot.
        within_m: Remaining range in metres.

    Returns:
        Metres along the path; None if no point is safe.
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
    """Return the location of a point in words: "the aisle between rows 3 and 4", "the open"."""
    aisle = drives.layout.aisle(at)
    if aisle is None:
        return message("the open", context="log")
    return message("the {known}", context="log", known=aisle_name(drives.site, aisle))


def _is_clear(point: XY, busy: list[XY], gates: list[tuple[XY, float]]) -> bool:
    apart = itertools.chain(((at, 0.0) for at in busy), gates)
    return all(math.dist(point, at) >= CLEAR_M + half_m for at, half_m in apart)
