"""Sparse road map of the paths between many places, with a small number of edges per place.

Shortest paths over it lead through the stands of other places and through corners, so they are never shorter than the
drives that :meth:`fieldhand.site.drives.Drives.lengths` measures, and only slightly longer. Along an aisle and over
open ground each stand is joined to a few stands in a straight line of sight: the nearest in each direction (Yao 1982),
which keeps paths nearly straight.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.driving.graph import Indices, Points
from fieldhand.site.driving.layout import Layout
from fieldhand.site.model import Place
from fieldhand.site.point_index import PointIndex
from fieldhand.site.rows.labels import linked

#: Along an aisle a stand is joined to the stands at these offsets in order.
_STEPS = (1, 2, 3, 4, 5, 7)

#: On open ground a stand is joined to the nearest one in each of this many directions, among this many neighbours.
_DIRECTIONS = 16
_ABOUT = 60

#: Least length of an edge in metres, since a sparse matrix drops zeros.
_SHORTEST_M = 1e-9


@dataclass(frozen=True, kw_only=True, eq=False)
class Roadmap:
    """The paths between places of a site, as a sparse undirected graph.

    Attributes:
        places: Places in input order, each with its stand. Node k is the stand of place k.
        at: Metres east and north of every node, shape (n, 2): the stands, then corners of the ground, then feet of
            stands off the drivable ground.
        ways: End nodes of each edge, shape (m, 2).
        lengths: Length of each edge in metres, shape (m,), greater than 0.
        straight: True if all drives between the places are straight lines. The graph then has no edges.
    """

    places: tuple[Place, ...]
    at: Points
    ways: NDArray[np.int64]
    lengths: Points
    straight: bool

    def cut_off(self) -> int | None:
        """Return the first place that is not connected to place 0; None if there is none."""
        n = len(self.at)
        if self.straight or not self.places:
            return None
        parts = linked(n, self.ways[:, 0], self.ways[:, 1])[: len(self.places)]
        apart = np.flatnonzero(parts != parts[0])
        return int(apart[0]) if len(apart) else None


def roadmap_of(layout: Layout, places: tuple[Place, ...], *, always_edges: bool = False) -> Roadmap:
    """Return the road map of places, each with its stand.

    Args:
        layout: Drivable layout of the site.
        places: The places, with their stands.
        always_edges: Return the edges also if all drives are straight lines.
    """
    stands = [p.stand or p.xy for p in places]
    at = np.array(stands).reshape(-1, 2)
    spots = layout.spots(stands) if layout.open or always_edges else []
    if not spots or (layout.is_one_view(spots) and not always_edges):
        none = np.empty((0, 2), dtype=np.int64)
        return Roadmap(places=places, at=at, ways=none, lengths=np.empty(0), straight=True)
    # A stand off the drivable ground is joined to its foot only, so no path leads through it.
    feet = [spot if spot.foot is None or spot.spur == 0.0 else layout.spot(spot.foot) for spot in spots]
    off = np.array([k for k, spot in enumerate(spots) if feet[k] is not spot], dtype=np.intp)
    node = np.arange(len(spots))
    node[off] = len(spots) + layout.graph.count + np.arange(len(off))
    links = layout.links(feet)
    found = [
        (
            np.repeat(node, [len(link.nodes) for link in links]),
            len(spots) + np.concatenate([link.nodes for link in links]),
            np.concatenate([link.metres for link in links]),
        ),
        layout.graph.ways(len(spots)),
        (off, node[off], np.array([spots[k].spur for k in off.tolist()])),
    ]
    pairs = list(_neighbours(layout, np.array([spot.xy for spot in feet])))
    i, j = (np.concatenate(part) for part in zip(*pairs, strict=True))
    metres = layout.straight(feet, i, j)
    there = np.isfinite(metres)
    found.append((node[i[there]], node[j[there]], metres[there]))
    one, two, metres = (np.concatenate(part) for part in zip(*found, strict=True))
    return Roadmap(
        places=places,
        at=np.vstack([at, layout.visibility.corners, np.array([feet[k].xy for k in off.tolist()]).reshape(-1, 2)]),
        ways=np.column_stack([one, two]).astype(np.int64),
        lengths=np.maximum(metres, _SHORTEST_M),
        straight=False,
    )


def _neighbours(layout: Layout, at: Points) -> Iterator[tuple[Indices, Indices]]:
    """Yield pairs of points that may be joined by a straight edge, along an aisle and over open ground."""
    numbers = np.array([len(layout.aisles.all) if a is None else a.number for a in layout.aisles.at(at)])
    order = np.argsort(numbers, kind="stable")
    for inside in np.split(order, np.flatnonzero(np.diff(numbers[order])) + 1):
        number = int(numbers[inside[0]])
        if number == len(layout.aisles.all):
            yield _about(layout, at, inside)
            continue
        along = inside[np.argsort(layout.aisles.all[number].frame.local(at[inside])[:, 0], kind="stable")]
        for step in _STEPS:
            yield along[:-step], along[step:]


def _about(layout: Layout, at: Points, which: Indices) -> tuple[Indices, Indices]:
    """Return pairs of each of these points on open ground and the nearest visible point in every direction."""
    near = PointIndex(at).nearest_few(at[which], _ABOUT + 1)[1]
    i, j = np.repeat(which, near.shape[1]), near.ravel()
    i, j = i[i != j], j[i != j]
    sector = (np.arctan2(*(at[j] - at[i]).T) // (2.0 * np.pi / _DIRECTIONS)).astype(np.intp)
    # Pairs are sorted by distance, so the first of each direction is the nearest.
    seen = layout.visibility.area.sees(at[i], at[j])
    i, j, sector = i[seen], j[seen], sector[seen]
    _, first = np.unique(i * (4 * _DIRECTIONS) + sector + 2 * _DIRECTIONS, return_index=True)
    pairs = np.unique(np.sort(np.column_stack([i[first], j[first]]), axis=1), axis=0)
    return pairs[:, 0], pairs[:, 1]
