"""Statistical evidence for rows against scattered trees, and confidence in rows and their direction."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.point_index import PointIndex

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Spread across and along the row of scattered trees in line by chance, in tree spacings; and the least spread assumed
#: for rows.
_LOOSE_ACROSS, _LOOSE_ALONG, _LEAST = 0.9, 1.2, 0.01
#: Evidence for each tree beside which the lane is free, and against the row for each tree in the lane.
_FREE, _IN_THE_LANE = 0.5, 1.5
#: Distance of the lane from its row, from and to, in tree spacings.
_LANE = (0.5, 0.85)
#: Fraction of missing trees that is tolerated, and the evidence against the row for each further one.
_OFTEN_MISSING, _MISSING = 0.3, 0.8


def log_likelihood_ratio(xy: Floats, rows: Sequence[Indices], way: Floats, spacing: float) -> float:
    """Return the log-likelihood ratio of trees planted in these rows against scattered trees.

    The evidence for rows is: small distances of the trees from the row's line, whole numbers of tree spacings between
    them, few gaps, and a free lane beside them.

    Args:
        xy: All trees of the site.
        rows: Trees of each row, in order.
        way: Unit vector along the rows.
        spacing: Tree spacing.
    """
    across = np.array([way[1], -way[0]])
    off = along = 0.0
    trees = steps = missing = 0
    for own in rows:
        trees += len(own)
        if len(own) < 2:
            continue
        u, v = xy[own] @ across, np.sort(xy[own] @ way)
        off += _about_its_line(u)
        step = np.diff(v) / spacing
        whole = np.maximum(np.rint(step), 1.0)
        along += float(((step - whole) ** 2).sum())
        missing += int((whole - 1).sum())
        steps += len(step)
    free = max(trees - len(rows) - 1, 1)
    spread = math.sqrt(2 * math.pi * math.e)
    straight = math.log(_LOOSE_ACROSS / (spread * max(math.sqrt(off / free) / spacing, _LEAST)))
    even = math.log(_LOOSE_ALONG / (spread * max(math.sqrt(along / max(steps, 1)), _LEAST)))
    gaps = _MISSING * max(missing - _OFTEN_MISSING * trees, 0.0)
    lane = _FREE * (trees - len(rows)) - _IN_THE_LANE * _in_the_lanes(xy, rows, way, spacing)
    return (trees - len(rows) - 1) * (straight + even) + lane - gaps


def required_evidence(trees: int) -> float:
    """Return the evidence required for rows among a number of trees; more trees align by chance more often."""
    return 6.0 + 0.9 * math.log(max(trees, 1))


def _about_its_line(across: Floats) -> float:
    """Return the sum of squared distances from the row's line; for a curved row, from the moving average of the row."""
    flat = float(((across - across.mean()) ** 2).sum())
    if len(across) < 12:
        return flat
    window = 7
    total = np.cumsum(np.concatenate([[0.0], across]))
    low = np.clip(np.arange(len(across)) - window // 2, 0, len(across) - window)
    middle = (total[low + window] - total[low]) / window
    return min(flat, float(((across - middle) ** 2).sum()) * window / (window - 1))


def _in_the_lanes(xy: Floats, rows: Sequence[Indices], way: Floats, spacing: float) -> int:
    """Return the number of trees in the lanes beside trees of the rows."""
    own = np.concatenate(rows)
    row_of = np.full(len(xy), -1, dtype=np.intp)
    row_of[own] = np.repeat(np.arange(len(rows)), [len(r) for r in rows])
    local = xy @ np.array([[way[1], way[0]], [-way[0], way[1]]])
    low, high = local[own].min(axis=0) - 2 * spacing, local[own].max(axis=0) + 2 * spacing
    about = np.flatnonzero(((local >= low) & (local <= high)).all(axis=1))
    scaled = local / (spacing * np.array([_LANE[1], 0.6]))
    pairs = about[PointIndex(scaled[about]).pairs(1.0, each_axis=True)]
    i, j = pairs[:, 0], pairs[:, 1]
    beside = (np.abs(local[i, 0] - local[j, 0]) > _LANE[0] * spacing) & (row_of[i] != row_of[j])
    return int((row_of[i][beside] >= 0).sum() + (row_of[j][beside] >= 0).sum())


def bearing_confidence(evidence: float, enough: float, spacing_ratio: float, file_order_share: float) -> float:
    """Return the confidence, 0 to 1, in the direction of rows: that they are rows, and the lines across them are not.

    Args:
        evidence: Result of :func:`log_likelihood_ratio`.
        enough: Result of :func:`required_evidence`.
        spacing_ratio: Ratio of the row spacing to that of the lines of trees across; inf without such lines.
        file_order_share: Fraction of the steps from tree to tree in the order of the file that go along the rows,
            among those along or across; 0.5 if unknown.
    """
    rows_at_all = 1.0 / (1.0 + math.exp(-min((evidence - enough) / 2.0 + 0.5, 50.0)))
    square = math.exp(-(((max(spacing_ratio, 1.0) - 1.0) / 0.05) ** 2)) if math.isfinite(spacing_ratio) else 0.0
    which = 1.0 - 0.5 * square * (1.0 - abs(2 * file_order_share - 1.0) * 0.9)
    return rows_at_all * which


def row_confidence(
    xy: Floats, trees: Indices, way: Floats, tree_spacing: float, row_spacing: float, off: float
) -> float:
    """Return the confidence, 0 to 1, that exactly these trees form a row, given the direction of the rows.

    It is the probability that each tree is nearer to its own row than to the next one, from the standard deviation of
    trees about their rows (``off``, metres) and the row spacing, times ``1 - k^2/200`` for each gap of k missing trees.
    """
    each = math.erf(0.5 * row_spacing / max(off, 1e-6) / math.sqrt(2.0)) if math.isfinite(row_spacing) else 1.0
    steps = np.rint(np.diff(np.sort(xy[trees] @ way)) / max(tree_spacing, 1e-9)) - 1.0
    gaps = np.prod(1.0 - np.minimum(np.maximum(steps, 0.0) ** 2 / 200.0, 0.5))
    few = 1.0 if len(trees) > 2 else 0.8
    return float(each ** len(trees) * gaps * few)
