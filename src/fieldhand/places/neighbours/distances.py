"""Compute nearest, adjacent and farthest places, places within a distance, and few places with a short drive."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from fieldhand.places.place_group import PlaceGroup
from fieldhand.site.model import Site
from fieldhand.site.point_index import PointIndex
from fieldhand.terms import Side

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False, kw_only=True)
class ZoneArea:
    """A zone as an origin of distances, which are measured from its outline; trees inside are excluded."""

    site: Site
    area: BaseGeometry


#: Origin of distances: the nearest of several places, or a zone.
Origin = PlaceGroup | ZoneArea

#: Factor on the nearest distance within which "next to" prefers the same row.
_BAND = 1.5

#: Distance in metres below which two trees of the file are the same tree.
_SAME_SPOT_M = 0.01

#: Number of places around the first that are searched for a chain of neighbours before all are searched.
_AROUND = 1_000

#: Difference in metres below which two distances are a tie.
_TIE_M = 2e-4

#: Cosine of the largest angle to the previous direction that counts as straight on (30 degrees).
_STRAIGHT_COS = 0.87


def distance_to(spots: PlaceGroup, origin: Origin) -> Floats:
    """Return the straight-line distance in metres from each place to the origin; 0 inside a zone."""
    if isinstance(origin, ZoneArea):
        return np.asarray(shapely.distance(origin.area, shapely.points(spots.xy)))
    if len(origin) == 1:
        return np.asarray(np.hypot(*(spots.xy - origin.xy[0]).T))
    return PointIndex(origin.xy).nearest(spots.xy)[0]


def nearest_of(origin: Origin, spots: PlaceGroup) -> Floats:
    """Return the point of the origin nearest to each place, in metres east and north, shape (n, 2)."""
    if isinstance(origin, ZoneArea):
        lines = shapely.shortest_line(origin.area, shapely.points(spots.xy))
        return np.asarray(shapely.get_coordinates(lines)[::2])
    return np.asarray(origin.xy[PointIndex(origin.xy).nearest(spots.xy)[1]])


def apart_from(spots: PlaceGroup, origin: Origin) -> PlaceGroup:
    """Return the places outside the origin, without duplicates of its trees in the file (within a centimetre)."""
    if isinstance(origin, ZoneArea):
        return spots.keep(distance_to(spots, origin) > 0)
    left = spots.without(origin)
    if not len(left):
        return left
    if len(origin) == 1:
        return left.keep(distance_to(left, origin) > _SAME_SPOT_M)
    return left.keep(PointIndex(origin.xy).nearest(left.xy, within=_SAME_SPOT_M)[0] > _SAME_SPOT_M)


def next_to(spots: PlaceGroup, to: Origin, count: int) -> PlaceGroup:
    """Return the nearest places, preferring the same row among those at most 1.5 times as far as the nearest."""
    away = distance_to(spots, to)
    rows = to.row[to.row >= 0] if isinstance(to, PlaceGroup) else ()
    other_row = ~np.isin(spots.row, rows) if len(rows) else np.zeros(len(spots), dtype=bool)
    tier = np.where(away <= _BAND * away.min() + 1e-9, other_row, 2)
    order = np.lexsort((spots.file_order, np.round(away, 4), tier))
    return spots.keep(order[:count])


def on_side(spots: PlaceGroup, to: Origin, side: Side, *, next_to: bool) -> PlaceGroup:
    """Return the places in the 90-degree sector around a side, seen from the nearest place of ``to``.

    Args:
        next_to: Keep only neighbours: places at most 1.5 times as far away as the local row or tree spacing.
    """
    if not len(spots):
        return spots
    step = spots.xy - nearest_of(to, spots)
    outward = {"north": step[:, 1], "east": step[:, 0], "south": -step[:, 1], "west": -step[:, 0]}[side]
    sideways = np.abs(step[:, 0] if side in ("north", "south") else step[:, 1])
    kept = (outward > 0) & (sideways <= outward)
    if next_to and isinstance(to, ZoneArea):
        kept &= np.hypot(*step.T) <= _BAND * to.site.spacing_m + 1e-9
    elif next_to and isinstance(to, PlaceGroup):
        reach = np.array([_BAND * _apart_at(to, k) for k in range(len(to))])
        kept &= np.hypot(*step.T) <= reach[PointIndex(to.xy).nearest(spots.xy)[1]] + 1e-9
    return spots.keep(kept)


def _apart_at(to: PlaceGroup, k: int) -> float:
    """Return the larger of the row spacing and the tree spacing at a place, in metres."""
    site = to.site
    planting = site.planting
    tree = int(to.index[k])
    row = int(planting.row_of[tree]) if tree >= 0 and planting.blocks else -1
    if row < 0:
        return float(site.spacing_m)
    block = planting.blocks[planting.rows[row].block]
    return max(block.tree_spacing_m, 0.0 if np.isnan(block.row_spacing_m) else block.row_spacing_m)


def within(spots: PlaceGroup, to: Origin, distance_m: float) -> PlaceGroup:
    """Return the places within a straight-line distance."""
    if not len(spots) or isinstance(to, ZoneArea) or len(to) == 1:
        return spots.keep(distance_to(spots, to) <= distance_m) if len(spots) else spots
    reach = distance_m + 1e-9  # the query excludes its bound
    return spots.keep(PointIndex(to.xy).nearest(spots.xy, within=reach)[0] <= distance_m)


def side_by_side(spots: PlaceGroup, near: Origin, count: int) -> PlaceGroup:
    """Return up to ``count`` places next to each other, beginning with the one nearest to ``near``.

    Each place is a neighbour of the previous one: among those at most 1.5 times as far as its nearest, the same row
    comes first, then the direction straight on, then the distance. If the previous place has no neighbour left, the
    chain continues from the chosen place with the nearest one.
    """
    itself = np.isin(spots.index, near.index) if isinstance(near, PlaceGroup) else np.zeros(len(spots), dtype=bool)
    seed = spots.ranked(np.where(itself, -1.0, distance_to(spots, near)), 1).index[0]
    from_seed = np.hypot(*(spots.xy - spots.xy[np.flatnonzero(spots.index == seed)[0]]).T)
    around = max(_AROUND, 4 * count**2)
    if around < len(spots):  # search the surroundings first, and all places only if these are not decisive
        radius = float(np.partition(from_seed, around)[around])
        inside = np.flatnonzero(from_seed <= radius)
        taken = _chain(spots.keep(inside), int(seed), count, radius)
        if taken is not None:
            return spots.keep(inside[taken])
    taken = _chain(spots, int(seed), count, np.inf)
    return spots.keep(taken if taken is not None else [])


def _chain(spots: PlaceGroup, seed: int, count: int, radius: float) -> list[int] | None:
    """Return the positions of a chain of neighbours; None if a place beyond the radius could belong to it."""
    taken = [int(np.flatnonzero(spots.index == seed)[0])]
    to_any = from_seed = np.hypot(*(spots.xy - spots.xy[taken[0]]).T)
    free = to_any > _SAME_SPOT_M
    row = spots.row
    while len(taken) < count and free.any():
        to_last = np.hypot(*(spots.xy - spots.xy[taken[-1]]).T)
        to_any = np.minimum(to_any, to_last)
        closest_any, closest_last = to_any[free].min(), to_last[free].min()
        away = to_last if closest_last <= _BAND * max(closest_any, spots.site.spacing_m) else to_any
        reach = _BAND * away[free].min() + 1e-9
        if from_seed[taken].max() + max(reach, closest_last) > radius:
            return None
        band = np.flatnonzero(free & (away <= reach))
        other_row = row[band] != row[taken[0]]
        order = np.lexsort((band, np.round(away[band], 4), ~_straight_on(spots.xy, taken, band), other_row))
        taken.append(int(band[order[0]]))
        free &= np.hypot(*(spots.xy - spots.xy[taken[-1]]).T) > _SAME_SPOT_M
    return taken if len(taken) == count or np.isinf(radius) else None


def short_drive(spots: PlaceGroup, here: tuple[float, float], count: int) -> PlaceGroup:
    """Return ``count`` places, each the nearest to the previous one, starting from here."""
    xy, order = spots.xy, spots.file_order
    left = np.arange(len(spots))
    index = PointIndex(xy)
    gone = np.zeros(len(spots), dtype=bool)
    taken: list[int] = []
    at = np.array(here)
    while len(taken) < count:
        if gone[left].sum() > max(32, len(left) // 2):  # rebuild the index without the places already taken
            left = left[~gone[left]]
            index = PointIndex(xy[left])
        found = _nearest_left(index, left, gone, at)
        away = np.round(np.hypot(*(xy[found] - at).T), 4)
        best = int(found[np.lexsort((order[found], away))[0]])
        taken.append(best)
        gone[best] = True
        at = xy[best]
    return spots.keep(taken)


def _nearest_left(
    index: PointIndex, left: NDArray[np.intp], gone: NDArray[np.bool_], at: NDArray[np.float64]
) -> NDArray[np.intp]:
    """Return the remaining places nearest to a point, including all ties."""
    k = 8
    while True:
        k = min(k, len(left))
        (away,), (which,) = index.nearest_few(at[None], k)
        found = ~gone[left[which]]
        if found.any() and (k == len(left) or away[found][0] < away[-1] - _TIE_M):
            return np.asarray(left[which[found]])
        k *= 4


def _straight_on(xy: NDArray[np.float64], taken: list[int], band: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Return a mask of the candidates that continue the line of the chosen trees; all if there is no line yet."""
    if len(taken) < 2:
        return np.ones(len(band), dtype=bool)
    line = xy[taken[-1]] - xy[taken[0]]
    step = xy[band] - xy[taken[-1]]
    lengths = np.hypot(*line) * np.hypot(*step.T)
    return np.asarray(step @ line >= _STRAIGHT_COS * lengths)
