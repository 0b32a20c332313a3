"""Group rows that lie side by side into blocks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.rows.labels import groups, linked

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Rows up to this many row spacings apart are neighbours; so are rows two spacings apart within this tolerance, with a
#: missing row between them.
_NEXT, _ONE_MISSING = 1.6, 0.2
#: Greatest gap along the rows between neighbours, in row spacings.
_BESIDE = 1.5


@dataclass(frozen=True, eq=False)
class TracedRow:
    """A row being traced: its trees from one end, with their coordinates along and across."""

    trees: Indices
    along: Floats
    across: Floats

    def across_at(self, along: float) -> float:
        """Return the coordinate across the row at a point along it, averaged over the nearest trees."""
        k = int(np.searchsorted(self.along, along))
        low = max(k - 4, 0)
        return float(np.mean(self.across[low : max(k + 4, low + 1)]))


def traced_rows(local: Floats, label: Indices) -> list[TracedRow]:
    """Return the rows of these labels (negative ones left out), with their trees sorted along the row."""
    found = []
    for own in groups(label, int(label.max(initial=-1)) + 1):
        if len(own):
            ordered = own[np.argsort(local[own, 1], kind="stable")]
            found.append(TracedRow(ordered, local[ordered, 1], local[ordered, 0]))
    return found


def row_spacing(lines: list[TracedRow], guess: float) -> float:
    """Return the median distance from rows to the next row beside them."""
    ordered = sorted((line for line in lines if len(line.trees) > 1), key=lambda line: float(line.across.mean()))
    middle = np.array([float(line.across.mean()) for line in ordered])
    first, last = (np.array([line.along[k] for line in ordered]) for k in (0, -1))
    until = np.searchsorted(middle, middle + 1.5 * guess)
    steps = []
    for k, end in enumerate(until.tolist()):
        # Rows beyond a road, or other pieces of the same row, do not overlap with it.
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
    """Label rows by their block: adjacent rows at about the row spacing.

    Args:
        lines: Rows to group.
        spacing: Row spacing in metres.
        trusted: Accept rows of one or two trees beside any other row, not only at the row spacing.
        sides: Side of each road that each row lies on, -1 or 1, or 0 if it does not adjoin the road; rows on different
            sides are in different blocks. Shape (roads, rows).
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
    if not trusted and few < 3:  # one or two trees are a row only at the row spacing
        return bool(abs(apart - 1.0) < (0.3 if more >= 3 else 0.2) and few + more >= 4)
    return bool(0.3 < apart < _NEXT or abs(apart - 2.0) < _ONE_MISSING)
