"""What a case may demand of the tree at which something was done, one class a demand."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, Protocol

import numpy as np

from fieldhand_bench.missions.ground import CornerName, Ground, Points

Side = Literal["north", "south", "east", "west"]
#: The trees of steps that have a label, by their position in the file.
Labels = Mapping[str, int]

_WAYS: Mapping[Side, tuple[float, float]] = {
    "north": (0.0, 1.0),
    "south": (0.0, -1.0),
    "east": (1.0, 0.0),
    "west": (-1.0, 0.0),
}
#: Neighbours are at most so many spacings apart.
_NEIGHBOUR = 1.7
#: Near an edge, and near the middle of all trees: at least so many spacings count.
_BESIDE = 1.5
_EDGE_M = 6.0
#: Part of a leg along a row that must lead towards the side asked for (45 degrees, as good as).
_TOWARD = 0.7
#: How many of the trees nearest to a marker may pass for the first or last tree.
_AT_MARKER = 2


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """A tree of which something is to hold, with those of the steps before it."""

    ground: Ground
    tree: int
    labels: Labels


class Demand(Protocol):
    """One thing that must hold of a tree."""

    @property
    def labels(self) -> tuple[str, ...]:
        """Labels of other steps without whose trees this cannot be told."""
        ...

    def holds(self, it: Candidate) -> bool:
        """Whether it holds of that tree."""
        ...


@dataclass(frozen=True, kw_only=True)
class Place:
    """Where something must be done: every demand holds of its tree. None means at any tree.

    Attributes:
        words: As the case says it, for messages.
    """

    demands: tuple[Demand, ...] = ()
    words: str = "{}"

    @property
    def labels(self) -> frozenset[str]:
        """Labels of the steps that must be known first."""
        return frozenset(label for demand in self.demands for label in demand.labels)

    def holds(self, ground: Ground, tree: int, labels: Labels) -> bool:
        """Whether a tree is such a place."""
        it = Candidate(ground=ground, tree=tree, labels=labels)
        return all(demand.holds(it) for demand in self.demands)


ANYWHERE = Place()


class _Alone:
    """A demand that needs no other step."""

    @property
    def labels(self) -> tuple[str, ...]:
        return ()


@dataclass(frozen=True)
class Corner(_Alone):
    """A corner of the smallest rectangle about the trees; None for any of the four."""

    name: CornerName | None

    def holds(self, it: Candidate) -> bool:
        names = it.ground.corners if self.name is None else (self.name,)
        return any(it.tree in it.ground.corners[name] for name in names)


@dataclass(frozen=True)
class Beyond(_Alone):
    """On these sides of the middle lines of the trees' extent: one side for a half, two for a quarter.

    Half a spacing on the other side is still well, since people do not measure it.
    """

    sides: tuple[Side, ...]

    def holds(self, it: Candidate) -> bool:
        out = it.ground.xy[it.tree] - it.ground.middle
        return all(_along(out, side) >= -it.ground.spacing_m / 2 for side in self.sides)


@dataclass(frozen=True)
class Most(_Alone):
    """At most ``within_m`` metres short of the tree that lies farthest on that side."""

    side: Side
    within_m: float

    def holds(self, it: Candidate) -> bool:
        return _to_edge(it, self.side) <= self.within_m


@dataclass(frozen=True)
class Central(_Alone):
    """Within that part of half the diagonal from the middle of the trees' extent."""

    part: float

    def holds(self, it: Candidate) -> bool:
        reach = self.part * float(np.hypot(*(it.ground.high - it.ground.low))) / 2
        away = float(np.hypot(*(it.ground.xy[it.tree] - it.ground.middle)))
        return away <= max(reach, _BESIDE * it.ground.spacing_m)


@dataclass(frozen=True)
class MidEdge(_Alone):
    """Near the edge on that side, in the middle third of it."""

    side: Side

    def holds(self, it: Candidate) -> bool:
        if _to_edge(it, self.side) > max(_EDGE_M, _BESIDE * it.ground.spacing_m):
            return False
        axis = 0 if self.side in ("north", "south") else 1
        off = abs(float(it.ground.xy[it.tree][axis] - it.ground.middle[axis]))
        return off <= float(it.ground.high[axis] - it.ground.low[axis]) / 6


@dataclass(frozen=True)
class Same:
    """The tree of that step."""

    label: str

    @property
    def labels(self) -> tuple[str, ...]:
        return (self.label,)

    def holds(self, it: Candidate) -> bool:
        return it.tree == it.labels[self.label]


@dataclass(frozen=True)
class OtherThan:
    """None of the trees of those steps."""

    labels: tuple[str, ...]

    def holds(self, it: Candidate) -> bool:
        return all(it.tree != it.labels[label] for label in self.labels)


@dataclass(frozen=True)
class Near:
    """One of the ``rank`` other trees nearest to that step's; if ``adjacent``, a neighbour of it, too."""

    label: str
    rank: int
    adjacent: bool = False

    @property
    def labels(self) -> tuple[str, ...]:
        return (self.label,)

    def holds(self, it: Candidate) -> bool:
        of = it.labels[self.label]
        others = it.ground.ranked(it.ground.xy[of], self.rank + 1)[1:]
        if it.tree == of or it.tree not in others:
            return False
        return not self.adjacent or float(it.ground.distances(of)[it.tree]) <= _NEIGHBOUR * it.ground.spacing_m


@dataclass(frozen=True)
class Far:
    """As far from that step's tree as ``fraction`` of the farthest tree is, at least."""

    label: str
    fraction: float

    @property
    def labels(self) -> tuple[str, ...]:
        return (self.label,)

    def holds(self, it: Candidate) -> bool:
        away = it.ground.distances(it.labels[self.label])
        return float(away[it.tree]) >= self.fraction * float(away.max())


@dataclass(frozen=True)
class Offset:
    """So many spacings from that step's tree, in either direction unless one is asked for.

    Rows have gaps and spacings vary, so it may be 1.5 spacings more or less, or three tenths of the distance.
    """

    label: str
    trees: float
    toward: Side | None = None

    @property
    def labels(self) -> tuple[str, ...]:
        return (self.label,)

    def holds(self, it: Candidate) -> bool:
        leg = it.ground.xy[it.tree] - it.ground.xy[it.labels[self.label]]
        away = math.hypot(*leg)
        wanted = self.trees * it.ground.spacing_m
        if abs(away - wanted) > max(1.5 * it.ground.spacing_m, 0.3 * wanted):
            return False
        return self.toward is None or _along(leg, self.toward) > _TOWARD * away


@dataclass(frozen=True)
class Positions(_Alone):
    """One of the trees at these positions in the file, counted from 0."""

    positions: frozenset[int]

    def holds(self, it: Candidate) -> bool:
        return it.tree in self.positions


@dataclass(frozen=True)
class Terminal(_Alone):
    """The first or the last tree: the file's, or one of the two nearest to the marker of that name."""

    marker: Literal["start", "end"]

    def holds(self, it: Candidate) -> bool:
        if it.tree == (0 if self.marker == "start" else len(it.ground.xy) - 1):
            return True
        at = it.ground.markers.get(self.marker)
        return at is not None and it.tree in it.ground.ranked(at, _AT_MARKER)


@dataclass(frozen=True)
class Attributes(_Alone):
    """The file says these values of the tree."""

    values: Mapping[str, Any]

    def holds(self, it: Candidate) -> bool:
        return all(it.ground.properties[it.tree].get(key) == value for key, value in self.values.items())


def _along(leg: Points, side: Side) -> float:
    """Metres of a leg towards a side."""
    return float(leg @ np.array(_WAYS[side]))


def _to_edge(it: Candidate, side: Side) -> float:
    """Metres from a tree to the farthest of all on that side, across."""
    edge = it.ground.high if side in ("north", "east") else it.ground.low
    return _along(edge - it.ground.xy[it.tree], side)
