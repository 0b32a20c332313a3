"""Lines along rows that no path crosses, and the pairs of points that they separate."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.driving.graph import Indices, Points

#: Metres by which each end of a line is shortened, so that paths along the end of an obstacle do not touch it.
_ENDS_M = 1e-3

#: Number of nearest rows examined for each point.
_NEAREST = 8

#: Number of cells along the longer side of the raster of rows.
_CELLS = 64

#: Rows at these fractions of the line between two points are examined.
_SHARES = (0.5, 0.25, 0.75)

#: Pairs of points processed together, which bounds the memory.
_BATCH = 100_000

#: Points as complex numbers: one product rotates a point into the frame of a line.
Complex = NDArray[np.complex128]

#: A function from indices of shapes (n, 1) and (m,) to a mask of the pairs to consider, shape (n, m).
Among = Callable[[Indices, Indices], NDArray[np.bool_]]


@dataclass(frozen=True, eq=False)
class Located:
    """Points, shape (n,), and the indices of the rows nearest to each, nearest first, shape (n, k)."""

    at: Complex
    near: Indices


class RowAxes:
    """Lines through obstacles, from end to end, that no path crosses.

    Among rows, one of the nearest rows separates most pairs of points, which is much cheaper to test than whether the
    line between them lies on the ground.

    Args:
        ends: End points of each line in metres, shape (m, 2, 2).
    """

    def __init__(self, ends: Points) -> None:
        start, end = _complex(ends[:, 0]), _complex(ends[:, 1])
        length = np.abs(end - start)
        along = (end - start) / length
        self._start = start + _ENDS_M * along
        self._turn = along.conj()
        self._length = length - 2.0 * _ENDS_M
        self._raster = _Raster(start, end) if len(ends) else None

    def locate(self, at: Points) -> Located:
        """Return the points with the rows nearest to each."""
        count = min(_NEAREST, len(self._length))
        places = _complex(at)
        nearest = np.empty((len(at), count), dtype=np.intp)
        if not count:
            return Located(places, nearest)
        step = max(_BATCH // len(self._length), 1)
        for first in range(0, len(at), step):
            some = slice(first, first + step)
            seen = (places[some, None] - self._start) * self._turn
            away = seen.imag**2 + (seen.real - np.clip(seen.real, 0.0, self._length)) ** 2
            near = np.argpartition(away, count - 1, axis=1)[:, :count]
            order = np.argsort(np.take_along_axis(away, near, axis=1), axis=1, kind="stable")
            nearest[some] = np.take_along_axis(near, order, axis=1)
        return Located(places, nearest)

    def unseparated_pairs(
        self, one: Located, two: Located | None = None, among: Among | None = None
    ) -> Iterator[tuple[Indices, Indices]]:
        """Yield the indices of all pairs of points that no row nearest to them, or near a few points between them,
        separates, in ordered batches.

        Pairs consist of a point of ``one`` and a point of ``two``; without ``two`` of two points of ``one``, each once.
        """
        to = one if two is None else two
        step = max(_BATCH // max(len(to.at), 1), 1)
        for first in range(0, len(one.at), step):
            some = np.arange(first, min(first + step, len(one.at)))
            there = np.arange(first if two is None else 0, len(to.at))
            kept = some[:, None] < there if two is None else np.ones((len(some), len(there)), dtype=bool)
            if among is not None:
                kept &= among(some[:, None], there)
            else:  # the rows on either side of ``one`` separate most pairs
                for axes in one.near[some].T[:2]:
                    kept &= ~self._separates(axes[:, None], one.at[some, None], to.at[there])
            i, j = np.nonzero(kept)
            i, j = some[i], there[j]
            for ranks in (slice(0, 2), slice(2, None)):  # after the two nearest rows few pairs remain
                for points, which in ((one, 0), (to, 1)):
                    near = points.near[(i, j)[which], ranks].T
                    clear = ~self._separates(near, one.at[i], to.at[j]).any(axis=0)
                    i, j = i[clear], j[clear]
            if self._raster is not None:  # whole blocks may be between the points
                for share in _SHARES:
                    axes = self._raster.at(one.at[i] + share * (to.at[j] - one.at[i]))
                    clear = (axes < 0) | ~self._separates(axes, one.at[i], to.at[j])
                    i, j = i[clear], j[clear]
            yield i, j

    def _separates(self, axes: Indices, one: Complex, two: Complex) -> NDArray[np.bool_]:
        """Return a mask of the rows that separate a point of ``one`` from a point of ``two``; arguments broadcast."""
        start, turn = self._start[axes], self._turn[axes]
        one, two = (one - start) * turn, (two - start) * turn
        far_one, far_two = np.abs(one.imag), np.abs(two.imag)
        # Coordinate along the row of the crossing, times the sum of both distances from the row.
        crossing = one.real * far_two + two.real * far_one
        between = (crossing > 0.0) & (crossing < self._length[axes] * (far_one + far_two))
        return np.asarray(between & ((one.imag > 0.0) != (two.imag > 0.0)))


class _Raster:
    """Square cells that cover all rows, with one of the rows that pass through each.

    Args:
        start, end: End points of each row, shape (m,), at least one.
    """

    def __init__(self, start: Complex, end: Complex) -> None:
        ends = np.concatenate([start, end])
        self._corner = complex(ends.real.min(), ends.imag.min())
        self._side = max(float(np.ptp(ends.real)), float(np.ptp(ends.imag))) / _CELLS
        self._rows = np.full((_CELLS + 3, _CELLS + 3), -1, dtype=np.intp)
        along = start[:, None] + (end - start)[:, None] * np.linspace(0.0, 1.0, 2 * _CELLS)
        self._rows[self._cells(along)] = np.arange(len(start))[:, None]

    def at(self, points: Complex) -> Indices:
        """Return a row near each of the points; -1 if none passes through its cell."""
        return self._rows[self._cells(points)]

    def _cells(self, points: Complex) -> tuple[Indices, Indices]:
        """Return the indices of the cells of points, which have a margin of empty ones around them."""
        seen = (points - self._corner) / self._side + (1.0 + 1.0j)
        return _clipped(seen.real), _clipped(seen.imag)


def _clipped(cells: Points) -> Indices:
    return np.clip(cells, 0.0, _CELLS + 2.0).astype(np.intp)


def _complex(at: Points) -> Complex:
    return np.asarray(at[..., 0] + 1j * at[..., 1])
