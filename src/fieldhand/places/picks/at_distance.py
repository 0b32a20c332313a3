"""Search for trees at a given distance from each other, as closely as the planting permits."""

from __future__ import annotations

from itertools import pairwise
from math import dist
from typing import TYPE_CHECKING

import numpy as np

from fieldhand.errors import PlaceError
from fieldhand.language import Number, message
from fieldhand.language.words import say_number, say_rounded
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.site.counting import row_words

if TYPE_CHECKING:
    from fieldhand.places.picks.apart import Apart


#: Maximum relative deviation from the requested distance.
TOLERANCE = 0.25
#: Maximum number of first trees to try.
_MOST_TRIES = 200


def at_distance(of: PlaceGroup, selector: Apart, notes: ResolutionNotes) -> PlaceGroup:
    """Return the first fitting sequence of trees, trying each as the first and continuing with the best fit.

    Raises:
        PlaceError: There are no such trees.
    """
    metres, count = selector.apart_m, selector.count
    if not (np.isfinite(metres) and metres > 0):
        raise PlaceError(
            message("trees cannot be {metres} m apart", metres=Number(f"{metres:g}")),
            advice=message("ask for more than 0 m"),
        )
    chosen = _chosen(of, count, metres, selector.least) if count >= 1 else []
    if not chosen:
        wanted: dict[str, str | int] = {"count": count, "metres": say_number(metres)}
        none = (
            message("there are no {count} trees at least {metres} m from each other", context="", **wanted)
            if selector.least
            else message("there are no {count} trees about {metres} m from each other", context="", **wanted)
        )
        raise PlaceError(
            _none_among(none, of),
            where=of.site.name,
            advice=message("ask for fewer, or for a smaller distance"),
        )
    found = of.keep(chosen)
    if count > 1:
        legs = [dist(a.xy, b.xy) for a, b in pairwise(found.places)]
        near, far = say_rounded(min(legs), 1), say_rounded(max(legs), 1)
        alike = message(
            "the positions of the trees do not allow the exact distance: these are {metres} m apart", metres=near
        )
        differ = message(
            "the positions of the trees do not allow the exact distance: these are {near} to {far} m apart",
            near=near,
            far=far,
        )
        notes.remark(alike if near == far else differ)
    return found


def _none_among(none: str, of: PlaceGroup) -> str:
    """Return a sentence on the failed search with the row and its length, or the extent of the group."""
    rows = np.unique(of.row).tolist()
    if len(rows) == 1 and rows[0] >= 0:
        row = row_words(of.site, of.site.planting.rows[rows[0]])
        if len(of) == 1:
            return message("{what} in {row}: it has 1 tree", what=none, row=row)
        length = say_rounded(float(np.hypot(*np.ptp(of.xy, axis=0))))
        return message(
            "{what} in {row}: it has {count} trees over {metres} m", what=none, row=row, count=len(of), metres=length
        )
    east, north = (say_rounded(float(metres)) for metres in np.ptp(of.xy, axis=0))
    return message(
        "{what} among {count} trees over {east} m east-west and {north} m north-south",
        what=none,
        count=len(of),
        east=east,
        north=north,
    )


def _chosen(of: PlaceGroup, count: int, metres: float, least: bool) -> list[int]:
    xy = of.xy
    nearest = metres if least else metres * (1 - TOLERANCE)
    for first in range(0, len(xy), max(1, len(xy) // _MOST_TRIES)):
        chosen = [first]
        free = np.ones(len(xy), dtype=bool)
        while len(chosen) < count:
            away = np.hypot(*(xy - xy[chosen[-1]]).T)
            free &= away >= nearest
            off = np.where(free, np.abs(away - metres), np.inf)
            best = int(off.argmin())
            if not free[best] or (not least and off[best] > metres * TOLERANCE):
                break
            chosen.append(best)
        if len(chosen) == count:
            return chosen
    return []
