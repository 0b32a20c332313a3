"""Drives along the edge of an area, and patrols along rings and lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import LineString, MultiPolygon, Point, Polygon

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.site.coverage.ground import TransitGround
from fieldhand.site.coverage.headland import rings_at
from fieldhand.site.coverage.plan import XY, CoverageLeg
from fieldhand.site.driving.graph import Points

#: Chords per quarter turn around a corner: a ring is less than 1 % nearer to it than the distance asked for.
_CHORDS = 16

#: Points closer than this in metres are the same.
_SAME_M = 1e-6


@dataclass(frozen=True, kw_only=True)
class Circuit:
    """A drive along rings or lines.

    Attributes:
        legs: The whole drive, in order and connected: ``headland`` along a ring or line, ``transit`` between them.
    """

    legs: tuple[CoverageLeg, ...]

    @property
    def working_m(self) -> float:
        """Return the metres along rings and lines."""
        return sum(leg.length_m for leg in self.legs if leg.works)

    @property
    def transit_m(self) -> float:
        """Return the metres between them."""
        return sum(leg.length_m for leg in self.legs if not leg.works)

    @property
    def length_m(self) -> float:
        """Return the metres of the whole drive."""
        return self.working_m + self.transit_m


def perimeter(
    area: Polygon | MultiPolygon,
    inset_m: float,
    *,
    rings: int = 1,
    apart_m: float = 0.0,
    holes: bool = False,
    clockwise: bool = True,
    start: XY | None = None,
    ground: TransitGround | None = None,
) -> Circuit:
    """Plan a drive around an area.

    Args:
        area: Area in local metres.
        inset_m: Distance of the outermost ring from the edge: half the working width, or the robot's clearance.
        rings: Number of rings around the area, from the edge inwards.
        apart_m: Distance from ring to ring; it must be given for more than one.
        holes: Drive around the holes of the area, too; not around the outer edge only.
        clockwise: Direction as seen from above, around the area and around holes.
        start: Point near which the drive begins; None to begin at a corner.
        ground: Ground for the drives between rings; None to go straight.

    Raises:
        PlaceError: The area is too narrow for a ring, or the distances are out of range.
    """
    if not inset_m >= 0.0 or rings < 1 or (rings > 1 and not apart_m > 0.0):
        raise PlaceError(
            message("a perimeter needs at least one ring, and distances that are not negative"),
            advice=message("correct the distance from the edge, or the distance between rings"),
        )
    lines = []
    for metres in (inset_m + apart_m * np.arange(rings)).tolist():
        found = rings_at(area, metres, holes=holes, chords=_CHORDS)
        if not found:
            raise PlaceError(
                message("the area is too narrow for a drive {metres} m inside its edge", metres=f"{metres:g}"),
                advice=message("choose a smaller distance from the edge, or fewer rings"),
            )
        lines += [ring[::-1] if clockwise else ring for ring in found]
    return patrol([_xy(line) for line in lines], start=start, ground=ground)


def patrol(
    lines: Sequence[Sequence[XY]],
    *,
    laps: int = 1,
    start: XY | None = None,
    ground: TransitGround | None = None,
) -> Circuit:
    """Plan a drive along rings and open lines, one after the other, in each of several laps.

    A ring is begun at its point nearest to where the drive comes from. An open line is begun at its nearer end; in the
    next lap it is driven from whichever end is nearer then, so a single line is driven there and back.

    Args:
        lines: Rings (the last point equals the first) and open lines, in the order in which they are driven.
        laps: Number of times that all of them are driven.
        start: Point from which the drive comes; None to begin at the first point of the first line.
        ground: Ground for the drives between the lines; None to go straight.

    Raises:
        PlaceError: There is no line, a line has no length, or no way connects two of them.
    """
    found = [np.array(line, dtype=np.float64).reshape(-1, 2) for line in lines]
    if laps < 1 or not found or any(len(line) < 2 or LineString(line).length < _SAME_M for line in found):
        raise PlaceError(
            message("a patrol needs at least one lap, and lines that have a length"),
            advice=message("name the edge of an area, or a line with two different points"),
        )
    legs: list[CoverageLeg] = []
    at = start
    for line in found * laps:
        path = _xy(_begun(line, at))
        if legs and at is not None and np.hypot(path[0][0] - at[0], path[0][1] - at[1]) > _SAME_M:
            way = (at, path[0]) if ground is None else ground.way(at, path[0])
            if way is None:
                raise PlaceError(
                    message("no way connects the lines of the patrol"),
                    advice=message("patrol each of them separately"),
                )
            legs.append(CoverageLeg(kind="transit", points=way))
        legs.append(CoverageLeg(kind="headland", points=path))
        at = path[-1]
    return Circuit(legs=tuple(legs))


def _begun(line: Points, at: XY | None) -> Points:
    """Return a line from its nearer end, or a ring from its point nearest to where the drive comes from."""
    if at is None:
        return line
    if np.hypot(*(line[0] - line[-1])) > _SAME_M:
        near, far = np.hypot(*(line[[0, -1]] - at).T).tolist()
        return line[::-1] if far < near - _SAME_M else line
    ring = LineString(line)
    along = float(ring.project(Point(at)))
    if along < _SAME_M or along > ring.length - _SAME_M:
        return line
    reached = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    first = int(np.searchsorted(reached, along + _SAME_M))
    begin = shapely.get_coordinates(ring.interpolate(along))
    before = line[1:first]
    if len(before) and np.hypot(*(before[-1] - begin[0])) < _SAME_M:
        before = before[:-1]
    return np.vstack([begin, line[first:], before, begin])


def _xy(line: Points) -> tuple[XY, ...]:
    return tuple((x, y) for x, y in line.tolist())
