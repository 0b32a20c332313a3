"""Trace rows from tree to tree, given their direction."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.point_index import PointIndex
from fieldhand.site.rows.assemble import tree_spacing
from fieldhand.site.rows.labels import groups, linked

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

#: In tree spacings: range along the row of trees that determine its centre line, range of trees that are linked, and
#: range across the row.
_WINDOW, _REACH, _ACROSS = 4.6, 3.6, 0.75
#: Greatest distance between the centre lines at two trees of one row, in tree spacings.
_IN_LINE = 0.3
#: Width of the kernel that finds the centre line of a row, in tree spacings.
_KERNEL = 0.24
#: Test for two rows traced as one: least number of trees; least distance in tree spacings; least distance in standard
#: deviations, larger than any split of one row gives; and least fraction of trees closer along the row than the spacing
#: allows.
_TWINS, _TWINS_APART, _TWO_NOT_ONE, _CROWDED = 15, 0.3, 4.2, 0.12
#: The longest gap in a row, in tree spacings.
LONGEST_GAP = 10.5


def turned(points: Floats, wave: Floats) -> Floats:
    """Return the coordinates across and along the rows of a wave, shape (n, 2)."""
    across = wave / np.hypot(*wave)
    return np.asarray(points @ np.column_stack([across, [-across[1], across[0]]]))


def spacing_along(local: Floats, row_spacing: float) -> float:
    """Return the approximate tree spacing along the rows: the median distance to the nearest tree in line."""
    if len(local) < 2:
        return row_spacing
    stretched = local * np.array([3.0, 1.0])
    near = PointIndex(stretched).nearest_few(stretched, 2)[1][:, 1]
    steps = np.abs(local[near] - local)
    in_line = steps[steps[:, 0] < 0.3 * row_spacing, 1]
    return float(np.median(in_line)) if len(in_line) else row_spacing


def trace(local: Floats, slope: Floats, spacing: float) -> Indices:
    """Label trees by the piece of row that they belong to, from 0.

    Args:
        local: Trees across and along the rows' mean direction, shape (n, 2).
        slope: Slope of the rows at each tree: metres across for each metre along, shape (n,).
        spacing: Tree spacing along the rows in metres.
    """
    n = len(local)
    if n < 2:
        return np.zeros(n, dtype=np.intp)
    reach = float(np.abs(slope).max()) * _WINDOW if n else 0.0
    scaled = local / (spacing * np.array([_ACROSS + reach, _WINDOW]))
    pairs = PointIndex(scaled).pairs(1.0, each_axis=True)
    i, j = pairs[:, 0], pairs[:, 1]
    along = local[j, 1] - local[i, 1]
    aside = local[j, 0] - local[i, 0] - along * 0.5 * (slope[i] + slope[j])
    middle = _middles(i, j, aside, n, _KERNEL * spacing)
    in_line = np.abs(aside + middle[j] - middle[i]) < _IN_LINE * spacing
    near = in_line & (np.abs(along) < _REACH * spacing)
    return linked(n, i[near], j[near])


def _middles(i: Indices, j: Indices, aside: Floats, n: int, width: float) -> Floats:
    """Return the metres from each tree to the centre line of its row: the density peak of the trees in line with it."""
    at, seen = np.concatenate([i, j]), np.concatenate([aside, -aside])
    middle = np.zeros(n)
    for _ in range(4):
        weight = np.exp(-0.5 * ((seen - middle[at]) / width) ** 2)
        own = np.exp(-0.5 * (middle / width) ** 2)  # the tree itself
        middle = np.bincount(at, weight * seen, minlength=n) / (np.bincount(at, weight, minlength=n) + own)
    return np.asarray(middle)


def pooled_slope(local: Floats, label: Indices) -> float:
    """Return the common slope of pieces of rows: metres across for each metre along."""
    count = np.maximum(np.bincount(label), 1)
    off = local - np.column_stack([np.bincount(label, local[:, k]) / count for k in (0, 1)])[label]
    return float((off[:, 0] * off[:, 1]).sum() / max((off[:, 1] ** 2).sum(), 1e-12))


def join_across_gaps(local: Floats, slope: Floats, label: Indices, spacing: float) -> Indices:
    """Join pieces of rows that continue in line across a gap; return labels from 0."""
    for _ in range(3):
        joined = _joined_once(local, slope, label, spacing)
        if joined.max(initial=-1) == label.max(initial=-1):
            return joined
        label = joined
    return label


def _joined_once(local: Floats, slope: Floats, label: Indices, spacing: float) -> Indices:
    pieces = groups(label, int(label.max(initial=-1)) + 1)
    count = len(pieces)
    head, tail = np.empty((count, 3)), np.empty((count, 3))
    for k, own in enumerate(pieces):
        ordered = own[np.argsort(local[own, 1], kind="stable")]
        head[k], tail[k] = _end(local, slope, ordered[:8], first=True), _end(local, slope, ordered[-8:], first=False)
    # Search along the row from the tail of each piece for heads of others.
    scale = spacing * np.array([0.5, LONGEST_GAP / 2])
    ahead = tail[:, :2] + np.column_stack([tail[:, 2], np.ones(count)]) * (LONGEST_GAP / 2 * spacing)
    a, b = PointIndex(head[:, :2] / scale).close_to(ahead / scale, 1.0, each_axis=True).T
    gap = head[b, 1] - tail[a, 1]
    miss = np.abs(head[b, 0] - tail[a, 0] - gap * 0.5 * (tail[a, 2] + head[b, 2]))
    size = np.array([len(own) for own in pieces])
    small = np.minimum(size[a], size[b])
    # A long gap needs pieces of several trees on both sides: the row of a distant single tree is ambiguous.
    allowed = np.where(small >= 3, LONGEST_GAP, np.where(small == 2, 6.5, 4.5)) * spacing
    fits = (gap > -0.3 * spacing) & (a != b) & (gap < allowed)
    fits &= miss < np.where(small >= 4, 0.33, 0.42) * spacing
    a, b, cost = a[fits], b[fits], gap[fits] / spacing + 4 * (miss[fits] / spacing)
    best_ahead, best_behind = np.full(count, np.inf), np.full(count, np.inf)
    np.minimum.at(best_ahead, a, cost)
    np.minimum.at(best_behind, b, cost)
    mutual = (cost <= best_ahead[a]) & (cost <= best_behind[b])
    return linked(count, a[mutual], b[mutual])[label]


def _end(local: Floats, slope: Floats, trees: Indices, *, first: bool) -> tuple[float, float, float]:
    """Return the end of a piece: coordinates across (mean of the trees next to it) and along, and the slope there."""
    at = trees[0] if first else trees[-1]
    lean = float(slope[trees].mean())
    across = local[trees, 0] - (local[trees, 1] - local[at, 1]) * lean
    return float(across.mean()), float(local[at, 1]), lean


def split_double_rows(local: Floats, label: Indices, spacing: float) -> Indices:
    """Split rows that consist of two close parallel rows, with a free strip between them along the whole row.

    Args:
        local: Coordinates across and along rows that are straight and parallel here.
    """
    split = label.copy()
    for own in groups(label, int(label.max(initial=-1)) + 1):
        if len(own) < _TWINS or np.mean(np.diff(np.sort(local[own, 1])) < 0.5 * spacing) < _CROWDED:
            continue
        across = np.sort(local[own, 0])
        total, square = np.cumsum(across), np.cumsum(across**2)
        left = np.arange(1, len(across))
        right = len(across) - left
        low, high = total[:-1] / left, (total[-1] - total[:-1]) / right
        within = np.maximum(square[-1] - left * low**2 - right * high**2, 1e-12) / (len(across) - 2)
        apart = (high - low) / np.sqrt(within)
        apart[(np.minimum(left, right) < _TWINS // 3) | (high - low < _TWINS_APART * spacing)] = 0.0
        cut = int(np.argmax(apart))
        if apart[cut] < _TWO_NOT_ONE:
            continue
        far = local[own, 0] > 0.5 * (across[cut] + across[cut + 1])
        one, other = local[own[~far], 1], local[own[far], 1]
        shared = min(one.max(), other.max()) - max(one.min(), other.min())
        if shared > 0.5 * min(np.ptp(one), np.ptp(other)):
            split[own[far]] = split.max() + 1
    return split


def spacing_of(local: Floats, label: Indices) -> float:
    """Return the tree spacing along pieces of rows; 0 if none has two trees."""
    return tree_spacing([np.sort(local[own, 1]) for own in groups(label, int(label.max(initial=-1)) + 1)])
