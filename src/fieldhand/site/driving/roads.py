"""What can be driven between places as a sparse graph: a handful of ways a place, however many places there are.

The shortest ways over it are drives that lead by other places' stands and by junctions, so they are never shorter than
the drives that :meth:`fieldhand.site.drives.Drives.lengths` measures, and little longer. Along an aisle and over open
ground each stand is joined to a few that it can be driven to straight: the nearest in each direction (Yao 1982), which
leaves ways over them nearly straight.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from fieldhand.site.driving.graph import Indices, Points
from fieldhand.site.driving.layout import Layout, by_aisle
from fieldhand.site.driving.spots import Spot
from fieldhand.site.model import Place

#: Along an aisle a stand is joined to those that are so many stands away.
_STEPS = (1, 2, 3, 4, 5, 7)

#: Over open ground a stand is joined to the nearest in each of so many directions, of so many about it.
_DIRECTIONS = 16
_ABOUT = 60

#: No way is shorter, so that none counts as missing.
_SHORTEST_M = 1e-9

Ways = tuple[Indices, Indices, Points]


@dataclass(frozen=True, kw_only=True, eq=False)
class Roads:
    """The ways between some places of a site, as a sparse graph that is driven in both directions.

    Attributes:
        places: In the order in which they were given, each with its stand. Node k is the stand of place k.
        at: Metres east and north of every node, shape (n, 2): the stands, then junctions (mouths, corners, turns).
        ways: Pairs of nodes, shape (m, 2).
        lengths: Metres of each way, shape (m,), greater than 0.
        straight: Whether all drives between the places are straight lines. Then there are neither ways nor junctions.
    """

    places: tuple[Place, ...]
    at: Points
    ways: NDArray[np.int64]
    lengths: Points
    straight: bool

    def cut_off(self) -> int | None:
        """The first place to which no way leads from place 0; None if there is none."""
        n = len(self.at)
        if self.straight or not self.places:
            return None
        matrix = csr_matrix((np.ones(len(self.ways)), self.ways.T), shape=(n, n))
        parts = connected_components(matrix, directed=False)[1][: len(self.places)]
        apart = np.flatnonzero(parts != parts[0])
        return int(apart[0]) if len(apart) else None


def roads_of(layout: Layout, places: tuple[Place, ...]) -> Roads:
    """The roads between places, each with its stand."""
    stands = [p.stand or p.xy for p in places]
    at = np.array(stands).reshape(-1, 2)
    spots = layout.spots.at(stands) if layout.open else []
    if all(s.foot is not None for s in spots) and layout.is_one_view(at):
        none = np.empty((0, 2), dtype=np.int64)
        return Roads(places=places, at=at, ways=none, lengths=np.empty(0), straight=True)
    # A stand off the ground on which ways keep their clearance hangs by one way at its foot there: none leads through.
    feet = [_foot(layout, spot) for spot in spots]
    node = np.arange(len(spots))
    off = np.array([k for k, (_, metres) in enumerate(feet) if metres > 0.0], dtype=np.intp)
    first_foot = len(spots) + layout.graph.count
    node[off] = first_foot + np.arange(len(off))
    grounded = [foot for foot, _ in feet]
    found = [
        *_to_junctions(grounded, node, len(spots)),
        layout.graph.ways(len(spots)),
        (off, node[off], np.array([feet[k][1] for k in off.tolist()])),
        *(
            (node[np.array(inside)[i]], node[np.array(inside)[j]], metres)
            for number, inside in by_aisle(grounded).items()
            for i, j, metres in _along(layout, number, np.array([grounded[k].uv for k in inside]))
        ),
    ]
    open_ = np.array([k for k, foot in enumerate(grounded) if foot.foot is not None], dtype=np.intp)
    if len(open_) > 1:
        i, j, metres = _about(layout, np.array([grounded[k].foot for k in open_.tolist()]))
        found.append((node[open_[i]], node[open_[j]], metres))
    one, two, metres = (np.concatenate(part) for part in zip(*found, strict=True))
    return Roads(
        places=places,
        at=np.vstack([at, layout.junctions, np.array([feet[k][0].xy for k in off.tolist()]).reshape(-1, 2)]),
        ways=np.column_stack([one, two]).astype(np.int64),
        lengths=np.maximum(metres, _SHORTEST_M),
        straight=False,
    )


def _foot(layout: Layout, spot: Spot) -> tuple[Spot, float]:
    """Where a spot reaches ground on which ways keep their clearance, and the metres to there: 0 where it is on it."""
    if spot.foot is not None:
        found = layout.ground.foot(spot.foot)
    else:
        found = None if spot.aisle is None or spot.uv is None else spot.aisle.foot(spot.uv)
    if found is None or found[1] + spot.spur < _SHORTEST_M:
        return spot, 0.0
    return layout.spot(found[0]), spot.spur + found[1]


def _to_junctions(spots: Sequence[Spot], node: Indices, first: int) -> Iterator[Ways]:
    """From each spot to the nodes of the graph that it reaches by itself."""
    links = [spot.links for spot in spots]
    if links:
        yield (
            np.repeat(node, [len(link.nodes) for link in links]),
            first + np.concatenate([link.nodes for link in links]),
            np.concatenate([link.metres for link in links]),
        )


def _along(layout: Layout, number: int, uv: Points) -> Iterator[Ways]:
    """From each spot of an aisle to others along it."""
    order = np.argsort(uv[:, 0], kind="stable")
    for step in _STEPS:
        i, j = order[:-step], order[step:]
        metres = layout.aisles[number].metres_between(uv[i], uv[j])
        there = np.isfinite(metres)
        yield i[there], j[there], metres[there]


def _about(layout: Layout, at: Points) -> Ways:
    """From each point of open ground to the nearest in every direction that it sees."""
    near = cKDTree(at).query(at, k=min(_ABOUT + 1, len(at)))[1]
    i, j = np.repeat(np.arange(len(at)), near.shape[1]), near.ravel()
    i, j = i[i != j], j[i != j]
    sector = (np.arctan2(*(at[j] - at[i]).T) // (2.0 * np.pi / _DIRECTIONS)).astype(np.intp)
    # They come from near to far, so the first of each direction is the nearest.
    seen = layout.ground.soft.sees(at[i], at[j])
    i, j, sector = i[seen], j[seen], sector[seen]
    _, first = np.unique(i * (4 * _DIRECTIONS) + sector + 2 * _DIRECTIONS, return_index=True)
    pairs = np.unique(np.sort(np.column_stack([i[first], j[first]]), axis=1), axis=0)
    return pairs[:, 0], pairs[:, 1], np.hypot(*(at[pairs[:, 0]] - at[pairs[:, 1]]).T)
