"""Parts of a path that comes back to where it ends.

Nav2's goal checkers compare the position of the robot with the end of its path alone, so that they end a path once
round an area where it begins. Such a path is followed in parts, none of which comes near its own end before it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import accumulate, pairwise

import numpy as np

from fieldhand.execution.drivers.ros2.map_frame import Point

#: Multiple of the distance that counts as near; the last metres of a path are near its end anyway.
_TAIL = 3.0


def parts(path: Sequence[Point], near_m: float) -> list[tuple[int, int]]:
    """Return the parts of a path as first and last corner of each, in order; one for a path that never comes back.

    Args:
        path: Corners in metres, at least two.
        near_m: Distance from its end at which a robot may count as there.
    """
    found, ahead = list[tuple[int, int]](), [(0, len(path) - 1)]
    while ahead:
        first, last = ahead.pop()
        if last - first < 2 or not _comes_back(path[first : last + 1], near_m):
            found.append((first, last))
            continue
        middle = _middle(path, first, last)
        ahead += [(middle, last), (first, middle)]
    return found


def _comes_back(path: Sequence[Point], near_m: float) -> bool:
    """Return True if a path is near its end before its last metres."""
    corners = np.array(path, dtype=float)
    lengths = np.hypot(*np.diff(corners, axis=0).T)
    left = lengths[::-1].cumsum()[::-1] - lengths  # metres from the end of each leg
    early = left >= _TAIL * near_m
    begins, ways, end = corners[:-1][early], np.diff(corners, axis=0)[early], corners[-1]
    squares = np.maximum((ways**2).sum(axis=1), 1e-12)
    share = np.clip(((end - begins) * ways).sum(axis=1) / squares, 0.0, 1.0)
    away = np.hypot(*(begins + share[:, None] * ways - end).T)
    return bool((away <= near_m).any())


def _middle(path: Sequence[Point], first: int, last: int) -> int:
    """Return the inner corner of a part that is nearest to the middle of its length."""
    driven = list(accumulate((math.dist(a, b) for a, b in pairwise(path[first : last + 1])), initial=0.0))
    return min(range(first + 1, last), key=lambda corner: abs(driven[corner - first] - driven[-1] / 2.0))
