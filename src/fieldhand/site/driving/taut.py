"""The shortest way between two lines that do not cross: a string pulled taut."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.driving.graph import Indices
from fieldhand.site.driving.rowlines import Points

#: Directions this close together are one.
_SLACK = 1e-12

#: Spots closer together than this along the line are abreast.
_ABREAST = 1e-9


def taut(u: Points, low: Points, high: Points) -> Points:
    """The shortest line from the first to the last of these u that stays between ``low`` and ``high``.

    Args:
        u: Strictly increasing.
        low, high: Bounds of v at each u, straight between them, ``low <= high``; at the first and the last u both are
            where the line begins and ends.

    Returns:
        (u, v) of its points, shape (n, 2).

    From a point of the line the steepest and the flattest direction that pass all bounds so far are kept. Where they
    cross, the line bends at the bound that set the one that gave way.
    """
    at, v = 0, float(low[0])
    points = [(float(u[0]), v)]
    last = len(u) - 1
    while at < last:
        step = u[at + 1 :] - u[at]
        least = (low[at + 1 :] - v) / step
        most = (high[at + 1 :] - v) / step
        least_so_far, most_so_far = np.maximum.accumulate(least), np.minimum.accumulate(most)
        crossed = np.flatnonzero(least_so_far > most_so_far + _SLACK)
        if len(crossed) == 0:
            at, v = last, float(low[last])
        else:
            first = int(crossed[0])
            before = slice(0, first)
            if least[first] > most_so_far[first - 1]:  # it must climb, around the lowest of ``high``
                bend = int(np.flatnonzero(most[before] == most_so_far[first - 1])[-1])
                v = float(high[at + 1 + bend])
            else:
                bend = int(np.flatnonzero(least[before] == least_so_far[first - 1])[-1])
                v = float(low[at + 1 + bend])
            at += 1 + bend
        points.append((float(u[at]), v))
    return np.array(points)


def taut_lengths(u: Points, low: Points, high: Points, start: Points, ends: Points) -> Points:
    """Metres of the taut lines from one spot to each of many, shape (n,).

    Args:
        u, low, high: The bounds all along, as :func:`taut` takes them, but not at the spots.
        start: (u, v) of the one.
        ends: (u, v) of the others, shape (n, 2).

    The lines to all ends together are a tree of bends (a shortest-path tree: Guibas et al. 1987), so that what bounds
    the way on from a bend is computed once for all that turn there.
    """
    metres: Points = np.abs(ends[:, 1] - start[1])
    for sign in (1.0, -1.0):
        ahead = np.flatnonzero(sign * (ends[:, 0] - start[0]) >= _ABREAST)
        if len(ahead):
            step = 1 if sign > 0.0 else -1
            sides = sign * u[::step], low[::step], high[::step]
            metres[ahead] = _ahead(sides, start * (sign, 1.0), ends[ahead] * (sign, 1.0))
    return metres


def _ahead(sides: tuple[Points, Points, Points], start: Points, ends: Points) -> Points:
    """Metres to ends whose u is greater than that of the start."""
    u, low, high = sides
    metres = np.zeros(len(ends))
    open_ = [(float(start[0]), float(start[1]), 0.0, np.arange(len(ends)))]
    while open_:
        at, v, walked, which = open_.pop()
        first = int(np.searchsorted(u, at, "right"))
        passed = np.searchsorted(u, ends[which, 0], "left") - first
        inner = slice(first, first + int(passed.max()))
        least = np.maximum.accumulate((low[inner] - v) / (u[inner] - at))
        most = np.minimum.accumulate((high[inner] - v) / (u[inner] - at))
        bend, up = _bends(least, most, low[inner] - v, high[inner] - v, u[inner] - at, ends[which] - (at, v), passed)
        there = bend < 0
        metres[which[there]] = walked + np.hypot(*(ends[which[there]] - (at, v)).T)
        for k, over in {(k, over) for k, over in zip(bend.tolist(), up.tolist(), strict=True) if k >= 0}:
            at_v = float((high if over else low)[first + k])
            length = walked + float(np.hypot(u[first + k] - at, at_v - v))
            open_.append((float(u[first + k]), at_v, length, which[(bend == k) & (up == over)]))
    return metres


def _bends(
    least: Points, most: Points, low: Points, high: Points, step: Points, ends: Points, passed: Indices
) -> tuple[Indices, NDArray[np.bool_]]:
    """Where the taut line to each end bends first, counted along the sides (-1: nowhere), and whether at ``high``.

    Args:
        least, most: The steepest and the flattest direction that pass all bounds so far.
        low, high, step: The bounds and their u, as seen from where the line is.
        ends: (u, v) of each, as seen from there.
        passed: How many bounds the line to each end passes.
    """
    n = len(step)
    setting_least = np.maximum.accumulate(np.where(low / step == least, np.arange(n), -1))
    setting_most = np.maximum.accumulate(np.where(high / step == most, np.arange(n), -1))
    crossed = np.flatnonzero(least > most + _SLACK)
    c = int(crossed[0]) if len(crossed) else n
    slope = ends[:, 1] / ends[:, 0]
    before = np.maximum(np.minimum(passed, c) - 1, 0)
    bend, up = np.full(len(ends), -1, dtype=np.intp), np.zeros(len(ends), dtype=bool)
    if n == 0:
        return bend, up
    climbs = np.where(passed > c, (low / step)[min(c, n - 1)], slope) > most[before]
    stays = (passed == 0) | ((passed <= c) & (slope >= least[before] - _SLACK) & (slope <= most[before] + _SLACK))
    up = climbs & ~stays
    bend = np.where(stays, -1, np.where(climbs, setting_most[before], setting_least[before]))
    return bend, up
