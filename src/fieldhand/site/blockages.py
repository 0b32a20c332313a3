"""Areas that a robot found blocked during a mission, and drives that avoid them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from fieldhand.site.drives import XY, Drives
from fieldhand.site.driving.layout import Layout
from fieldhand.site.model import Zone

#: Initial half width of a blocked area on open ground, in clearances.
_WIDE = 1.5

#: Blocked areas closer than this to one another, in metres, belong to the same obstacle.
_SAME_M = 1.0

#: Distance in metres from the stopped robot's centre to the blocked area, so that the robot can turn around. If its
#: goal is nearer than that, the area begins halfway, so that it contains the goal.
_AHEAD_M = 0.3

#: Length in metres of a blocked area along the path.
_LONG_M = 1.0

#: Distance in metres between a blocked area and the rows beside it, so that it contains no trees.
_BEFORE_ROW_M = 0.05

#: Half the width in metres of a blocked area where a robot would have stood.
_STAND_M = 0.5

#: Least distance in metres from a robot to a blocked area.
_BESIDE_M = 1e-3


class Blockages:
    """Blocked areas, and the drives around them.

    Args:
        drives: Drives of the site as it was approved.

    Attributes:
        drives: Remaining drives, which treat blocked areas as keep-outs.
        stretches: Blocked areas in metres east and north.
        version: Number that changes whenever the drives do.
    """

    def __init__(self, drives: Drives) -> None:
        self._all = self.drives = drives
        self.stretches: tuple[Polygon, ...] = ()
        self.version = 0

    def add_ahead(self, at: XY, towards: XY) -> Polygon:
        """Add a blocked area ahead of a robot that was stopped on its way to a point.

        Each further area of the same obstacle on open ground is twice as wide as the one before.

        Args:
            at: Position of the robot.
            towards: Point that it was driving to.

        Returns:
            The area that is treated as blocked from now on.
        """
        # The robot's own position is free, even if it was reported blocked from another side.
        self.stretches = tuple(s for s in self.stretches if s.distance(shapely.Point(at)) > _BESIDE_M)
        near = shapely.Point(at).buffer(_SAME_M)
        known = sum(stretch.intersects(near) for stretch in self.stretches)
        half_width_m = _WIDE * self._all.clearance_m * 2.0 ** min(known, 6)
        stretch = _blocked_ahead(self._all.layout, at, towards, half_width_m)
        self.replace((*self.stretches, stretch))
        return stretch

    def add_stand(self, stand: XY, at: XY) -> Polygon:
        """Add a blocked area where a robot would have stood; what it leaves free of an aisle can be driven.

        Args:
            stand: Where the robot would have stood.
            at: Position of the robot, which stays free.

        Returns:
            The area that is treated as blocked from now on.
        """
        x, y = stand
        away_m = max(abs(at[0] - x), abs(at[1] - y))
        half_m = max(_BESIDE_M, min(_STAND_M, max(away_m - _AHEAD_M, away_m / 2.0)))
        square = shapely.box(x - half_m, y - half_m, x + half_m, y + half_m)
        self.replace((*self.stretches, square))
        return square

    def replace(self, stretches: Sequence[Polygon]) -> None:
        """Replace all blocked areas."""
        self.stretches, self.version = tuple(stretches), self.version + 1
        self.drives = _without(self._all, self.stretches) if stretches else self._all


def _without(drives: Drives, stretches: Sequence[Polygon]) -> Drives:
    zones = tuple(
        Zone(name=f"blocked stretch {number}", kind="keep_out", polygon=polygon)
        for number, polygon in enumerate(stretches, start=1)
    )
    site = dataclasses.replace(drives.site, zones=(*drives.site.zones, *zones))
    vars(site)["planting"] = drives.site.planting  # the rows do not change
    return Drives(site, drives.clearance_m, drives.standoff_m, closed=drives.closed)


def _blocked_ahead(layout: Layout, at: XY, towards: XY, half_width_m: float) -> Polygon:
    """Return the area to treat as blocked ahead of a robot that was stopped.

    In an aisle it spans the whole width from row to row, since the robot itself found no way past; on open ground it is
    a square.

    Args:
        layout: Drivable layout of the site.
        at: Position of the stopped robot, in metres.
        towards: Next point of its path, in metres.
        half_width_m: Half the width of the area on open ground.
    """
    length = math.dist(at, towards)
    gap = min(_AHEAD_M, length / 2.0) if length > 0.0 else _AHEAD_M
    ux, uy = ((towards[0] - at[0]) / length, (towards[1] - at[1]) / length) if length > 0.0 else (1.0, 0.0)
    aisle = layout.aisle(at)
    if aisle is not None:
        frame = aisle.frame
        (u, v), (u1, v1) = frame.local(np.array([at, (at[0] + ux, at[1] + uy)])).tolist()
        if abs(u1 - u) > abs(v1 - v):
            along = math.copysign(1.0, u1 - u)
            near, far = u + along * gap, u + along * (gap + _LONG_M)
            _, wide = aisle.width(np.array([near, far])).tolist()
            corners = np.array([(near, v - wide), (far, v - wide), (far, v + wide), (near, v + wide)])
            strip = Polygon(frame.world(corners))
            add_ahead = aisle.polygon.buffer(-_BEFORE_ROW_M).intersection(strip)
            if (largest := _largest(add_ahead)) is not None:
                return largest
    px, py = -uy, ux
    x, y = at[0] + ux * gap, at[1] + uy * gap
    w, d = half_width_m, max(_LONG_M, 2.0 * half_width_m)
    return Polygon(
        [
            (x + px * w, y + py * w),
            (x + ux * d + px * w, y + uy * d + py * w),
            (x + ux * d - px * w, y + uy * d - py * w),
            (x - px * w, y - py * w),
        ]
    )


def _largest(shape: BaseGeometry) -> Polygon | None:
    parts = [p for p in shapely.get_parts(shape) if isinstance(p, Polygon) and p.area > 0.0]
    return max(parts, key=lambda p: p.area, default=None)
