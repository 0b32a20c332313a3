"""Group rows that lie side by side into blocks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.rows.labels import groups, linked

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Rows up to this many row spacings apart are neighbours; so are rows about two spacings apart: one is missing.
_NEXT, _ONE_MISSING = 1.6, 0.2
#: Rows end this many row spacings or less from where their neighbours begin.
_BESIDE = 1.5


@dataclass(frozen=True, eq=False)
class TracedRow:
    """A row under construction: its trees from one end, with their coordinates along and across."""

    trees: Indices
    along: Floats
    across: Floats

    def across_at(self, along: float) -> float:
        """Where its middle is, from the trees next to there."""
        k = int(np.searchsorted(self.along, along))
        low = max(k - 4, 0)
        return float(np.mean(self.across[low : max(k + 4, low + 1)]))


def traced_rows(local: Floats, label: Indices) -> list[TracedRow]:
    """The rows of these labels (negative ones left out), each along its way."""
    found = []
    for own in groups(label, int(label.max(initial=-1)) + 1):
        if len(own):
            ordered = own[np.argsort(local[own, 1], kind="stable")]
            found.append(TracedRow(ordered, local[ordered, 1], local[ordered, 0]))
    return found


def row_spacing(lines: list[TracedRow], guess: float) -> float:
    """The middle of the distances from rows to the next one beside them."""
    ordered = sorted((line for line in lines if len(line.trees) > 1), key=lambda line: float(line.across.mean()))
    middle = np.array([float(line.across.mean()) for line in ordered])
    first, last = (np.array([line.along[k] for line in ordered]) for k in (0, -1))
    until = np.searchsorted(middle, middle + 1.5 * guess)
    steps = []
    for k, end in enumerate(until.tolist()):
        # Rows of the block beyond a road, or pieces of one row, are not beside it.
        after = slice(k + 1, end)
        shared = np.minimum(last[k], last[after]) - np.maximum(first[k], first[after])
        half = shared > 0.5 * np.minimum(last[k] - first[k], last[after] - first[after])
        near = (middle[after] - middle[k])[half]
        near = near[near > 0.6 * guess]
        if len(near):
            steps.append(float(near[0]))
    return float(np.median(steps)) if steps else guess


def group_rows(
    lines: list[TracedRow], spacing: float, *, trusted: bool = False, sides: NDArray[np.intp] | None = None
) -> Indices:
    """Label rows by the block they are in: those side by side at about the row spacing.

    Args:
        trusted: Whether a row of a tree or two is one anywhere beside another, not only where a row is due.
        sides: Of each road the rows at one side of it, -1, and at the other, 1, which are in different blocks; 0 for
            those that are not beside it. Shape (roads, rows).
    """

    count = len(lines)
    middle = np.array([line.across.mean() for line in lines])
    spread = max((float(np.ptp(line.across)) for line in lines), default=0.0)
    order = np.argsort(middle, kind="stable")
    reach = (2 + _ONE_MISSING) * spacing + spread
    until = np.searchsorted(middle[order], middle[order] + reach, side="right")
    beside: list[tuple[int, int]] = []
    for place, a in enumerate(order):
        near = order[place + 1 : until[place]]
        beside.extend((int(a), int(b)) for b in near if _beside(lines[a], lines[b], spacing, trusted))
    pairs = np.array(beside, dtype=np.intp).reshape(-1, 2)
    if sides is not None:
        pairs = pairs[(sides[:, pairs[:, 0]] * sides[:, pairs[:, 1]] >= 0).all(axis=0)]
    return linked(count, pairs[:, 0], pairs[:, 1])


def _beside(a: TracedRow, b: TracedRow, spacing: float, trusted: bool) -> bool:
    low, high = max(a.along[0], b.along[0]), min(a.along[-1], b.along[-1])
    if low - high > _BESIDE * spacing:
        return False
    at = 0.5 * (low + high)
    apart = abs(a.across_at(at) - b.across_at(at)) / spacing
    few, more = sorted((len(a.trees), len(b.trees)))
    if not trusted and few < 3:  # a tree or two are a row only where one is due
        return bool(abs(apart - 1.0) < (0.3 if more >= 3 else 0.2) and few + more >= 4)
    return bool(0.3 < apart < _NEXT or abs(apart - 2.0) < _ONE_MISSING)
