"""Trees at a distance from each other. They stand where they stand: those that fit best are looked for."""

from __future__ import annotations

from itertools import pairwise
from math import dist

import numpy as np

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.site.places.counted import row_words
from fieldhand.site.places.spots import Spots
from fieldhand.site.places.tell import Tell
from fieldhand.task.selectors import Apart
from fieldhand.task.words import say_number, say_rounded

#: A tree whose distance differs by more than this share of what was asked for is not "so far apart".
TOLERANCE = 0.25
#: So many trees are tried as the first.
_MOST_TRIES = 200


def apart(of: Spots, selector: Apart, tell: Tell) -> Spots:
    """The first trees that fit, each tried in turn to begin with; from there each time the one that fits best.

    Raises:
        PlaceError: There are no such trees.
    """
    metres, count = selector.apart_m, selector.count
    if not (np.isfinite(metres) and metres > 0):
        raise PlaceError(f"trees {metres:g} m apart are no trees", advice="ask for more than 0 m")
    chosen = _chosen(of, count, metres, selector.least) if count >= 1 else []
    if not chosen:
        how = f"{'at least' if selector.least else 'about'} {say_number(metres)} m"
        raise PlaceError(
            f"there are no {count} trees {how} from each other{_among(of)}",
            where=of.site.name,
            advice="ask for fewer, or for a smaller distance",
        )
    found = of.keep(chosen)
    if count > 1:
        legs = [dist(a.xy, b.xy) for a, b in pairwise(found.places)]
        near, far = say_rounded(min(legs), 1), say_rounded(max(legs), 1)
        alike = message("trees stand where they stand: these are {metres} m apart", metres=near)
        differ = message("trees stand where they stand: these are {near} to {far} m apart", near=near, far=far)
        tell.note(alike if near == far else differ)
    return found


def _among(of: Spots) -> str:
    """Return in which row they were looked for and how long it is, or over how much ground."""
    rows = np.unique(of.row).tolist()
    if len(rows) == 1 and rows[0] >= 0:
        row = row_words(of.site, of.site.planting.rows[rows[0]])
        length = float(np.hypot(*np.ptp(of.xy, axis=0)))
        trees = "1 tree" if len(of) == 1 else f"{len(of)} trees over {say_rounded(length)} m"
        return f" in {row}: it has {trees}"
    east, north = (say_rounded(float(metres)) for metres in np.ptp(of.xy, axis=0))
    return f" among {len(of)} trees over {east} m east-west and {north} m north-south"


def _chosen(of: Spots, count: int, metres: float, least: bool) -> list[int]:
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
