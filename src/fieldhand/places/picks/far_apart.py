"""Trees spread over an area: far from each other, so that together they speak for all of it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from fieldhand.language import message
from fieldhand.language.words import say_rounded
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.resolution_notes import ResolutionNotes

Floats = NDArray[np.float64]

#: Begun with at most so many trees, those farthest from the middle.
_STARTS = 8

#: So many distances are measured in all, about half a second's worth; with more trees it is begun with fewer.
_MOST_MEASURED = 100_000_000


def far_apart(spots: PlaceGroup, count: int, notes: ResolutionNotes) -> PlaceGroup:
    """``count`` of the places so that the two nearest of them stand far apart, in the order of the file.

    From a tree at the rim, each next one is that which is farthest from all taken so far (Gonzalez 1985). The least
    distance is at least half of the best that there is. Of several trees to begin with the best is kept. A single one
    is the tree nearest to the middle.

    Args:
        spots: At least ``count`` places.
        count: How many, at least 1.
        notes: Is told how far apart they stand.
    """
    xy = spots.xy
    away = np.hypot(*(xy - xy.mean(axis=0)).T)
    if count == 1:
        return spots.keep([int(away.argmin())])
    starts = max(1, min(_STARTS, _MOST_MEASURED // (len(xy) * count)))
    begun = np.argsort(-away, kind="stable")[:starts]
    taken, least = max((_from(xy, int(first), count) for first in begun), key=lambda found: found[1])
    notes.rule = message("the nearest two of them stand {metres} m apart", metres=say_rounded(least, 1))
    return spots.keep(sorted(taken, key=lambda k: int(spots.file_order[k])))


def _from(xy: Floats, first: int, count: int) -> tuple[list[int], float]:
    """The places taken, beginning with one, and the least distance between any two of them."""
    x, y = np.ascontiguousarray(xy.T)
    taken, least = [first], np.inf
    nearest = (x - x[first]) ** 2 + (y - y[first]) ** 2  # squares: far faster than the metres
    nearest[first] = -1.0
    while len(taken) < count:
        farthest = int(nearest.argmax())
        least = min(least, float(nearest[farthest]))
        taken.append(farthest)
        np.minimum(nearest, (x - x[farthest]) ** 2 + (y - y[farthest]) ** 2, out=nearest)
        nearest[farthest] = -1.0
    return taken, math.sqrt(least)
