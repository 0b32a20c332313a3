"""Near and far: nearest, next to, farthest, within, neighbour after neighbour, and the few that make a short drive."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from fieldhand.site.places.spots import Spots

#: "Next to" prefers the same row among those at most this much farther than the nearest one.
_BAND = 1.5

#: Two trees closer than this are one tree that the file holds twice.
_SAME_SPOT_M = 0.01

#: Distances nearer to each other than this are a tie.
_TIE_M = 2e-4

#: Straight on is within this angle of the line so far (30 degrees).
_STRAIGHT_COS = 0.87


def distance_to(spots: Spots, origin: Spots) -> NDArray[np.float64]:
    """Metres from each place to the nearest of ``origin``, straight."""
    if len(origin) == 1:
        return np.asarray(np.hypot(*(spots.xy - origin.xy[0]).T))
    return np.asarray(cKDTree(origin.xy).query(spots.xy)[0])


def apart_from(spots: Spots, origin: Spots) -> Spots:
    """Those that are not ``origin``, nor the same tree entered twice in the file (within a centimetre)."""
    left = spots.without(origin)
    return left.keep(distance_to(left, origin) > _SAME_SPOT_M) if len(left) else left


def nearest(spots: Spots, to: Spots, count: int) -> Spots:
    """The nearest first."""
    return spots.ranked(distance_to(spots, to), count)


def next_to(spots: Spots, to: Spots, count: int) -> Spots:
    """The nearest, but of those at most half as far again as the nearest one the same row comes first."""
    away = distance_to(spots, to)
    rows = _rows(to) - {""}
    other_row = ~np.isin(_row_names(spots), list(rows)) if rows else np.zeros(len(spots), dtype=bool)
    tier = np.where(away <= _BAND * away.min() + 1e-9, other_row, 2)
    order = np.lexsort((spots.file_order, np.round(away, 4), tier))
    return spots.keep(order[:count])


def farthest(spots: Spots, origin: Spots, count: int) -> Spots:
    """The farthest first, straight."""
    return spots.ranked(-distance_to(spots, origin), count)


def within(spots: Spots, to: Spots, distance_m: float) -> Spots:
    """At most that far, straight."""
    return spots.keep(distance_to(spots, to) <= distance_m) if len(spots) else spots


def side_by_side(spots: Spots, near: Spots, count: int) -> Spots:
    """``count`` next to each other (fewer if there are not as many), beginning with the nearest to ``near``.

    Each next one is a neighbour of the last: of those at most half as far again as its nearest the same row comes
    first, then what lies straight on, then the nearest. Where the last one has no neighbour left, the line goes on
    from whichever taken one has the nearest.
    """
    itself = np.isin(spots.index, near.index)
    seed = spots.ranked(np.where(itself, -1.0, distance_to(spots, near)), 1).index[0]
    taken = [int(np.flatnonzero(spots.index == seed)[0])]
    to_any = np.hypot(*(spots.xy - spots.xy[taken[0]]).T)
    free = to_any > _SAME_SPOT_M
    row_names = _row_names(spots)
    while len(taken) < count and free.any():
        to_last = np.hypot(*(spots.xy - spots.xy[taken[-1]]).T)
        to_any = np.minimum(to_any, to_last)
        closest_any, closest_last = to_any[free].min(), to_last[free].min()
        away = to_last if closest_last <= _BAND * max(closest_any, spots.site.spacing_m) else to_any
        band = np.flatnonzero(free & (away <= _BAND * away[free].min() + 1e-9))
        other_row = row_names[band] != row_names[taken[0]]
        order = np.lexsort((band, np.round(away[band], 4), ~_straight_on(spots.xy, taken, band), other_row))
        taken.append(int(band[order[0]]))
        free &= np.hypot(*(spots.xy - spots.xy[taken[-1]]).T) > _SAME_SPOT_M
    return spots.keep(taken)


def short_drive(spots: Spots, here: NDArray[np.float64], count: int) -> Spots:
    """``count`` of them, one after another the nearest to the last, from here on."""
    xy, order = spots.xy, spots.file_order
    left = np.arange(len(spots))
    index = cKDTree(xy)
    gone = np.zeros(len(spots), dtype=bool)
    taken: list[int] = []
    at = here
    while len(taken) < count:
        if gone[left].sum() > max(32, len(left) // 2):  # else searches wade through those that are gone
            left = left[~gone[left]]
            index = cKDTree(xy[left])
        found = _nearest_left(index, left, gone, at)
        away = np.round(np.hypot(*(xy[found] - at).T), 4)
        best = int(found[np.lexsort((order[found], away))[0]])
        taken.append(best)
        gone[best] = True
        at = xy[best]
    return spots.keep(taken)


def _nearest_left(
    index: cKDTree, left: NDArray[np.intp], gone: NDArray[np.bool_], at: NDArray[np.float64]
) -> NDArray[np.intp]:
    """Those not gone that are nearest to a point: at least the nearest and all that tie with it."""
    k = 8
    while True:
        k = min(k, len(left))
        away, which = (np.atleast_1d(a) for a in index.query(at, k=k))
        found = ~gone[left[which]]
        if found.any() and (k == len(left) or away[found][0] < away[-1] - _TIE_M):
            return np.asarray(left[which[found]])
        k *= 4


def _straight_on(xy: NDArray[np.float64], taken: list[int], band: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Which candidates continue the line of the trees taken so far; all of them while there is no line yet."""
    if len(taken) < 2:
        return np.ones(len(band), dtype=bool)
    line = xy[taken[-1]] - xy[taken[0]]
    step = xy[band] - xy[taken[-1]]
    lengths = np.hypot(*line) * np.hypot(*step.T)
    return np.asarray(step @ line >= _STRAIGHT_COS * lengths)


def _rows(spots: Spots) -> set[str]:
    return {spots.site.trees[k].row for k in spots.index[spots.is_tree].tolist()}


def _row_names(spots: Spots) -> NDArray[np.str_]:
    return np.array([spots.site.trees[k].row if k >= 0 else "" for k in spots.index.tolist()])
