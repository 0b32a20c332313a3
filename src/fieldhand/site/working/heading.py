"""Rows, aisles and edges that are driven towards one side of the compass."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.language.words import COMPASS
from fieldhand.site.working.stretch import Stretch
from fieldhand.site.working.units import WorkUnit
from fieldhand.terms import Side

#: Bearings of the lanes of an area, in degrees clockwise from north.
LANE_BEARINGS: Mapping[str, float] = {"north_south": 0.0, "east_west": 90.0}
#: Directions of the sides of the compass in metres east and north.
TOWARDS: Mapping[Side, tuple[float, float]] = {"north": (0, 1), "east": (1, 0), "south": (0, -1), "west": (-1, 0)}
#: An edge faces a side of the compass within 45 degrees.
_FACING_COS = 0.7
#: Pieces of an edge shorter than this, in metres, turn a corner.
_SHORT_M = 1.0
#: A stretch leads towards a side of the compass within 60 degrees.
_LEADS_COS = 0.5


def headed(units: Sequence[WorkUnit], side: Side, where: str) -> tuple[WorkUnit, ...]:
    """Return units that are driven towards a side of the compass.

    Args:
        units: The units.
        side: Side of the compass.
        where: Name of the site.

    Raises:
        PlaceError: A unit runs across that direction, or can be driven only the other way.
    """
    return tuple(_headed(unit, side, where) for unit in units)


def _headed(unit: WorkUnit, side: Side, where: str) -> WorkUnit:
    options = [made for option in unit.options if (made := _option(option, side)) is not None]
    if not options:
        raise PlaceError(
            message("{stretch} cannot be driven to the {side}", stretch=unit.options[0][0].name, side=COMPASS[side]),
            where=where,
            advice=message("name the other direction, or leave it out"),
        )
    return replace(unit, options=tuple(options))


def _option(stretches: tuple[Stretch, ...], side: Side) -> tuple[Stretch, ...] | None:
    """Return stretches driven towards a side; None if they cannot be."""
    ahead = [_ahead(stretch, side) for stretch in stretches]
    if all(cos >= _LEADS_COS for cos in ahead):
        return tuple(replace(stretch, one_way=True) for stretch in stretches)
    if not all(cos <= -_LEADS_COS for cos in ahead) or any(stretch.one_way for stretch in stretches):
        return None
    return tuple(replace(stretch.reversed(), one_way=True) for stretch in reversed(stretches))


def _ahead(stretch: Stretch, side: Side) -> float:
    """Return the cosine of the angle between a stretch and a side of the compass."""
    (ax, ay), (bx, by) = stretch.begin, stretch.end
    away = math.dist(stretch.begin, stretch.end)
    x, y = TOWARDS[side]
    return ((bx - ax) * x + (by - ay) * y) / away if away else 0.0


def facing(ring: NDArray[np.float64], side: Side, *, clockwise: bool) -> list[NDArray[np.float64]]:
    """Return the pieces of a ring that face a side of the compass, longest first; short ones turn a corner."""
    steps = np.diff(ring, axis=0)
    lengths = np.hypot(*steps.T)
    kept = lengths > 0.0
    ring, steps, lengths = np.vstack([ring[:-1][kept], ring[-1]]), steps[kept], lengths[kept]
    outwards = np.column_stack([-steps[:, 1], steps[:, 0]]) * (1.0 if clockwise else -1.0) / lengths[:, None]
    faces = outwards @ np.array(TOWARDS[side]) >= _FACING_COS
    if faces.all() or not faces.any():
        return [ring] if faces.all() else []
    first = int(np.argmin(faces))  # begin at a step that faces elsewhere, so that no piece is cut in two
    order = np.roll(np.arange(len(steps)), -first)
    pieces: list[list[int]] = []
    for before, k in itertools.pairwise(order.tolist()):
        if faces[k] and faces[before]:
            pieces[-1].append(k)
        elif faces[k]:
            pieces.append([k])
    points = [np.vstack([ring[piece], ring[piece[-1] + 1]]) for piece in pieces]
    return sorted((one for one in points if _length(one) >= _SHORT_M), key=_length, reverse=True)


def _length(line: NDArray[np.float64]) -> float:
    return float(np.hypot(*np.diff(line, axis=0).T).sum())
