"""Estimate the direction of rows in small patches of trees from their spatial spectrum.

Trees in rows a distance d apart are in phase with a wave of that length across the rows. The power of the wave,
``|sum exp(2 pi i k.x)|^2 / n`` with k pointing across the rows and 1/d long, is about 1 for scattered trees and about n
for rows, even with missing trees; displaced trees only weaken it. Of the waves that fit a lattice of trees, the longest
one is across the lines of trees that are farthest apart: the rows.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.point_index import PointIndex

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Number of trees in a patch, about seven by seven; and in a patch of small blocks.
PATCH, SMALL_PATCH = 44, 14
#: Test of a single line of trees: number of trees; greatest spread in nearest-neighbour distances; and the wave length
#: that represents the line.
ON_LINE, _BESIDE_LINE, _LINE_WAVE = 9, 0.36, 3.0
#: Greatest number of patches; larger sites are sampled.
MOST_PATCHES = 128
#: Smaller patch sizes, tried if the power of the whole patch is below this value.
_FEWER, _IN_STEP = (26, 15), 0.75
_ANGLES = np.radians(np.arange(0.0, 180.0, 3.0))
#: Wave lengths in units of the median nearest-neighbour distance, which displaced trees shorten.
_LENGTHS = np.geomspace(0.8, 5.2, 34)
#: Fraction of the strongest wave's contrast that a longer wave needs to be preferred.
_LONGER = 0.55


@dataclass(frozen=True, eq=False, kw_only=True)
class Patches:
    """Waves that fit patches of trees.

    Attributes:
        centre: Index of the tree in the middle of each patch, shape (p,).
        members: Indices of its trees by distance, shape (p, k).
        wave: Wave vector across the rows, 1/d long, per metre, shape (p, 2); nan if there is none.
        second: Strongest wave that is not parallel to it; nan if there is none.
        power: Power of the first wave as a fraction of the greatest possible value, 0 to 1.
        second_power: Power of the second wave.
        count: Number of trees, nearest to the middle, that the waves were computed from. Shape (p,).
        line: Wave vector across the line of the nearest trees if they lie on one; else nan. Shape (p, 2).
    """

    centre: Indices
    members: Indices
    wave: Floats
    second: Floats
    power: Floats
    second_power: Floats
    line: Floats
    count: Indices


def patches_of(xy: Floats, trees: Indices, most: int = PATCH) -> Patches:
    """Return patches of at most so many trees, spread over at least two trees, containing only these trees."""
    points = xy[trees]
    index = PointIndex(points)
    size = min(most, len(points))
    middle = _spread(points, MOST_PATCHES)
    near = index.nearest_few(points[middle], size)[1]
    apart = index.nearest_few(points[near.ravel()], 2)[0][:, 1].reshape(near.shape)
    unit = np.maximum(np.median(apart, axis=1), 1e-6)
    offsets = (points[near] - points[middle][:, None, :]) / unit[:, None, None]
    first, second, power, second_power, count = _clearest(offsets)
    line = _lines(offsets[:, :ON_LINE])
    # Trees on one line fit many waves along it, which do not indicate rows across it.
    turn = np.abs(first[:, 0] * line[:, 1] - first[:, 1] * line[:, 0])
    along = turn > np.sin(np.radians(25.0)) * np.hypot(*first.T) * np.hypot(*line.T)
    power = np.where(along, 0.0, power)
    return Patches(
        centre=trees[middle],
        members=trees[near],
        wave=first / unit[:, None],
        second=second / unit[:, None],
        power=power,
        second_power=second_power,
        count=count,
        line=line / unit[:, None],
    )


def _lines(offsets: Floats) -> Floats:
    """Return a wave vector across the line of the trees of each patch; nan if they are not on a line."""
    off = offsets - offsets.mean(axis=1, keepdims=True)
    size = offsets.shape[1]
    values, vectors = np.linalg.eigh(np.einsum("pkx,pky->pxy", off, off) / max(size - 2, 1))
    straight = np.sqrt(np.maximum(values[:, 0], 0.0)) < _BESIDE_LINE
    return np.where(straight[:, None], vectors[:, :, 0] / _LINE_WAVE, np.nan)


def _spread(points: Floats, most: int) -> Indices:
    """Return the indices of about ``most`` evenly spread points: the most central point of each cell of a grid."""
    n = len(points)
    if n <= most:
        return np.arange(n)
    low, extent = points.min(axis=0), np.maximum(np.ptp(points, axis=0), 1e-9)
    side = float(np.sqrt(extent.prod() / most))
    side = max(side, float(extent.max()) / most)
    for _ in range(12):
        cell = np.floor((points - low) / side).astype(np.int64)
        key = cell[:, 0] * (int(cell[:, 1].max()) + 1) + cell[:, 1]
        if len(np.unique(key)) >= 0.75 * most:
            break
        side *= 0.85
    off = np.hypot(*((points - low) / side - cell - 0.5).T)
    order = np.lexsort((off, key))
    first = np.concatenate([[True], np.diff(key[order]) != 0])
    return np.asarray(order[first])


def power_at(offsets: Floats, wave: Floats) -> Floats:
    """Return the power of waves (p, w, 2) in patches of offsets (p, k, 2), 0 to 1. Shape (p, w)."""
    phase = (2 * np.pi * np.einsum("pkx,pwx->pwk", offsets, wave)).astype(np.float32)
    return np.asarray((np.cos(phase).mean(axis=2) ** 2 + np.sin(phase).mean(axis=2) ** 2).astype(np.float64))


def _clearest(offsets: Floats) -> tuple[Floats, Floats, Floats, Floats, Indices]:
    """Return the waves of the patches, from fewer trees if the whole patch does not fit, as at a block's edge."""
    size = offsets.shape[1]
    first, second, power, second_power = _waves(offsets)
    count = np.full(len(offsets), size, dtype=np.intp)
    for fewer in _FEWER:
        unclear = np.flatnonzero(power < _IN_STEP)
        if fewer >= size or not len(unclear):
            continue
        f, s, p, q = _waves(offsets[unclear, :fewer])
        better = p**2 * fewer > power[unclear] ** 2 * count[unclear]
        at = unclear[better]
        first[at], second[at], power[at], second_power[at], count[at] = (
            f[better],
            s[better],
            p[better],
            q[better],
            fewer,
        )
    return first, second, power, second_power, count


def _waves(offsets: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    count = len(offsets)
    angle, length = np.meshgrid(_ANGLES, _LENGTHS, indexing="ij")
    grid = np.stack([np.cos(angle) / length, -np.sin(angle) / length], axis=-1)
    flat = grid.reshape(-1, 2)
    shape = (count, *angle.shape)
    power, half = (p.reshape(shape) for p in _on_grid(offsets, flat))
    contrast = np.where(_is_peak(power), power - half, -1.0)
    first = _longest(contrast, length)
    first_wave = _refine(offsets, flat[first])
    along = np.abs(np.sin(angle.ravel()[None, :] - angle.ravel()[first][:, None]))
    others = np.where((along > np.sin(np.radians(25.0))).reshape(shape), contrast, -1.0)
    second = _longest(others, length)
    second_wave = _refine(offsets, flat[second])
    p1 = power_at(offsets, first_wave[:, None, :])[:, 0]
    p2 = power_at(offsets, second_wave[:, None, :])[:, 0]
    none1 = contrast.reshape(count, -1).max(axis=1) <= 0
    none2 = others.reshape(count, -1).max(axis=1) <= 0
    first_wave[none1], second_wave[none1 | none2] = np.nan, np.nan
    return first_wave, second_wave, np.where(none1, 0.0, p1), np.where(none1 | none2, 0.0, p2)


def _on_grid(offsets: Floats, waves: Floats) -> tuple[Floats, Floats]:
    """Return the power of the waves, and of waves twice as long, in each patch. Shape (p, w)."""
    across = (np.pi * waves.T).astype(np.float32)
    whole, half = np.empty((len(offsets), len(waves))), np.empty((len(offsets), len(waves)))
    # One patch at a time fits in the processor's cache, which is ten times faster than all at once.
    for k, patch in enumerate(offsets.astype(np.float32)):
        phase = patch @ across
        c, s = np.cos(phase), np.sin(phase)
        half[k] = c.mean(axis=0) ** 2 + s.mean(axis=0) ** 2
        # Double-angle formulas are cheaper than further cosines.
        s *= c
        c *= c
        whole[k] = (2 * c.mean(axis=0) - 1) ** 2 + (2 * s.mean(axis=0)) ** 2
    return whole, half


def _is_peak(power: Floats) -> NDArray[np.bool_]:
    """Return a mask of the local maxima on the grid of angle (which is periodic) and length."""
    best = np.ones(power.shape, dtype=bool)
    for turn in (-1, 0, 1):
        rolled = np.roll(power, turn, axis=1)
        for step in (-1, 0, 1):
            if turn or step:
                moved = np.full_like(rolled, -np.inf)
                if step > 0:
                    moved[:, :, 1:] = rolled[:, :, :-1]
                elif step < 0:
                    moved[:, :, :-1] = rolled[:, :, 1:]
                else:
                    moved = rolled
                best &= power >= moved
    best[:, :, -1] = False
    return best


def _longest(contrast: Floats, length: Floats) -> Indices:
    """Return the index of the longest wave among those with nearly the best contrast."""
    flat = contrast.reshape(len(contrast), -1)
    good = flat >= np.maximum(_LONGER * flat.max(axis=1), 1e-9)[:, None]
    return np.asarray(np.argmax(np.where(good, length.ravel()[None, :] + 0.01 * flat, -1.0), axis=1))


def _refine(offsets: Floats, wave: Floats) -> Floats:
    """Refine waves to the local maximum of their power by decreasing steps."""
    best = wave.copy()
    step = 0.035
    around = np.array([(a, b) for a in (-1.0, 0.0, 1.0) for b in (-1.0, 0.0, 1.0)])
    for _ in range(7):
        across = np.column_stack([-best[:, 1], best[:, 0]])
        tried = best[:, None, :] * (1 + step * around[None, :, :1]) + across[:, None, :] * (step * around[None, :, 1:])
        which = np.argmax(power_at(offsets, tried), axis=1)
        best = tried[np.arange(len(best)), which]
        step *= 0.65
    return best
