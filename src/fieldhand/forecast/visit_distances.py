"""Distances between optional visits: double precision for few, single precision on a sparse graph for many."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast.mission_state import Visit
from fieldhand.forecast.remaining_work import RemainingWork
from fieldhand.orienteering.table import Table
from fieldhand.site.model import Place

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

Floats = NDArray[np.float64]

#: Maximum number of places in double precision (100 MB with copies); more use single precision (at most 1.6 GB).
MAX_DOUBLE = 2000


@dataclass(frozen=True, kw_only=True, eq=False)
class VisitDistances:
    """Distances in metres between vertices, in one of the forms of :class:`Problem`; the other forms are empty."""

    distances: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    coordinates: Floats | None = None
    table: Table | None = None


def visit_distances(
    here: Place,
    visits: Sequence[Visit],
    rest: RemainingWork,
    drives: Drives,
    between: Callable[[Sequence[Place]], Floats] | None = None,
    table: int = MAX_DOUBLE,
) -> VisitDistances:
    """Return distances between the robot, the optional visits, and the first place of the remaining work.

    Args:
        here: The robot's place, which is the first vertex.
        visits: Possible visits; the way onward from a visit begins where it ends.
        rest: Work that follows. If it includes no drive, the robot may end anywhere: the last vertex is at distance 0
            from all.
        drives: Drives between places of the site.
        between: Function that returns a matrix of distances in metres between places, if the caller keeps one.
        table: Maximum number of places for a full matrix. An open end, and visits that end elsewhere, always need one.

    Raises:
        DriveFault: Some places are not connected.
    """
    places = [here, *(v.place for v in visits), *([] if rest.first is None else [rest.first])]
    stands = tuple(p.xy if p.stand is None else p.stand for p in places)
    kept = _CACHE.get(drives)
    if kept is None or kept.stands != stands:
        kept = _CACHE[drives] = _CachedDistances(stands=stands)
    if len(places) > table and rest.first is not None and all(v.leaves is None for v in visits):
        if kept.legs is None:
            kept.legs = _along_roads(places, drives)
        return kept.legs
    if kept.table is None:
        kept.table = drives.lengths(places) if between is None else between(places)
    found = np.array(kept.table, dtype=np.float64)
    for number, visit in enumerate(visits, start=1):
        if visit.leaves is not None:
            lengths = between or drives.lengths
            found[number] = lengths([visit.leaves, *places])[0, 1:]
    if rest.first is None:
        padded = np.zeros((len(found) + 1, len(found) + 1))
        padded[:-1, :-1] = found
        found = padded
    return VisitDistances(distances=found)


@dataclass(kw_only=True)
class _CachedDistances:
    """Cache of the last distances, shared by forecast and guard."""

    stands: tuple[tuple[float, float], ...]
    legs: VisitDistances | None = None
    table: Floats | None = None


_CACHE: WeakKeyDictionary[Drives, _CachedDistances] = WeakKeyDictionary()


def _along_roads(places: Sequence[Place], drives: Drives) -> VisitDistances:
    from fieldhand.orienteering.network import Network

    roads = drives.roadmap(places)
    if roads.straight:
        return VisitDistances(coordinates=np.ascontiguousarray(roads.at[: len(places)]))
    network = Network(nodes=len(roads.at), edges=roads.ways, lengths=roads.lengths)
    return VisitDistances(table=network.table(range(len(places))))
