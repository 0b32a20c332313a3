"""Conditions on the tree at which an action was done, one class each."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, Protocol

import numpy as np

from fieldhand_bench.missions.case_site import CaseSite, CornerName, Points

Side = Literal["north", "south", "east", "west"]
#: Trees of the labelled steps, by label, as indices in the file.
StepLabels = Mapping[str, int]

_WAYS: Mapping[Side, tuple[float, float]] = {
    "north": (0.0, 1.0),
    "south": (0.0, -1.0),
    "east": (1.0, 0.0),
    "west": (-1.0, 0.0),
}
#: Maximum distance between neighbours, in spacings.
_NEIGHBOUR = 1.7
#: Minimum tolerance for trees near the middle or an edge, in spacings; and near an edge in metres.
_BESIDE = 1.5
_EDGE_M = 6.0
#: Minimum part of a distance that leads towards the required side: a cosine of about 45 degrees.
_TOWARD = 0.7
#: Number of trees nearest to a marker that count as the first or last tree.
_AT_MARKER = 2


@dataclass(frozen=True, kw_only=True)
class TestedTree:
    """A tree to be tested, with the trees of the steps before it."""

    site: CaseSite
    tree: int
    labels: StepLabels


class Demand(Protocol):
    """A condition on a tree."""

    @property
    def labels(self) -> tuple[str, ...]:
        """Labels of the steps whose trees the condition depends on."""
        ...

    def holds(self, it: TestedTree) -> bool:
        """Return True if the tree meets the condition."""
        ...


@dataclass(frozen=True, kw_only=True)
class CasePlace:
    """A place: the trees that meet every condition; without conditions, any tree.

    Attributes:
        demands: Conditions on the tree.
        words: The place as written in the case, for messages.
    """

    demands: tuple[Demand, ...] = ()
    words: str = "{}"

    @property
    def labels(self) -> frozenset[str]:
        """Labels of the steps whose trees the place depends on."""
        return frozenset(label for demand in self.demands for label in demand.labels)

    def holds(self, site: CaseSite, tree: int, labels: StepLabels) -> bool:
        """Return True if a tree is such a place."""
        it = TestedTree(site=site, tree=tree, labels=labels)
        return all(demand.holds(it) for demand in self.demands)


ANYWHERE = CasePlace()


class _Alone:
    """A condition that depends on no other step."""

    @property
    def labels(self) -> tuple[str, ...]:
        return ()


@dataclass(frozen=True)
class Corner(_Alone):
    """A corner of the smallest rectangle around the trees; None for any of the four."""

    name: CornerName | None

    def holds(self, it: TestedTree) -> bool:
        names = it.site.corners if self.name is None else (self.name,)
        return any(it.tree in it.site.corners[name] for name in names)


@dataclass(frozen=True)
class Beyond(_Alone):
    """The part of the trees' extent on these sides of its middle: one side for a half, two for a quarter.

    Half a spacing beyond the middle is tolerated, since people do not measure it.
    """

    sides: tuple[Side, ...]

    def holds(self, it: TestedTree) -> bool:
        out = it.site.xy[it.tree] - it.site.middle
        return all(_along(out, side) >= -it.site.spacing_m / 2 for side in self.sides)


@dataclass(frozen=True)
class Most(_Alone):
    """The trees at most ``within_m`` metres from the line through the farthest tree on that side."""

    side: Side
    within_m: float

    def holds(self, it: TestedTree) -> bool:
        return _to_edge(it, self.side) <= self.within_m


@dataclass(frozen=True)
class Central(_Alone):
    """The middle of the trees' extent: within that part of half its diagonal."""

    part: float

    def holds(self, it: TestedTree) -> bool:
        reach = self.part * float(np.hypot(*(it.site.high - it.site.low))) / 2
        away = float(np.hypot(*(it.site.xy[it.tree] - it.site.middle)))
        return away <= max(reach, _BESIDE * it.site.spacing_m)


@dataclass(frozen=True)
class MidEdge(_Alone):
    """The middle third of the edge on that side."""

    side: Side

    def holds(self, it: TestedTree) -> bool:
        if _to_edge(it, self.side) > max(_EDGE_M, _BESIDE * it.site.spacing_m):
            return False
        axis = 0 if self.side in ("north", "south") else 1
        off = abs(float(it.site.xy[it.tree][axis] - it.site.middle[axis]))
        return off <= float(it.site.high[axis] - it.site.low[axis]) / 6


@dataclass(frozen=True)
class Same:
    """The tree of the labelled step."""

    label: str

    @property
    def labels(self) -> tuple[str, ...]:
        return (self.label,)

    def holds(self, it: TestedTree) -> bool:
        return it.tree == it.labels[self.label]


@dataclass(frozen=True)
class OtherThan:
    """All trees except those of the labelled steps."""

    labels: tuple[str, ...]

    def holds(self, it: TestedTree) -> bool:
        return all(it.tree != it.labels[label] for label in self.labels)


@dataclass(frozen=True)
class Near:
    """The ``rank`` trees nearest to the labelled step's tree; if ``adjacent``, only those next to it."""

    label: str
    rank: int
    adjacent: bool = False

    @property
    def labels(self) -> tuple[str, ...]:
        return (self.label,)

    def holds(self, it: TestedTree) -> bool:
        of = it.labels[self.label]
        others = it.site.ranked(it.site.xy[of], self.rank + 1)[1:]
        if it.tree == of or it.tree not in others:
            return False
        return not self.adjacent or float(it.site.distances(of)[it.tree]) <= _NEIGHBOUR * it.site.spacing_m


@dataclass(frozen=True)
class Far:
    """The trees far from the labelled step's: at least ``fraction`` of the distance of the farthest one."""

    label: str
    fraction: float

    @property
    def labels(self) -> tuple[str, ...]:
        return (self.label,)

    def holds(self, it: TestedTree) -> bool:
        away = it.site.distances(it.labels[self.label])
        return float(away[it.tree]) >= self.fraction * float(away.max())


@dataclass(frozen=True)
class Offset:
    """The trees at a distance of so many spacings from the labelled step's tree, towards a side if one is given.

    Rows have gaps and spacings vary, so the tolerance is 1.5 spacings or 30 % of the distance, whichever is larger.
    """

    label: str
    trees: float
    toward: Side | None = None

    @property
    def labels(self) -> tuple[str, ...]:
        return (self.label,)

    def holds(self, it: TestedTree) -> bool:
        leg = it.site.xy[it.tree] - it.site.xy[it.labels[self.label]]
        away = math.hypot(*leg)
        wanted = self.trees * it.site.spacing_m
        if abs(away - wanted) > max(1.5 * it.site.spacing_m, 0.3 * wanted):
            return False
        return self.toward is None or _along(leg, self.toward) > _TOWARD * away


@dataclass(frozen=True)
class Positions(_Alone):
    """The trees at these indices in the file, counted from 0."""

    positions: frozenset[int]

    def holds(self, it: TestedTree) -> bool:
        return it.tree in self.positions


@dataclass(frozen=True)
class EndTree(_Alone):
    """The first or last tree: that of the file, or one of the two nearest to the marker."""

    marker: Literal["start", "end"]

    def holds(self, it: TestedTree) -> bool:
        if it.tree == (0 if self.marker == "start" else len(it.site.xy) - 1):
            return True
        at = it.site.markers.get(self.marker)
        return at is not None and it.tree in it.site.ranked(at, _AT_MARKER)


@dataclass(frozen=True)
class Attributes(_Alone):
    """The trees that have these attribute values in the file."""

    values: Mapping[str, Any]

    def holds(self, it: TestedTree) -> bool:
        return all(it.site.properties[it.tree].get(key) == value for key, value in self.values.items())


def _along(leg: Points, side: Side) -> float:
    """Return the component of a distance towards a side, metres."""
    return float(leg @ np.array(_WAYS[side]))


def _to_edge(it: TestedTree, side: Side) -> float:
    """Return the distance from a tree to the line through the farthest tree on that side, metres."""
    edge = it.site.high if side in ("north", "east") else it.site.low
    return _along(edge - it.site.xy[it.tree], side)
