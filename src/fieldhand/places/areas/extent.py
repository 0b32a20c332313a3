"""Compute halves, quarters, edges, extremes, corners and middles of a group of trees; north is true north.

A *reference* group gives the extent; the places are chosen from ``spots`` (:mod:`fieldhand.places` gives the rules).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.site.counting import OUTWARD
from fieldhand.site.rectangle import named_corners, smallest_rectangle
from fieldhand.terms import CornerName, Side

if TYPE_CHECKING:
    pass


#: Rule of halves and quarters, for explanations.
EXTENT_RULE = "halves and quarters go by the middle lines of the extent along true north"

_SIDE: dict[str, Side] = {"n": "north", "e": "east", "s": "south", "w": "west"}

#: Distance in metres from a middle line within which a tree belongs to both sides.
_ON_THE_LINE_M = 0.01

#: Distance along an edge, as a fraction of the tree spacing, below which one tree hides another from the edge. It is
#: above 0.5, so that staggered rows hide each other, and below 0.71, the distance of neighbours along an edge at 45
#: degrees.
_CORRIDOR = 0.7


@dataclass(frozen=True)
class Extent:
    """Bounding box along true north, in metres."""

    west: float
    south: float
    east: float
    north: float

    @staticmethod
    def around(reference: PlaceGroup) -> Extent:
        """Return the bounding box of a group."""
        west, south = reference.xy.min(axis=0).tolist()
        east, north = reference.xy.max(axis=0).tolist()
        return Extent(west, south, east, north)

    @property
    def centre(self) -> NDArray[np.float64]:
        """Return the centre, in metres east and north."""
        return np.array([(self.west + self.east) / 2, (self.south + self.north) / 2])


def outward(xy: NDArray[np.float64], side: Side) -> NDArray[np.float64]:
    """Return the coordinate of each point in the direction of a side, in metres from an arbitrary origin."""
    return np.asarray(xy @ np.array(OUTWARD[side]))


def half(spots: PlaceGroup, side: Side, reference: PlaceGroup) -> PlaceGroup:
    """Return the places on one side of the middle line of the reference group's extent, or on the line."""
    middle = outward(Extent.around(reference).centre[None, :], side)[0]
    return spots.keep(outward(spots.xy, side) >= middle - _ON_THE_LINE_M)


def quarter(spots: PlaceGroup, name: CornerName, reference: PlaceGroup) -> PlaceGroup:
    """Return the places in both halves that form the quarter."""
    return half(half(spots, _SIDE[name[0]], reference), _SIDE[name[1]], reference)


def among_extreme(spots: PlaceGroup, side: Side, notes: ResolutionNotes) -> PlaceGroup:
    """Return the places less than one row spacing from the extreme; a row exactly one spacing behind is excluded."""
    reach = outward(spots.xy, side)
    if len(spots) < 2:
        return spots
    spacing = _row_spacing_m(spots, int(reach.argmax()))
    notes.rule = f"less than {spacing:.1f} m, one row spacing, from the {side}ernmost"
    return spots.keep(reach > reach.max() - spacing + _ON_THE_LINE_M)


def edge(spots: PlaceGroup, side: Side, reference: PlaceGroup) -> PlaceGroup:
    """Return the places on one edge of the reference group, which follows the outline of a rotated farm.

    A place is on the edge if no tree of the reference group is farther out within 0.7 spacings to its left or right.
    """
    along = outward(reference.xy, "east" if side in ("north", "south") else "north")
    reach = outward(reference.xy, side)
    order = np.argsort(along, kind="stable")
    corridor = _CORRIDOR * spots.site.spacing_m
    mine = outward(spots.xy, "east" if side in ("north", "south") else "north")
    low = np.searchsorted(along[order], mine - corridor, side="left")
    high = np.searchsorted(along[order], mine + corridor, side="right")
    farthest = _range_maximum(reach[order], low, high)
    return spots.keep(outward(spots.xy, side) >= farthest - _ON_THE_LINE_M)


def from_edge_middle(spots: PlaceGroup, side: Side, reference: PlaceGroup) -> NDArray[np.float64]:
    """Return distances in metres to the middle of one side of the reference group's smallest-area rectangle."""
    at = named_corners(smallest_rectangle(reference.xy))
    ends = [point for name, point in at.items() if _SIDE[name[0]] == side or _SIDE[name[1]] == side]
    return np.asarray(np.hypot(*(spots.xy - (ends[0] + ends[1]) / 2).T))


def from_centre(spots: PlaceGroup, reference: PlaceGroup) -> NDArray[np.float64]:
    """Return distances in metres to the centre of the reference group's extent."""
    return np.asarray(np.hypot(*(spots.xy - Extent.around(reference).centre).T))


def corners(spots: PlaceGroup, which: Iterable[CornerName], reference: PlaceGroup) -> PlaceGroup:
    """Return the place nearest to each named corner of the reference group's smallest-area rectangle."""
    at = named_corners(smallest_rectangle(reference.xy))
    found = [int(spots.ranked(np.hypot(*(spots.xy - at[name]).T), 1).index[0]) for name in which]
    return PlaceGroup(site=spots.site, index=np.array(list(dict.fromkeys(found)), dtype=np.intp), others=spots.others)


def _row_spacing_m(spots: PlaceGroup, at: int) -> float:
    """Return the row spacing at a place in metres; the tree spacing if it is in no row or in a single one."""
    row = int(spots.row[at])
    planting = spots.site.planting
    spacing = planting.blocks[planting.rows[row].block].row_spacing_m if row >= 0 else float("nan")
    return spacing if np.isfinite(spacing) else spots.site.spacing_m


def _range_maximum(values: NDArray[np.float64], low: NDArray[np.intp], high: NDArray[np.intp]) -> NDArray[np.float64]:
    """Return the maximum of ``values[low:high]`` for each pair, -inf if empty, by a sparse table."""
    table = [values]
    width = 1
    while 2 * width <= len(values):
        previous = table[-1]
        table.append(np.maximum(previous[:-width], previous[width:]))
        width *= 2
    out = np.full(len(low), -np.inf)
    length = high - low
    for level, row in enumerate(table):
        here = (length >= 1 << level) & (length < 2 << level)
        out[here] = np.maximum(row[low[here]], row[high[here] - (1 << level)])
    return out
