"""Trace rows from tree to tree where their direction is known."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.rows.assemble import tree_spacing
from fieldhand.site.rows.labels import groups, linked

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

#: In tree spacings: how far along the row trees say where its middle is, how far they are linked, and from what
#: distance across.
_WINDOW, _REACH, _ACROSS = 4.6, 3.6, 0.75
#: Trees whose rows' middles differ by no more than this part of the tree spacing are in one row.
_IN_LINE = 0.3
#: Width of the kernel that finds the middle of a row, in tree spacings.
_KERNEL = 0.24
#: Rows of this many trees and more are looked at whether they are two, this many tree spacings apart and more: the
#: middles of two are farther apart, in standard deviations about them, than any parting of one row gives.
#: In two rows taken for one many trees stand closer along it than trees do: this part of them and more.
_TWINS, _TWINS_APART, _TWO_NOT_ONE, _CROWDED = 15, 0.3, 4.2, 0.12
#: The longest gap in a row, in tree spacings.
LONGEST_GAP = 10.5


def turned(points: Floats, wave: Floats) -> Floats:
    """Coordinates across and along the rows of a wave, shape (n, 2)."""
    across = wave / np.hypot(*wave)
    return np.asarray(points @ np.column_stack([across, [-across[1], across[0]]]))


def spacing_along(local: Floats, row_spacing: float) -> float:
    """About the tree spacing along the rows: the middle of the distances to the nearest tree in line."""
    from scipy.spatial import cKDTree

    if len(local) < 2:
        return row_spacing
    stretched = local * np.array([3.0, 1.0])
    near = np.asarray(cKDTree(stretched).query(stretched, k=2)[1])[:, 1]
    steps = np.abs(local[near] - local)
    in_line = steps[steps[:, 0] < 0.3 * row_spacing, 1]
    return float(np.median(in_line)) if len(in_line) else row_spacing


def trace(local: Floats, slope: Floats, spacing: float) -> Indices:
    """Label trees by the piece of row that they stand in, from 0.

    Args:
        local: Trees across and along the rows' mean direction, shape (n, 2).
        slope: Of the rows at each tree: metres across for each metre along, shape (n,).
        spacing: From tree to tree along the rows.
    """
    from scipy.spatial import cKDTree

    n = len(local)
    if n < 2:
        return np.zeros(n, dtype=np.intp)
    reach = float(np.abs(slope).max()) * _WINDOW if n else 0.0
    scaled = local / (spacing * np.array([_ACROSS + reach, _WINDOW]))
    pairs = cKDTree(scaled).query_pairs(1.0, p=np.inf, output_type="ndarray")
    i, j = pairs[:, 0], pairs[:, 1]
    along = local[j, 1] - local[i, 1]
    aside = local[j, 0] - local[i, 0] - along * 0.5 * (slope[i] + slope[j])
    middle = _middles(i, j, aside, n, _KERNEL * spacing)
    in_line = np.abs(aside + middle[j] - middle[i]) < _IN_LINE * spacing
    near = in_line & (np.abs(along) < _REACH * spacing)
    return linked(n, i[near], j[near])


def _middles(i: Indices, j: Indices, aside: Floats, n: int, width: float) -> Floats:
    """How far across the middle of its row is from each tree: the peak of the density of trees in line with it."""
    at, seen = np.concatenate([i, j]), np.concatenate([aside, -aside])
    middle = np.zeros(n)
    for _ in range(4):
        weight = np.exp(-0.5 * ((seen - middle[at]) / width) ** 2)
        own = np.exp(-0.5 * (middle / width) ** 2)  # the tree itself
        middle = np.bincount(at, weight * seen, minlength=n) / (np.bincount(at, weight, minlength=n) + own)
    return np.asarray(middle)


def pooled_slope(local: Floats, label: Indices) -> float:
    """The slope that pieces of rows share: metres across for each metre along."""
    count = np.maximum(np.bincount(label), 1)
    off = local - np.column_stack([np.bincount(label, local[:, k]) / count for k in (0, 1)])[label]
    return float((off[:, 0] * off[:, 1]).sum() / max((off[:, 1] ** 2).sum(), 1e-12))


def join_across_gaps(local: Floats, slope: Floats, label: Indices, spacing: float) -> Indices:
    """Join pieces of rows that continue in line across a gap. Labels from 0."""
    for _ in range(3):
        joined = _joined_once(local, slope, label, spacing)
        if joined.max(initial=-1) == label.max(initial=-1):
            return joined
        label = joined
    return label


def _joined_once(local: Floats, slope: Floats, label: Indices, spacing: float) -> Indices:
    from scipy.spatial import cKDTree

    pieces = groups(label, int(label.max(initial=-1)) + 1)
    count = len(pieces)
    head, tail = np.empty((count, 3)), np.empty((count, 3))
    for k, own in enumerate(pieces):
        ordered = own[np.argsort(local[own, 1], kind="stable")]
        head[k], tail[k] = _end(local, slope, ordered[:8], first=True), _end(local, slope, ordered[-8:], first=False)
    # From each tail look ahead along the row for heads.
    scale = spacing * np.array([0.5, LONGEST_GAP / 2])
    ahead = tail[:, :2] + np.column_stack([tail[:, 2], np.ones(count)]) * (LONGEST_GAP / 2 * spacing)
    lists: list[list[int]] = list(cKDTree(head[:, :2] / scale).query_ball_point(ahead / scale, 1.0, p=np.inf))  # type: ignore[arg-type]
    a = np.repeat(np.arange(count), [len(x) for x in lists])
    b = np.array([x for found in lists for x in found], dtype=np.intp)
    gap = head[b, 1] - tail[a, 1]
    miss = np.abs(head[b, 0] - tail[a, 0] - gap * 0.5 * (tail[a, 2] + head[b, 2]))
    size = np.array([len(own) for own in pieces])
    small = np.minimum(size[a], size[b])
    # A long gap needs a piece on both sides: a single tree far out has nothing to say whose it is.
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
    """Across and along of a piece's end, its middle taken from the trees next to the end, and the slope there."""
    at = trees[0] if first else trees[-1]
    lean = float(slope[trees].mean())
    across = local[trees, 0] - (local[trees, 1] - local[at, 1]) * lean
    return float(across.mean()), float(local[at, 1]), lean


def split_double_rows(local: Floats, label: Indices, spacing: float) -> Indices:
    """Split rows that are two parallel ones close together: trees on both sides of a free strip along the whole row.

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
    """The tree spacing along pieces of rows; 0 where none has two trees."""
    return tree_spacing([np.sort(local[own, 1]) for own in groups(label, int(label.max(initial=-1)) + 1)])
