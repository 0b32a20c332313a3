"""The stretch of ground that a robot found blocked: what nobody may drive over until it is known to be free."""

from __future__ import annotations

import math

import numpy as np
import shapely
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from fieldhand.site.driving.layout import XY, Layout

#: Metres from the robot's middle, where it was stopped, to the stretch: it must be able to turn round there. Where it
#: was stopped nearer than that to its goal the stretch begins halfway, so that the goal is in it.
AHEAD_M = 0.3

#: Metres of the stretch along the way.
LONG_M = 1.0

#: Metres that a stretch ends before a row: the trees themselves are not in it.
_BEFORE_ROW_M = 0.05


def blocked_stretch(layout: Layout, at: XY, towards: XY, half_width_m: float) -> Polygon:
    """What is taken as blocked ahead of a robot that was stopped.

    In an aisle that is all of it from row to row, since the robot itself found no way past; on open ground a square.

    Args:
        layout: The site as the robot drives on it.
        at: Where the robot was stopped, in metres.
        towards: Where it was to drive on to, the end of its way at most.
        half_width_m: Half the width on open ground.
    """
    length = math.dist(at, towards)
    gap = min(AHEAD_M, length / 2.0) if length > 0.0 else AHEAD_M
    ux, uy = ((towards[0] - at[0]) / length, (towards[1] - at[1]) / length) if length > 0.0 else (1.0, 0.0)
    aisle = layout.aisle(at)
    if aisle is not None:
        frame = aisle.frame
        (u, v), (u1, v1) = frame.local(np.array([at, (at[0] + ux, at[1] + uy)])).tolist()
        if abs(u1 - u) > abs(v1 - v):
            along = math.copysign(1.0, u1 - u)
            near, far = u + along * gap, u + along * (gap + LONG_M)
            _, wide = aisle.width(np.array([near, far])).tolist()
            corners = np.array([(near, v - wide), (far, v - wide), (far, v + wide), (near, v + wide)])
            strip = Polygon(frame.world(corners))
            found = aisle.polygon.buffer(-_BEFORE_ROW_M).intersection(strip)
            if (largest := _largest(found)) is not None:
                return largest
    px, py = -uy, ux
    x, y = at[0] + ux * gap, at[1] + uy * gap
    w, d = half_width_m, max(LONG_M, 2.0 * half_width_m)
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
