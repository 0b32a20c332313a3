"""Ground on which a mission drives slowly, and the time that it adds to a path."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from fieldhand.errors import PlaceError
from fieldhand.forecast.closed_ground import ground_of, say_avoided
from fieldhand.forecast.visit_order import drives_for
from fieldhand.language import message
from fieldhand.language.words import say_number

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.model import Site
    from fieldhand.task.frames import Constraints
    from fieldhand.task.ways import SlowNear

XY = tuple[float, float]

#: Metres of path before slow ground and behind it that are driven slowly, too: a robot has a length.
BESIDE_M = 0.5

#: Parts shorter than this, in metres, count as nothing.
_NOTHING_M = 1e-6


@dataclass(frozen=True, kw_only=True)
class SlowPart:
    """A part of a path with a speed limit of its own."""

    from_m: float
    to_m: float
    speed_m_s: float


class SlowGround:
    """The slow ground of a mission.

    Args:
        grounds: Outlines in metres east and north, each with its speed limit in m/s.
    """

    def __init__(self, grounds: Sequence[tuple[BaseGeometry, float]] = ()) -> None:
        self._grounds = [(shape, speed) for shape, speed in grounds if not shape.is_empty]
        for shape, _ in self._grounds:
            shapely.prepare(shape)

    @property
    def slowest_m_s(self) -> float:
        """Return the lowest limit in m/s; infinite without slow ground."""
        return min((speed for _, speed in self._grounds), default=math.inf)

    @property
    def grounds(self) -> tuple[tuple[BaseGeometry, float], ...]:
        """Return the outlines in metres east and north, each with its speed limit in m/s."""
        return tuple(self._grounds)

    def __bool__(self) -> bool:
        return bool(self._grounds)

    def parts(self, points: Sequence[XY]) -> tuple[SlowPart, ...]:
        """Return the slow parts of a path in order; they do not overlap, and the lowest limit applies."""
        if not self._grounds or len(points) < 2:
            return ()
        at = np.asarray(points, dtype=np.float64)
        ends = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(at, axis=0).T))])
        whole = float(ends[-1])
        found = [
            (max(0.0, a - BESIDE_M), min(whole, b + BESIDE_M), speed)
            for shape, speed in self._grounds
            for a, b in _inside(at, ends, shape)
        ]
        cuts = sorted({cut for a, b, _ in found for cut in (a, b)})
        parts: list[SlowPart] = []
        for a, b in itertools.pairwise(cuts):
            limits = [speed for begin, end, speed in found if begin <= a and b <= end]
            if not limits or b - a < _NOTHING_M:
                continue
            last = parts[-1] if parts else None
            if last is not None and last.to_m >= a - _NOTHING_M and last.speed_m_s == min(limits):
                parts[-1] = SlowPart(from_m=last.from_m, to_m=b, speed_m_s=last.speed_m_s)
            else:
                parts.append(SlowPart(from_m=a, to_m=b, speed_m_s=min(limits)))
        return tuple(parts)

    def pieces(self, points: Sequence[XY], length_m: float, speed_m_s: float) -> tuple[SlowPart, ...]:
        """Return a whole path in pieces of one speed each, in order: ``speed_m_s``, or that of slow ground if lower.

        A piece of less than :data:`BESIDE_M` between slow ground is driven as slowly as the one before.
        """
        pieces: list[SlowPart] = []
        slow = [part for part in self.parts(points) if part.speed_m_s < speed_m_s]
        for part in (*slow, SlowPart(from_m=length_m, to_m=length_m, speed_m_s=speed_m_s)):
            at = pieces[-1].to_m if pieces else 0.0
            if part.from_m - at >= (BESIDE_M if pieces else _NOTHING_M) or not (pieces or part.to_m > at):
                pieces.append(SlowPart(from_m=at, to_m=part.from_m, speed_m_s=speed_m_s))
            elif pieces:
                pieces[-1] = replace(pieces[-1], to_m=part.from_m)
            if part.to_m > part.from_m:
                pieces.append(part)
        return tuple(pieces)

    def extra_s(self, points: Sequence[XY], speed_m_s: float) -> float:
        """Return the seconds that slow ground adds to a path that is otherwise driven at a speed."""
        if not self._grounds:
            return 0.0
        length_m = sum(math.dist(a, b) for a, b in itertools.pairwise(points))
        pieces = self.pieces(points, length_m, speed_m_s)
        return sum((p.to_m - p.from_m) * (1.0 / p.speed_m_s - 1.0 / speed_m_s) for p in pieces)


NO_SLOW_GROUND = SlowGround()


def _inside(points: np.ndarray, ends: np.ndarray, shape: BaseGeometry) -> list[tuple[float, float]]:
    """Return the intervals of a path inside a shape, segment by segment, since a path may cross itself."""
    lines: Any = shapely.linestrings(np.stack([points[:-1], points[1:]], axis=1))
    touched = np.flatnonzero(shapely.intersects(shape, lines))
    found: list[tuple[float, float]] = []
    for k in touched.tolist():
        for part in shapely.get_parts(shapely.intersection(lines[k], shape)):
            if part.is_empty:
                continue  # two corners at the same point
            away = np.hypot(*(shapely.get_coordinates(part) - points[k]).T)
            found.append((float(ends[k] + away.min()), float(ends[k] + away.max())))
    return found


def slow_ground(constraints: Constraints, site: Site, robot: RobotProfile) -> SlowGround:
    """Return the slow ground of a mission, cached.

    Raises:
        PlaceError: A selector finds nothing, needs a position of the robot, or names places without an extent.
    """
    if not constraints.slow:
        return NO_SLOW_GROUND
    slow = tuple((one.places, one.distance_m, slow_speed(one.speed_m_s, robot)) for one in constraints.slow)
    key = ("slow ground", robot.width_m, robot.standoff_m, slow)
    known = site.cache.get(key)
    if not isinstance(known, SlowGround):
        drives = drives_for(site, robot)
        grounds = [(ground_of(p, metres, drives).shape, speed) for p, metres, speed in slow]
        known = site.cache[key] = SlowGround(grounds)
    return known


def slow_speed(speed_m_s: float | None, robot: RobotProfile) -> float:
    """Return the given speed, or that of a robot that is to drive slowly without one."""
    return robot.slowly_m_s if speed_m_s is None else speed_m_s


def slow_problem(slow: SlowNear, site: Site, robot: RobotProfile) -> PlaceError | None:
    """Return why slow ground cannot be found on a site; None if it can."""
    try:
        ground_of(slow.places, slow.distance_m, drives_for(site, robot))
    except PlaceError as error:
        return error
    return None


def say_slow_ground(slow: SlowNear) -> str:
    """Return where a mission drives slowly: "within 10 m of the pond", "in row 5"."""
    if not slow.distance_m:
        return message("in {place}", place=say_avoided(slow.places))
    return message(
        "within {distance} m of {place}", distance=say_number(slow.distance_m), place=say_avoided(slow.places)
    )


def rests(points: Sequence[XY], from_m: float) -> tuple[XY, ...]:
    """Return a path from a distance along it to its end; its last two points are the same if nothing is left."""
    left, corners = from_m, list(points)
    while len(corners) > 2 and left >= (step := math.dist(corners[0], corners[1])):
        left, corners = left - step, corners[1:]
    (x0, y0), (x1, y1) = corners[0], corners[1]
    step = math.dist(corners[0], corners[1])
    part = 0.0 if step <= 0.0 else min(1.0, max(0.0, left) / step)
    return ((x0 + part * (x1 - x0), y0 + part * (y1 - y0)), *corners[1:])
