"""Explain why a robot cannot reach a place, in words that follow "tree 17 is"."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
import shapely

from fieldhand.language import Number, counted, message
from fieldhand.site.driving.aisles import Aisle
from fieldhand.site.driving.graph import Points
from fieldhand.site.driving.layout import Layout, Spot
from fieldhand.site.driving.stands import Candidate

#: Tolerance in metres within which ground counts as inside an aisle.
_TOUCH_M = 0.01


def no_stand(candidates: Sequence[Candidate], robot_m: float) -> str:
    """Return the reason why a robot of this width can use none of the candidates."""
    widths = [c.aisle_m for c in candidates]
    if all(width is not None for width in widths):
        return message("out of reach: {reason}", reason=_narrow(widths, robot_m))
    reasons = [c.why_not if c.aisle_m is None else _narrow([c.aisle_m], robot_m) for c in candidates]
    return message("out of reach: {reason}", reason=_together(tuple(dict.fromkeys(reasons))))


def cut_off(layout: Layout, spots: Sequence[Spot], start: Spot) -> str:
    """Return the reason why no path leads from the start to any of the spots."""
    for spot in spots:
        aisle = layout.aisle(spot.xy)
        if aisle is not None and (spot.part < 0 or aisle.polygon.buffer(_TOUCH_M).covers(layout.part(spot.part))):
            return message("out of reach: no way out of its aisle: {ends}", ends=_ends(layout, aisle, spot))
    line = shapely.LineString([spots[0].xy, start.xy])
    between = layout.free.in_the_way(line) if layout.free.bounded else ""
    if between:
        return message("cut off from where the robot starts by {obstacle}", obstacle=between)
    return message("cut off from where the robot starts")


def _narrow(widths: Sequence[float | None], robot_m: float) -> str:
    found = sorted({max(width, 0.0) for width in widths if width is not None})
    text = _together(tuple(dict.fromkeys(message("{number} m", number=_metres(width)) for width in found)))
    return counted(
        "the aisle beside it is {width} wide, the robot is {robot} m",
        "the aisles beside it are {width} wide, the robot is {robot} m",
        len(widths),
        width=text,
        robot=_metres(robot_m),
    )


def _metres(value: float) -> str:
    return Number(f"{value:.2g}")


def _together(parts: Sequence[str]) -> str:
    """Join clauses with "and"."""
    text = parts[0]
    for part in parts[1:]:
        text = message("{clause} and {other}", clause=text, other=part)
    return text


def _ends(layout: Layout, aisle: Aisle, spot: Spot) -> str:
    """Return the obstacles that close the two ends of the aisle around a spot."""
    one, two = _closed_by(layout, aisle, spot, 0), _closed_by(layout, aisle, spot, 1)
    if one == two:
        return message("{obstacle} closes both ends", obstacle=one)
    return message("{obstacle} closes one end and {other} the other", obstacle=one, other=two)


def _closed_by(layout: Layout, aisle: Aisle, spot: Spot, end: Literal[0, 1]) -> str:
    middle, ((u, _),) = aisle.middle_line, aisle.frame.local(np.array([spot.xy])).tolist()
    ahead: Points = middle[middle[:, 0] > u] if end == 1 else middle[middle[:, 0] < u][::-1]
    if not len(ahead):
        ahead = middle[[-end]]
    line = shapely.LineString([spot.xy, *aisle.frame.world(ahead)])
    return layout.free.in_the_way(line) or message("another row")
