"""The shortest way between two lines that do not cross: a string pulled taut."""

from __future__ import annotations

import numpy as np

from fieldhand.site.driving.rowlines import Points


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
        crossed = np.flatnonzero(least_so_far > most_so_far + 1e-12)
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
