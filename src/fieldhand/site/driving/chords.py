"""Which of very many straight lines run right through something, seen without looking at its shape."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from fieldhand.site.driving.graph import Indices, Points

#: Chords that are looked at, and the shortest that is worth it.
_MOST = 64
_SHORT_M = 1.0

#: Of either end of a chord this much is left out: what only touches a hole does not cross it.
_ENDS_M = 1e-3

#: Pairs that are looked at together: few enough for the processor's cache.
_BATCH = 50_000


class Chords:
    """The longest straight lines along and across the holes of a ground: what crosses one leaves the ground.

    Among rows most lines between two points do, and that is many times cheaper to see than whether they lie on the
    ground.

    Args:
        ground: With holes; a ground may have none.
    """

    def __init__(self, ground: BaseGeometry) -> None:
        lines = [
            line
            for part in getattr(ground, "geoms", [ground])
            if isinstance(part, Polygon)
            for ring in part.interiors
            for line in _along_and_across(Polygon(ring))
        ]
        ends = shapely.get_coordinates(sorted(lines, key=lambda line: -line.length)[:_MOST]).reshape(-1, 2, 2)
        self._start, way = ends[:, 0], ends[:, 1] - ends[:, 0]
        self._length = np.hypot(*way.T)
        self._along = way / self._length[:, None]

    def pairs(self, one: Points, two: Points | None = None) -> Iterator[tuple[Indices, Indices]]:
        """Positions of a point of ``one`` and a point of ``two``, in batches: all pairs that no chord parts.

        Args:
            one: Shape (n, 2).
            two: Shape (m, 2); none for pairs within ``one``, each once.
        """
        off, along = self._seen_from(one)
        off_two, along_two = (off, along) if two is None else self._seen_from(two)
        first, count = 0, len(one if two is None else two)
        while first < len(one):
            start = first + 1 if two is None else 0  # the pairs with those before have been looked at
            last = min(first + max(_BATCH // max(count - start, 1), 1), len(one))
            parted = self._parted(off[:, first:last], along[:, first:last], off_two[:, start:], along_two[:, start:])
            i, j = np.nonzero(~parted)
            i, j = i + first, j + start
            yield (i, j) if two is not None else (i[i < j], j[i < j])
            first = last

    def _seen_from(self, at: Points) -> tuple[Points, Points]:
        """Metres of each point to the left of each chord's line, and along it from its start; shape (chords, n)."""
        x, y = (at[None, :, k] - self._start[:, None, k] for k in (0, 1))
        ex, ey = self._along[:, 0, None], self._along[:, 1, None]
        return ex * y - ey * x, ex * x + ey * y

    def _parted(self, off: Points, along: Points, off_two: Points, along_two: Points) -> NDArray[np.bool_]:
        parted = np.zeros((off.shape[1], off_two.shape[1]), dtype=bool)
        for a, u, b, v, length in zip(off, along, off_two, along_two, self._length.tolist(), strict=True):
            far_a, far_b = np.abs(a)[:, None], np.abs(b)
            # Where the line meets the chord's line, times the sum of both distances from it.
            crossing = u[:, None] * far_b + v * far_a
            parted |= ((a > 0.0)[:, None] != (b > 0.0)) & (crossing > 0.0) & (crossing < length * (far_a + far_b))
        return parted


def _along_and_across(hole: Polygon) -> list[LineString]:
    corners = shapely.get_coordinates(shapely.oriented_envelope(hole))[:4]
    if len(corners) < 4:
        return []
    (a, b, c, d) = (corners + np.roll(corners, -1, axis=0)) / 2.0
    inside = shapely.intersection(shapely.linestrings([[a, c], [b, d]]), hole)
    return [_without_ends(line) for line in shapely.get_parts(inside) if line.length > _SHORT_M]


def _without_ends(line: LineString) -> LineString:
    return LineString([line.interpolate(_ENDS_M), line.interpolate(-_ENDS_M)])
