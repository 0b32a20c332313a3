"""Which rows belong together, and where a road through all of them parts a block."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.rows.assemble import groups

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Rows up to this many row spacings apart are neighbours; so are rows about two spacings apart: one is missing.
_NEXT, _ONE_MISSING = 1.6, 0.2
#: Rows end this many row spacings or less from where their neighbours begin.
_BESIDE = 1.5
#: A gap in a row begins at this many tree spacings.
_GAP = 1.75
#: A road through a block is as unlikely as this to be missing trees.
_BY_CHANCE = 0.003


@dataclass(frozen=True, eq=False)
class Line:
    """A row while it is being found: its trees from one end, with their places along and across."""

    trees: Indices
    along: Floats
    across: Floats

    def across_at(self, along: float) -> float:
        """Where its middle is, from the trees next to there."""
        k = int(np.searchsorted(self.along, along))
        low = max(k - 4, 0)
        return float(np.mean(self.across[low : max(k + 4, low + 1)]))


def lines_of(local: Floats, label: Indices) -> list[Line]:
    """The rows of these labels (negative ones left out), each along its way."""
    found = []
    for own in groups(label, int(label.max(initial=-1)) + 1):
        if len(own):
            ordered = own[np.argsort(local[own, 1], kind="stable")]
            found.append(Line(ordered, local[ordered, 1], local[ordered, 0]))
    return found


def row_spacing(lines: list[Line], guess: float) -> float:
    """The middle of the distances between rows next to each other."""
    middle = np.sort([float(line.across.mean()) for line in lines if len(line.trees) > 1])
    steps = np.diff(middle)
    near = steps[(steps > 0.6 * guess) & (steps < 1.5 * guess)]
    return float(np.median(near)) if len(near) else guess


def together(lines: list[Line], spacing: float, *, trusted: bool = False) -> Indices:
    """Label rows by the block they are in: those side by side at about the row spacing.

    Args:
        trusted: Whether a row of a tree or two is one anywhere beside another, not only where a row is due.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    count = len(lines)
    middle = np.array([line.across.mean() for line in lines])
    spread = max((float(np.ptp(line.across)) for line in lines), default=0.0)
    order = np.argsort(middle, kind="stable")
    reach = (2 + _ONE_MISSING) * spacing + spread
    until = np.searchsorted(middle[order], middle[order] + reach, side="right")
    linked: list[tuple[int, int]] = []
    for place, a in enumerate(order):
        near = order[place + 1 : until[place]]
        linked.extend((int(a), int(b)) for b in near if _beside(lines[a], lines[b], spacing, trusted))
    pairs = np.array(linked, dtype=np.intp).reshape(-1, 2)
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.intp)


def _beside(a: Line, b: Line, spacing: float, trusted: bool) -> bool:
    low, high = max(a.along[0], b.along[0]), min(a.along[-1], b.along[-1])
    if low - high > _BESIDE * spacing:
        return False
    at = 0.5 * (low + high)
    apart = abs(a.across_at(at) - b.across_at(at)) / spacing
    few, more = sorted((len(a.trees), len(b.trees)))
    if not trusted and few < 3:  # a tree or two are a row only where one is due
        return bool(abs(apart - 1.0) < (0.3 if more >= 3 else 0.2) and few + more >= 4)
    return bool(0.3 < apart < _NEXT or abs(apart - 2.0) < _ONE_MISSING)


def parted(lines: list[Line], spacing: float) -> list[list[Line]]:
    """A block's rows, cut where a road leads through all of them: one list of rows for each part.

    A road is a strip across the rows that no row has a tree in, where that is too unlikely to be missing trees:
    the part of missing trees, to the power of how many are missing there, times the places where it could be.
    """
    roads = _roads(lines, spacing)
    if not len(roads):
        return [lines]
    parts: list[list[Line]] = [[] for _ in range(len(roads) + 1)]
    for line in lines:
        which = np.searchsorted(roads, line.along)
        for k in np.unique(which):
            own = which == k
            parts[k].append(Line(line.trees[own], line.along[own], line.across[own]))
    return [part for part in parts if part]


def _roads(lines: list[Line], spacing: float) -> Floats:
    long = [line for line in lines if len(line.trees) > 1]
    if len(long) < 2:
        return np.empty(0)
    starts = np.concatenate([line.along[:-1] for line in long])
    ends = np.concatenate([line.along[1:] for line in long])
    wide = ends - starts > _GAP * spacing
    slots = np.rint((ends - starts) / spacing)
    planted = sum(len(line.trees) for line in long)
    starts, ends, slots = starts[wide], ends[wide], slots[wide]
    if not len(starts):
        return np.empty(0)
    low, high = np.sort([line.along[0] for line in long]), np.sort([line.along[-1] for line in long])
    at = np.unique(np.concatenate([starts + 0.4 * spacing, ends - 0.4 * spacing]))
    through = np.searchsorted(low, at) - np.searchsorted(high, at)
    gaps = np.searchsorted(np.sort(starts), at) - np.searchsorted(np.sort(ends), at)
    empty = (through >= 2) & (gaps >= through)
    roads: list[float] = []
    places = max(float(np.ptp(at)) / spacing, 1.0) + 20.0
    k = 0
    while k < len(at):
        if not empty[k]:
            k += 1
            continue
        j = k
        while j + 1 < len(at) and empty[j + 1]:
            j += 1
        middle = 0.5 * (at[k] + at[j])
        here = (starts < middle) & (ends > middle)
        k = j + 1
        if here.sum() < 2:
            continue
        elsewhere = float((slots - 1)[~here].sum())
        missing = float(np.clip(elsewhere / (planted + elsewhere), 0.05, 0.3))
        lost = float(np.maximum((ends - starts)[here] / spacing - 1.3, 0.0).sum())
        shared = float(ends[here].min() - starts[here].max()) / spacing
        if shared > 1.2 and lost * np.log(missing) + np.log(places) < np.log(_BY_CHANCE):
            roads.append(middle)
    return np.array(roads)
