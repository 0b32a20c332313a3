"""A stretch: a path that is driven in one piece while an implement is on along parts of it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from shapely.geometry import LineString, Point
from shapely.ops import substring

XY = tuple[float, float]
#: Begin and end along a path, in metres.
Interval = tuple[float, float]

#: Parts shorter than this, in metres, count as nothing.
NOTHING_M = 0.05


@dataclass(frozen=True, kw_only=True)
class Stretch:
    """A path that is driven in one piece.

    Attributes:
        name: Name for logs and reports, such as "row 3, west side"; unique among the stretches of a node.
        points: Corners in local metres, at least two.
        on: Intervals along the path in which the implement is on, in order and disjoint.
        one_way: True if it must be driven in this direction, as an implement on one side requires.
    """

    name: str
    points: tuple[XY, ...]
    on: tuple[Interval, ...]
    one_way: bool = False

    @cached_property
    def length_m(self) -> float:
        """Return the length of the path in metres."""
        return sum(math.dist(a, b) for a, b in itertools.pairwise(self.points))

    @property
    def on_m(self) -> float:
        """Return the metres on which the implement is on."""
        return total_m(self.on)

    @property
    def begin(self) -> XY:
        """Return the first point."""
        return self.points[0]

    @property
    def end(self) -> XY:
        """Return the last point."""
        return self.points[-1]

    @cached_property
    def line(self) -> LineString:
        """Return the path as a line."""
        return LineString(self.points)

    def reversed(self) -> Stretch:
        """Return the same path driven the other way."""
        length = self.length_m
        on = tuple((max(0.0, length - b), max(0.0, length - a)) for a, b in reversed(self.on))
        return replace(self, points=self.points[::-1], on=on)

    def part(self, begin_m: float, end_m: float) -> Stretch | None:
        """Return the part between two distances along the path; None if it is too short to be driven."""
        begin_m, end_m = max(0.0, begin_m), min(self.length_m, end_m)
        if end_m - begin_m < NOTHING_M:
            return None
        cut = substring(self.line, begin_m, end_m)
        points = tuple((float(x), float(y)) for x, y in cut.coords)
        return replace(self, points=points, on=within(self.on, begin_m, end_m, shifted=True))

    def project(self, xy: XY, *, after_m: float = 0.0, before_m: float = math.inf) -> float:
        """Return the distance along the path of the point nearest to ``xy``, in metres.

        Args:
            xy: A point in local metres.
            after_m, before_m: Part of the path that is searched, as a path may come back to where it began.
        """
        after_m, before_m = min(max(0.0, after_m), self.length_m), min(self.length_m, before_m)
        if before_m - after_m < NOTHING_M:
            return after_m
        return after_m + float(substring(self.line, after_m, before_m).project(Point(xy)))

    def away_m(self, xy: XY) -> float:
        """Return the distance in metres from a point to the path."""
        return float(self.line.distance(Point(xy)))


def total_m(intervals: Iterable[Interval]) -> float:
    """Return the total length of intervals in metres."""
    return sum(b - a for a, b in intervals)


def within(
    intervals: Iterable[Interval], begin_m: float, end_m: float, *, shifted: bool = False
) -> tuple[Interval, ...]:
    """Return the parts of intervals between two distances, measured from ``begin_m`` if ``shifted``."""
    by = begin_m if shifted else 0.0
    cut = ((max(a, begin_m), min(b, end_m)) for a, b in intervals)
    return tuple((a - by, b - by) for a, b in cut if b - a > NOTHING_M)


def joined(intervals: Iterable[Interval], *, gap_m: float = NOTHING_M) -> tuple[Interval, ...]:
    """Return intervals in order, with those joined that overlap or are at most ``gap_m`` apart."""
    found: list[Interval] = []
    for a, b in sorted(intervals):
        if found and a - found[-1][1] <= gap_m:
            found[-1] = (found[-1][0], max(b, found[-1][1]))
        else:
            found.append((a, b))
    return tuple(found)


def pieces(points: Sequence[XY], intervals: Iterable[Interval]) -> tuple[tuple[XY, ...], ...]:
    """Return the parts of a path within intervals, as points."""
    line = LineString(points)
    cut = (substring(line, a, b) for a, b in intervals if b - a > NOTHING_M)
    return tuple(tuple((float(x), float(y)) for x, y in part.coords) for part in cut if part.length > 0)
