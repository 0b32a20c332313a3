"""Choose trees far from each other, as a sample that represents an area."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from fieldhand.language import message
from fieldhand.language.words import say_rounded
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.resolution_notes import ResolutionNotes

Floats = NDArray[np.float64]

#: Maximum number of starting trees, those farthest from the middle.
_STARTS = 8

#: Maximum number of computed distances, about half a second; with more trees, fewer starts are tried.
_MOST_MEASURED = 100_000_000


def far_apart(spots: PlaceGroup, count: int, notes: ResolutionNotes) -> PlaceGroup:
    """Return ``count`` places with a large minimum distance, in the order of the file.

    Starting at the rim, each next place is the farthest from all chosen ones (Gonzalez 1985), which reaches at least
    half of the largest possible minimum distance. The best of several starts is kept. A single place is the tree
    nearest to the middle.

    Args:
        spots: At least ``count`` places.
        count: Number of places, at least 1.
        notes: Receives the minimum distance.
    """
    xy = spots.xy
    away = np.hypot(*(xy - xy.mean(axis=0)).T)
    if count == 1:
        return spots.keep([int(away.argmin())])
    starts = max(1, min(_STARTS, _MOST_MEASURED // (len(xy) * count)))
    begun = np.argsort(-away, kind="stable")[:starts]
    taken, least = max((_from(xy, int(first), count) for first in begun), key=lambda found: found[1])
    notes.rule = message("the two nearest to each other are {metres} m apart", metres=say_rounded(least, 1))
    return spots.keep(sorted(taken, key=lambda k: int(spots.file_order[k])))


def _from(xy: Floats, first: int, count: int) -> tuple[list[int], float]:
    """Return the chosen places for one start, and the minimum distance between any two of them."""
    x, y = np.ascontiguousarray(xy.T)
    taken, least = [first], np.inf
    nearest = (x - x[first]) ** 2 + (y - y[first]) ** 2  # squared distances avoid the square root
    nearest[first] = -1.0
    while len(taken) < count:
        farthest = int(nearest.argmax())
        least = min(least, float(nearest[farthest]))
        taken.append(farthest)
        np.minimum(nearest, (x - x[farthest]) ** 2 + (y - y[farthest]) ** 2, out=nearest)
        nearest[farthest] = -1.0
    return taken, math.sqrt(least)
