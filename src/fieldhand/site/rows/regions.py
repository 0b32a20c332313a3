"""Regions of a site with a common row direction, and the trees of each region."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.point_index import PointIndex
from fieldhand.site.rows.labels import groups, linked
from fieldhand.site.rows.patches import Patches
from fieldhand.site.rows.tracing import spacing_along, turned

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Greatest relative difference between waves that count as equal.
_SAME_WAVE = 0.075
#: Ratio of row spacing to the spacing of the lines of trees across them, from which they cannot be confused.
CLEARLY_WIDER = 1.07
#: Up to this ratio, rows are as far apart as their trees.
_SQUARE = 1.025
#: Greatest sideways part of a step from tree to tree within a line, as a fraction of the spacing.
_SAME_LINE = 0.35
_NEARLY_SQUARE = 1.2
#: Number of neighbours that decide which region a tree belongs to, if several are possible.
_VOTERS = 16
#: Limits for merging a region into a larger one: angle between their rows in degrees, relative difference of their tree
#: spacings, and ratio of their numbers of trees.
_SAME_WAY, _SAME_SPACING, _PART = 3.0, 0.15, 0.34


@dataclass(frozen=True, eq=False, kw_only=True)
class Region:
    """Patches with a common wave.

    Attributes:
        seeds: Indices of the trees in the middle of its patches, shape (p,).
        waves: Wave vector of each patch across the rows, all pointing to the same side, shape (p, 2).
        wave: Mean of the waves.
        cross: Wave along the rows, if the trees of neighbouring rows are aligned; else nan.
        spacing_ratio: Row spacing divided by the spacing of the lines of trees across the rows; inf without such lines.
        power: Median power of the patches.
    """

    seeds: Indices
    waves: Floats
    wave: Floats
    cross: Floats
    spacing_ratio: float
    power: float

    @property
    def spacing(self) -> float:
        """Return the row spacing in metres."""
        return float(1.0 / np.hypot(*self.wave))

    def wave_at(self, xy: Floats, places: Floats) -> Floats:
        """Return the wave at each place, shape (n, 2): the mean for straight rows, else a mean of nearby patches."""
        turn = np.abs(np.sin(_angle(self.waves) - _angle(self.wave[None, :])))
        if len(self.seeds) < 5 or np.median(turn) < np.sin(np.radians(1.5)):
            return np.broadcast_to(self.wave, places.shape)
        distance, near = PointIndex(xy[self.seeds]).nearest_few(places, 5)
        weight = 1.0 / (distance**2 + np.median(distance) ** 2)
        return np.asarray(np.einsum("nk,nkx->nx", weight, self.waves[near]) / weight.sum(axis=1)[:, None])


def regions_of(xy: Floats, patches: Patches, clear: Floats) -> list[Region]:
    """Return regions of neighbouring patches that agree and have at least that power, the largest region first."""
    good = np.flatnonzero((patches.power >= clear) & np.isfinite(patches.wave[:, 0]))
    second = np.where((patches.second_power[good] >= 0.6 * clear[good])[:, None], patches.second[good], np.nan)
    return _agreeing(xy, patches.centre[good], patches.wave[good], second, patches.power[good])


def line_regions(xy: Floats, patches: Patches, clear: Floats) -> list[Region]:
    """Return regions of patches with less power whose trees lie on a line."""
    good = np.flatnonzero((patches.power < clear) & np.isfinite(patches.line[:, 0]))
    line = patches.line[good]
    line = line * (np.median(np.hypot(*line.T)) / np.hypot(*line.T))[:, None] if len(good) else line
    sure = np.full(len(good), 0.5)
    return _agreeing(xy, patches.centre[good], line, np.full_like(line, np.nan), sure)


def _agreeing(xy: Floats, centre: Indices, first: Floats, second: Floats, power: Floats) -> list[Region]:
    good = np.arange(len(centre))
    if not len(good):
        return []
    near = PointIndex(xy[centre]).nearest_few(xy[centre], 9)[1]
    i, j = np.repeat(np.arange(len(good)), near.shape[1]), near.ravel()
    # In a nearly square lattice the two waves may be swapped. A patch across a road may have one wave of each side, so
    # both waves must match, and have nearly the same length.
    swapped = _same(first[i], second[j]) & _same(second[i], first[j])
    ratio = np.hypot(*second.T) / np.hypot(*first.T)
    agree = _same(first[i], first[j]) | (swapped & (np.maximum(ratio[i], ratio[j]) < _NEARLY_SQUARE))
    label = linked(len(good), i[agree], j[agree])
    regions = [_region(centre[own], first[own], second[own], power[own]) for own in groups(label, int(label.max()) + 1)]
    return sorted(regions, key=lambda r: -len(r.seeds))


def _region(seeds: Indices, first: Floats, second: Floats, power: Floats) -> Region:
    """Return the region of patches, correcting those with swapped waves; rows are the lines of trees farther apart."""
    main = _similar_waves(first, second, first[int(np.argmax(power))])
    other_start = _cross_wave(first, second, main)
    if other_start is None:
        mean = _mean(main)
        return Region(
            seeds=seeds, waves=_filled(main, mean), wave=mean, cross=np.full(2, np.nan), spacing_ratio=float("inf"),
            power=float(np.median(power)),
        )  # fmt: skip
    other = _similar_waves(first, second, other_start)
    a, b = _mean(main), _mean(other)
    if np.hypot(*a) > np.hypot(*b):
        main, other, a, b = other, main, b, a
    return Region(
        seeds=seeds,
        waves=_filled(main, a),
        wave=a,
        cross=b,
        spacing_ratio=float(np.hypot(*b) / np.hypot(*a)),
        power=float(np.median(power)),
    )


def _similar_waves(first: Floats, second: Floats, start: Floats) -> Floats:
    """Return for each patch the wave similar to the starting one; nan if there is none."""
    found = np.full(first.shape, np.nan)
    reference = start
    for tolerance in (_SAME_WAVE, 2 * _SAME_WAVE):
        for wave in (second, first):
            towards = _towards(wave, reference)
            like = np.hypot(*(towards - reference).T) < tolerance * np.hypot(*reference)
            found[like] = towards[like]
        reference = np.nanmean(found, axis=0)
    # Rows that curve further: accept waves of about the same length.
    left = np.isnan(found[:, 0])
    towards = _towards(first, reference)
    like = left & (np.abs(np.hypot(*towards.T) / np.hypot(*reference) - 1) < _SAME_WAVE)
    like &= np.hypot(*(towards - reference).T) < 0.6 * np.hypot(*reference)
    found[like] = towards[like]
    return found


def _cross_wave(first: Floats, second: Floats, main: Floats) -> Floats | None:
    """Return the median of the waves that cross the main one; None if there are too few."""
    mean = _mean(main)
    waves = np.vstack([first, second])
    waves = waves[np.isfinite(waves[:, 0])]
    turn = np.abs(np.sin(_angle(waves) - _angle(mean[None, :])))
    others = waves[turn > np.sin(np.radians(25.0))]
    if len(others) < max(0.3 * len(main), 1):
        return None
    length = np.hypot(*others.T)
    return np.asarray(others[int(np.argsort(length)[len(length) // 2])])


def _mean(waves: Floats) -> Floats:
    there = waves[np.isfinite(waves[:, 0])]
    middle = np.median(there, axis=0)
    close = np.hypot(*(there - middle).T) <= max(_SAME_WAVE * float(np.hypot(*middle)), 1e-12)
    return np.asarray(there[close].mean(axis=0) if close.any() else middle)


def _filled(waves: Floats, mean: Floats) -> Floats:
    return np.where(np.isnan(waves), mean, waves)


def _towards(wave: Floats, reference: Floats) -> Floats:
    return np.where((wave @ reference < 0)[:, None], -wave, wave)


def _same(a: Floats, b: Floats) -> NDArray[np.bool_]:
    """Return a mask of the waves that are equal up to their sign."""
    size = np.minimum(np.hypot(*a.T), np.hypot(*b.T))
    apart = np.minimum(np.hypot(*(a - b).T), np.hypot(*(a + b).T))
    return np.asarray(apart < _SAME_WAVE * size)  # false for nan


def _angle(waves: Floats) -> Floats:
    return np.arctan2(waves[:, 1], waves[:, 0])


def row_direction(xy: Floats, trees: Indices, region: Region) -> tuple[Region, float]:
    """Return the region with its rows in the most likely direction, if rows are as far apart as their trees.

    That is the direction of the steps from tree to tree in file order, else the direction of the longer lines of trees.

    Returns:
        The region, and the fraction of the steps in file order along its rows among those along or across; 0.5 if there
        are few such steps.
    """
    if not np.isfinite(region.cross[0]):
        return region, 0.5
    next_to = np.flatnonzero(np.diff(trees) == 1)
    step = xy[trees[next_to + 1]] - xy[trees[next_to]]
    across, along = np.abs(step @ region.wave), np.abs(step @ region.cross)
    down = int(((across < _SAME_LINE) & (along > 1 - _SAME_LINE) & (along < 2 + _SAME_LINE)).sum())
    over = int(((along < _SAME_LINE) & (across > 1 - _SAME_LINE) & (across < 2 + _SAME_LINE)).sum())
    file_order_share = (down + 2) / (down + over + 4)
    if down + over < max(8, 0.2 * len(next_to)):
        file_order_share = 0.5
    if region.spacing_ratio >= CLEARLY_WIDER:
        return region, file_order_share
    off = xy[trees] - xy[trees].mean(axis=0)
    wide, long = np.ptp(off @ region.wave), np.ptp(off @ region.cross)
    if file_order_share < 0.35 or (file_order_share < 0.65 and region.spacing_ratio < _SQUARE and long < 0.9 * wide):
        return _swapped(region), 1.0 - file_order_share
    return region, file_order_share


def _swapped(region: Region) -> Region:
    return replace(
        region,
        waves=np.broadcast_to(region.cross, region.waves.shape).copy(),
        wave=region.cross,
        cross=region.wave,
        spacing_ratio=1.0 / region.spacing_ratio,
    )


def assign_trees(xy: Floats, trees: Indices, regions: list[Region]) -> Indices:
    """Return the region of each tree, shape (n,).

    It is the region of the nearest seeds; if these differ, the one whose waves fit the surrounding trees best.
    """
    points = xy[trees]
    seeds = np.concatenate([r.seeds for r in regions])
    owner = np.repeat(np.arange(len(regions)), [len(r.seeds) for r in regions])
    candidates = owner[PointIndex(xy[seeds]).nearest_few(points, 6)[1]]
    chosen = candidates[:, 0].copy()
    contested = np.flatnonzero((candidates != candidates[:, :1]).any(axis=1))
    if not len(contested):
        return np.asarray(chosen)
    size = min(_VOTERS, len(points))
    distance, around = PointIndex(points).nearest_few(points[contested], size)
    weight = 1.0 / (1.0 + (distance / np.maximum(distance[:, size // 2, None], 1e-9)) ** 2)
    scores = np.full((len(contested), len(regions)), -1.0)
    for k_, region in enumerate(regions):
        asked = np.flatnonzero((candidates[contested] == k_).any(axis=1))
        if len(asked):
            offsets = points[around[asked]] - points[contested[asked]][:, None, :]
            scores[asked, k_] = _in_step(offsets, weight[asked], region, xy, points[contested[asked]])
    chosen[contested] = np.argmax(scores, axis=1)
    # A tree surrounded by trees of another region belongs to it.
    votes = np.stack([(chosen[around[:, :9]] == k_).sum(axis=1) for k_ in range(len(regions))], axis=1)
    chosen[contested] = np.argmax(votes + 2.0 * scores, axis=1)
    return np.asarray(chosen)


def merge_small_regions(points: Floats, owner: Indices, regions: list[Region]) -> Indices:
    """Return the region of each tree after merging small regions into larger ones beside them.

    Patches across a road have the row direction of both sides, but the width of the road as row spacing.
    """
    count = np.bincount(owner, minlength=len(regions))
    order = [k for k in np.argsort(count, kind="stable").tolist() if count[k]]
    if len(order) < 2:
        return owner
    owner = owner.copy()
    index = PointIndex(points)
    for k in order[:-1]:
        own = np.flatnonzero(owner == k)
        if len(own) > _PART * count.max():
            break
        near = owner[index.nearest_few(points[own], 12)[1]]
        beside = np.bincount(near[near != k], minlength=len(regions))
        into = int(np.argmax(beside))
        if not beside[into] or len(own) > _PART * (owner == into).sum():
            continue
        one, other = regions[k].wave, regions[into].wave
        turn = abs(float(np.sin(_angle(one[None, :]) - _angle(other[None, :]))[0]))
        if turn > np.sin(np.radians(_SAME_WAY)):
            continue
        spacings = [spacing_along(turned(points[owner == r], other), regions[into].spacing) for r in (k, into)]
        if abs(spacings[0] / spacings[1] - 1.0) < _SAME_SPACING:
            owner[own] = into
    return owner


def _in_step(offsets: Floats, weight: Floats, region: Region, xy: Floats, places: Floats) -> Floats:
    total = weight.sum(axis=1)
    waves = [region.wave_at(xy, places)]
    if np.isfinite(region.cross[0]):
        waves.append(np.broadcast_to(region.cross, places.shape))
    found = []
    for wave in waves:
        phase = 2 * np.pi * np.einsum("nkx,nx->nk", offsets, wave)
        found.append(((np.cos(phase) * weight).sum(axis=1) ** 2 + (np.sin(phase) * weight).sum(axis=1) ** 2) / total**2)
    return np.asarray(np.mean(found, axis=0))
