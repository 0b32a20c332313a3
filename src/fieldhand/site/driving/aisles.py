"""Moves within one aisle: the strip between two neighbouring rows, from mouth to mouth."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from fieldhand.site.driving.bodies import Body
from fieldhand.site.driving.free import Area, Free
from fieldhand.site.driving.ground import XY, Ground
from fieldhand.site.driving.rowlines import Line, Points, RowLine, simplified_above
from fieldhand.site.driving.taut import taut, taut_lengths

#: How a robot moves in it: along straight lines; along bent rows; around something that is in it; not at all.
Course = Literal["straight", "bent", "obstructed", "closed"]

#: An aisle in which something stands has sides with at most so many corners, or gives up this part of its width.
_MANY_CORNERS = 120
_SIDES = (0.0, 0.01, 0.03, 0.1)
_MOST_ROOM = 0.7

#: The middle of bent rows is drawn with this tolerance, part of the aisle's width.
_MIDDLE = 0.05

#: A mouth that is not free in its middle is looked for at so many points across.
_MOUTHS = 21

#: One row is longer than the next by this many widths of the aisle.
_ASLANT = 0.7


@dataclass(frozen=True, eq=False)
class Aisle:
    """The strip between two neighbouring rows of a body.

    Attributes:
        number: Of the aisle on the site.
        body_number: Position of its body.
        low, high: v between which the robot is clear of both rows all the way; ``low > high`` where rows are not
            straight enough for that.
    """

    number: int
    body_number: int
    body: Body
    below: RowLine
    above: RowLine
    free: Free
    course: Course

    @property
    def low(self) -> float:
        """Above this v the robot is clear of the row below all the way."""
        return self.below.top

    @property
    def high(self) -> float:
        """Below this v the robot is clear of the row above all the way."""
        return self.above.bottom

    @cached_property
    def sides(self) -> tuple[Points, Points, Points]:
        """u, and the least and greatest v there at which the robot is clear of the rows; whole length of the aisle."""
        (lu, lv), (hu, hv) = self.below.upper, self.above.lower
        first, last = self._span
        u = np.unique(np.concatenate([[first], lu, hu, [last]]))
        return u, np.interp(u, lu, lv), np.interp(u, hu, hv)

    def bounds(self, u: Points) -> tuple[Points, Points]:
        """The least and greatest v at which the robot is clear of the rows at each u."""
        return np.interp(u, *self.below.upper), np.interp(u, *self.above.lower)

    def width(self, u: Points | float) -> Points:
        """Metres from row to row at each u."""
        return np.asarray(np.interp(u, self.above.u, self.above.low) - np.interp(u, self.below.u, self.below.high))

    def middle(self, u: Points | float) -> Points:
        """v halfway between the rows at each u."""
        low, high = np.interp(u, self.below.u, self.below.high), np.interp(u, self.above.u, self.above.low)
        return np.asarray((low + high) / 2.0)

    @property
    def middle_line(self) -> Points:
        """(u, v) halfway between the rows, from outline to outline, with few points; shape (n, 2)."""
        v0, v1 = self.middle(np.array([-np.inf, np.inf])).tolist()
        start, end = self.body.reaches(v0)[0], self.body.reaches(v1)[1]
        if self.low <= self.high:
            return np.array([[start, (self.low + self.high) / 2.0], [end, (self.low + self.high) / 2.0]])
        u = self.sides[0]
        u = np.concatenate([[start], u[(u > start) & (u < end)], [end]])
        tolerance = _MIDDLE * abs(float(self.width(u[len(u) // 2])))
        line = shapely.linestrings(np.column_stack([u, self.middle(u)]))
        return shapely.get_coordinates(shapely.simplify(line, tolerance))

    def way(self, a: Points, b: Points) -> Points | None:
        """The points of the shortest way within the aisle between two of its spots (u, v); None if there is none.

        A spot nearer to a row than the robot's clearance is left straight across the aisle.
        """
        if self.course == "closed":
            return None
        if self.course == "obstructed":
            ends = self.body.frame.world(np.array([a, b])).tolist()
            points = self._ground.way((ends[0][0], ends[0][1]), (ends[1][0], ends[1][1]))
            return None if points is None else self.body.frame.local(np.array(points))
        one, two = self.clear_of_rows(np.array([a, b]))
        straight = self._is_inside(one[1]) and self._is_inside(two[1])
        inner = np.array([one, two]) if straight else self._taut(one, two)
        return np.vstack([a[None, :], inner, b[None, :]])

    def metres(self, a: Points, b: Points) -> float:
        """Of :meth:`way`; inf if there is none."""
        return float(self.metres_from(a, b[None, :])[0])

    def metres_from(self, a: Points, spots: Points) -> Points:
        """Metres of the ways from one spot to each of these, shape (n,); inf where there is none."""
        if self.course == "closed":
            return np.full(len(spots), np.inf)
        if self.course == "obstructed":
            return self._ground.lengths(self.body.frame.world(a[None, :]), self.body.frame.world(spots)).ravel()
        one, two = self.clear_of_rows(a[None, :])[0], self.clear_of_rows(spots)
        found = np.hypot(*(two - one).T)
        bent = ~(self._is_inside(one[1]) & self._is_inside(two[:, 1]))
        if bent.any():
            found[bent] = taut_lengths(*self.sides, one, two[bent])
        return np.asarray(found + np.abs(a[1] - one[1]) + np.abs(spots[:, 1] - two[:, 1]))

    def metres_between(self, one: Points, two: Points) -> Points:
        """Metres of the way from each of these spots to its counterpart of those, shape (n,); inf: there is none."""
        straight = (self.course == "straight") & self._is_inside(one[:, 1]) & self._is_inside(two[:, 1])
        found = np.hypot(*(two - one).T)
        for k in np.flatnonzero(~straight).tolist():
            found[k] = self.metres(one[k], two[k])
        return np.asarray(found)

    def foot(self, spot: Points) -> tuple[XY, float] | None:
        """Where a spot reaches ground on which ways keep their clearance, in an aisle in which something stands."""
        if self.course != "obstructed":
            return None
        ((x, y),) = self.body.frame.world(spot[None, :]).tolist()
        return self._ground.foot((x, y))

    def lengths(self, rows: Points, columns: Points | None = None) -> Points:
        """Metres of the ways from each of these spots to each of those (the same if none are given), shape (n, m);
        inf where there is none."""
        if self.course == "obstructed":
            world = self.body.frame.world
            return self._ground.lengths(world(rows), None if columns is None else world(columns))
        same = columns is None
        spots = rows if columns is None else columns
        found = np.full((len(rows), len(spots)), np.inf)
        if self.course == "closed":
            return found
        one, two = self._is_inside(rows[:, 1]), self._is_inside(spots[:, 1])
        found[np.ix_(one, two)] = np.hypot(*(rows[one, None] - spots[None, two]).transpose(2, 0, 1))
        for i in np.flatnonzero(~one | ~two.all()).tolist():
            rest = np.flatnonzero(~two | ~one[i])
            rest = rest[rest > i] if same else rest
            found[i, rest] = self.metres_from(rows[i], spots[rest])
            if same:
                found[rest, i] = found[i, rest]
        return found

    def mouths(self, end: Literal[0, 1]) -> Points:
        """Where the robot drives in and out at an end (0: that of least u), (u, v), shape (n, 2); none if it is closed.

        In the middle of the opening; where one row is longer than the next, so that the opening is aslant, also at its
        sides.
        """
        v_out, u_out = self.body.start_outline if end == 0 else self.body.end_outline
        k = -1 * end
        if self.low <= self.high:
            low, high = self.low, self.high
        else:
            low = float(self.below.high[k]) + self.free.clearance_m
            high = float(self.above.low[k]) - self.free.clearance_m
        if low > high:
            return np.empty((0, 2))
        across = np.linspace(low, high, _MOUTHS)
        across = across[np.argsort(np.abs(across - (low + high) / 2.0), kind="stable")]
        spots = np.column_stack([np.interp(across, v_out, u_out), across])
        if self.course == "obstructed":
            open_ = self._soft_area.holds(self.body.frame.world(spots))
            spots = spots[open_]
        if len(spots) < 2 or np.ptp(spots[:, 0]) < _ASLANT * (high - low):
            return spots[:1]
        return np.asarray(spots[np.unique([0, int(spots[:, 1].argmin()), int(spots[:, 1].argmax())])])

    def _is_inside(self, v: Points) -> NDArray[np.bool_]:
        """Whether the robot goes straight from and to this v, wherever along the aisle."""
        return np.asarray((v >= self.low) & (v <= self.high))

    def clear_of_rows(self, spots: Points) -> Points:
        """The spots themselves, or the nearest straight across the aisle where the robot is clear of the rows."""
        low, high = self.bounds(spots[:, 0])
        return np.column_stack([spots[:, 0], np.minimum(np.maximum(spots[:, 1], low), high)])

    def _taut(self, a: Points, b: Points) -> Points:
        if a[0] > b[0]:
            return self._taut(b, a)[::-1]
        u, low, high = self.sides
        if b[0] - a[0] < 1e-9:
            return np.array([a, b])
        inner = (u > a[0]) & (u < b[0])
        return taut(
            np.concatenate([[a[0]], u[inner], [b[0]]]),
            np.concatenate([[a[1]], low[inner], [b[1]]]),
            np.concatenate([[a[1]], high[inner], [b[1]]]),
        )

    # --- where something stands in the aisle --------------------------------------------------------------------

    @cached_property
    def _ground(self) -> Ground:
        hard = unary_union([self.between_rows(clear=False), self.corridor]).intersection(self.free.hard)
        return Ground(_areas(hard), self.soft, self.free.clearance_m)

    @cached_property
    def soft(self) -> BaseGeometry:
        """Where the robot is clear of rows and of all else, in metres east and north."""
        return _areas(self.corridor.intersection(self.free.soft))

    @cached_property
    def _soft_area(self) -> Area:
        return Area(self.soft)

    @cached_property
    def corridor(self) -> BaseGeometry:
        """Where the robot is clear of both rows, in metres east and north, whatever else stands there.

        Past the end of a row it reaches to the row's line, so that a turn into the next aisle is on it like a mouth.
        """
        return _areas(unary_union([self._beside_rows(), *self._past_rows()]))

    def _beside_rows(self) -> BaseGeometry:
        """Where the robot is clear of both rows as if they went on level.

        Sides with very many corners give up a little room: straight from mouth to mouth where that leaves most of it.
        """
        many = len(self.below.u) + len(self.above.u) > _MANY_CORNERS / 2
        if many and self.low <= self.high:
            _, low, high = self.sides
            if self.high - self.low > _MOST_ROOM * float(np.median(high - low)):
                return _areas(self._strip(self.low, self.high).intersection(self.body.polygon))
        for tolerance in _SIDES[int(many) :]:
            corridor = self.between_rows(clear=True, tolerance=tolerance)
            if int(shapely.get_num_coordinates(corridor)) <= _MANY_CORNERS:
                break
        return corridor

    def _past_rows(self) -> Iterator[BaseGeometry]:
        """Beyond the clearance from either end of each row: from its line to where the robot is clear of the other."""
        clearance, (first, last) = self.free.clearance_m, self._span
        for row in (self.below, self.above):
            for k, u0, u1 in ((0, first, row.u[0] - clearance), (-1, row.u[-1] + clearance, last)):
                line = row.u[[k]], (row.low[[k]] + row.high[[k]]) / 2.0
                sides = (line, self.above.lower) if row is self.below else (self.below.upper, line)
                if u0 < u1:
                    yield self._between(*sides, u0, u1)

    @property
    def _span(self) -> tuple[float, float]:
        """The least and the greatest u of the body."""
        (_, start), (_, end) = self.body.start_outline, self.body.end_outline
        return float(start.min()), float(end.max())

    @property
    def hull(self) -> Polygon:
        """A four-cornered area in which the whole aisle lies."""
        return self._strip(float(self.below.high.min()), float(self.above.low.max()))

    def _strip(self, low: float, high: float) -> Polygon:
        """Between two v, as long as the body."""
        u0, u1 = self._span
        return Polygon(self.body.frame.world(np.array([(u0, low), (u1, low), (u1, high), (u0, high)])))

    def between_rows(self, *, clear: bool, tolerance: float = 0.0) -> BaseGeometry:
        """The aisle up to the rows, or up to where the robot is clear of them; in metres east and north.

        Args:
            clear: Of the rows by the robot's clearance.
            tolerance: Part of the width that may be left out where that makes the sides simpler.
        """
        below, above = (self.below.u, self.below.high), (self.above.u, self.above.low)
        if clear:
            below, above = self.below.upper, self.above.lower
        if tolerance > 0.0:
            below, above = self._simplified(below, above, tolerance)
        return self._between(below, above, *self._span)

    def _between(self, below: Line, above: Line, u0: float, u1: float) -> BaseGeometry:
        """From line to line and from u to u, within the body; in metres east and north."""
        u = np.unique(np.concatenate([[u0], below[0], above[0], [u1]]))
        u = u[(u >= u0) & (u <= u1)]
        low, high = np.interp(u, *below), np.interp(u, *above)
        parts = []
        runs = np.flatnonzero(np.diff(np.concatenate([[False], high > low, [False]]).astype(int)))
        for first, last in runs.reshape(-1, 2).tolist():
            if last - first > 1:
                k = slice(first, last)
                ring = np.vstack([np.column_stack([u[k], low[k]]), np.column_stack([u[k], high[k]])[::-1]])
                parts.append(Polygon(self.body.frame.world(ring)).buffer(0.0))
        return _areas(unary_union(parts).intersection(self.body.polygon)) if parts else Polygon()

    def _simplified(self, below: Line, above: Line, part: float) -> tuple[Line, Line]:
        u, low, high = self.sides
        tolerance = part * max(float(np.median(high - low)), 0.1)
        one, two = simplified_above(below, tolerance), simplified_above((above[0], -above[1]), tolerance)
        if (np.interp(u, *one) > -np.interp(u, *two)).any():
            return below, above
        return one, (two[0], -two[1])


def aisles_of(bodies: tuple[Body, ...], free: Free) -> tuple[Aisle, ...]:
    """All aisles of a site, body after body, in their order across the rows."""
    found: list[Aisle] = []
    for number, body in enumerate(bodies):
        for k in range(len(body.lines) - 1):
            below, above = body.lines[k], body.lines[k + 1]
            course: Course = "straight" if below.top <= above.bottom else "bent"
            aisle = Aisle(len(found), number, body, below, above, free, course)
            if course == "bent":
                _, low, high = aisle.sides
                course = "bent" if (low <= high).all() else "obstructed" if (low < high).any() else "closed"
                aisle = replace(aisle, course=course)
            found.append(aisle)
    if not free.bounded:
        return tuple(found)
    # Most aisles are clear of everything by a rough look; only the others are looked at as they really are.
    open_ = [k for k, a in enumerate(found) if a.course in ("straight", "bent")]
    rough = free.covers(np.array([found[k].hull for k in open_]), soft=True) if open_ else np.zeros(0, dtype=bool)
    for k in np.array(open_, dtype=int)[~rough].tolist():
        if not free.covers(found[k].between_rows(clear=True), soft=True)[0]:
            found[k] = replace(found[k], course="obstructed")
    return tuple(found)


def _areas(shape: BaseGeometry) -> BaseGeometry:
    """The areas of an intersection, without its points and lines."""
    parts = [p for p in getattr(shape, "geoms", [shape]) if p.area > 0.0]
    return unary_union(parts) if parts else Polygon()
