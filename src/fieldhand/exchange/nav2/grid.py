"""Grids of square cells in a map frame, and the cells that lines touch and polygons cover."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from fieldhand.errors import InputError
from fieldhand.language import message
from fieldhand.language.words import say_number

Cells = NDArray[np.bool_]
Points = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Largest number of cells of a grid: 400 m by 400 m in cells of 5 cm.
MOST_CELLS = 64_000_000

#: Tolerance in cells: a line that touches the edge of a cell touches the cell.
_TOUCH = 1e-6

#: Rows that are filled at a time.
_BAND = 512


@dataclass(frozen=True, kw_only=True)
class MapGrid:
    """A grid whose axes are those of the map frame.

    Arrays of its cells have the shape (rows, columns); the first row has the least y, as in ``nav_msgs/OccupancyGrid``.

    Attributes:
        left, bottom: Position of its corner of least x and y in metres, a multiple of the resolution.
        resolution_m: Length of the side of a cell in metres.
        columns, rows: Number of cells along x and y.
    """

    left: float
    bottom: float
    resolution_m: float
    columns: int
    rows: int

    @staticmethod
    def around(bounds: tuple[float, float, float, float], resolution_m: float) -> MapGrid:
        """Return the smallest grid that contains bounds (least x, least y, greatest x, greatest y) in metres.

        Raises:
            InputError: It would have too many cells.
        """
        first_column, first_row = (math.floor(low / resolution_m) for low in bounds[:2])
        columns = math.ceil(bounds[2] / resolution_m) - first_column
        rows = math.ceil(bounds[3] / resolution_m) - first_row
        if columns * rows > MOST_CELLS:
            width_m, height_m = bounds[2] - bounds[0], bounds[3] - bounds[1]
            least_m = math.ceil(100.0 * math.sqrt(width_m * height_m / MOST_CELLS) + 1.0) / 100.0
            raise InputError(
                message(
                    "a map of {width} m by {height} m in cells of {resolution} m is too large: at most {most} cells",
                    width=say_number(round(width_m)),
                    height=say_number(round(height_m)),
                    resolution=say_number(resolution_m, 3),
                    most=say_number(MOST_CELLS),
                ),
                where="--resolution",
                advice=message("give {least} or more", least=say_number(least_m, 2)),
            )
        return MapGrid(
            left=round(first_column * resolution_m, 6),
            bottom=round(first_row * resolution_m, 6),
            resolution_m=resolution_m,
            columns=columns,
            rows=rows,
        )

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Return its least x and y and its greatest x and y in metres."""
        side = self.resolution_m
        return (self.left, self.bottom, self.left + self.columns * side, self.bottom + self.rows * side)

    def none(self) -> Cells:
        """Return an array without any cell."""
        return np.zeros((self.rows, self.columns), dtype=np.bool_)

    def touched(self, shape: BaseGeometry) -> Cells:
        """Return the cells that points, lines, and the edges of polygons touch."""
        found = self.none()
        for one, two in self._segments(shape):
            self._mark(found, one, two)
        return found

    def covered(self, shape: BaseGeometry) -> Cells:
        """Return the cells that polygons cover or touch."""
        return self.touched(shape) | self.with_centre_in(shape)

    def with_centre_in(self, shape: BaseGeometry) -> Cells:
        """Return the cells whose centres lie in valid polygons, by the parity of the edges to their left."""
        found = self.none()
        areas = [part for part in shapely.get_parts(shape) if shapely.get_dimensions(part) == 2]
        for one, two in self._segments(shapely.geometrycollections(areas)):
            steep = one[:, 1] != two[:, 1]
            one, two = one[steep], two[steep]
            swap = one[:, 1] > two[:, 1]
            low, high = np.where(swap[:, None], two, one), np.where(swap[:, None], one, two)
            # A centre belongs to the edge whose lower end is at most as high, so a shared corner counts once.
            first = np.clip(np.ceil(low[:, 1] - 0.5), 0, self.rows).astype(np.intp)
            last = np.clip(np.ceil(high[:, 1] - 0.5), 0, self.rows).astype(np.intp)
            edge, row = _ranges(first, last)
            slope = (high[edge, 0] - low[edge, 0]) / (high[edge, 1] - low[edge, 1])
            x = low[edge, 0] + (row + 0.5 - low[edge, 1]) * slope
            column = np.clip(np.ceil(x - 0.5), 0, self.columns).astype(np.intp)
            self._toggle(found, row, column)
        return found

    def _toggle(self, found: Cells, row: Indices, column: Indices) -> None:
        """Invert in each of the rows all cells from a column on."""
        order = np.argsort(row, kind="stable")
        row, column = row[order], column[order]
        for begin in range(0, self.rows, _BAND):
            end = min(begin + _BAND, self.rows)
            a, b = np.searchsorted(row, [begin, end])
            if a == b:
                continue
            crossings = np.zeros((end - begin, self.columns + 1), dtype=np.uint8)
            np.add.at(crossings, (row[a:b] - begin, column[a:b]), 1)
            inside = (np.cumsum(crossings, axis=1, dtype=np.uint8) & 1).astype(np.bool_)
            found[begin:end] ^= inside[:, :-1]

    def _segments(self, shape: BaseGeometry) -> Iterator[tuple[Points, Points]]:
        """Yield the segments of each part of a shape in cells from the corner of the grid; a point is one of length 0.

        Parts off the grid are left out.
        """
        west, south, east, north = self.bounds
        for part in shapely.get_parts(shape):
            if part.is_empty:
                continue
            lines = shapely.get_rings(part) if shapely.get_dimensions(part) == 2 else [part]
            least_x, least_y, most_x, most_y = part.bounds
            if least_x > east or least_y > north or most_x < west or most_y < south:
                continue
            ends = [(shapely.get_coordinates(line) - (self.left, self.bottom)) / self.resolution_m for line in lines]
            one = [at[:-1] if len(at) > 1 else at for at in ends]
            two = [at[1:] if len(at) > 1 else at for at in ends]
            yield np.concatenate(one), np.concatenate(two)

    def _mark(self, found: Cells, one: Points, two: Points) -> None:
        """Mark the cells that segments touch: in each column those between the heights at its two edges."""
        swap = one[:, 0] > two[:, 0]
        left, right = np.where(swap[:, None], two, one), np.where(swap[:, None], one, two)
        first = np.clip(np.floor(left[:, 0] - _TOUCH), 0, self.columns).astype(np.intp)
        last = np.clip(np.floor(right[:, 0] + _TOUCH) + 1, 0, self.columns).astype(np.intp)
        segment, column = _ranges(first, last)
        x0, y0 = left[segment].T
        x1, y1 = right[segment].T
        wide = np.maximum(x1 - x0, 1e-12)
        begin = np.clip((np.maximum(column - _TOUCH, x0) - x0) / wide, 0.0, 1.0)
        end = np.clip((np.minimum(column + 1 + _TOUCH, x1) - x0) / wide, 0.0, 1.0)
        upright = x1 - x0 < 1e-9
        begin, end = np.where(upright, 0.0, begin), np.where(upright, 1.0, end)
        a, b = y0 + begin * (y1 - y0), y0 + end * (y1 - y0)
        low = np.clip(np.floor(np.minimum(a, b) - _TOUCH), 0, self.rows).astype(np.intp)
        high = np.clip(np.floor(np.maximum(a, b) + _TOUCH) + 1, 0, self.rows).astype(np.intp)
        which, row = _ranges(low, high)
        found[row, column[which]] = True


def _ranges(first: Indices, end: Indices) -> tuple[Indices, Indices]:
    """Return the numbers from ``first[k]`` to below ``end[k]`` for each k, after the k of each."""
    count = np.maximum(end - first, 0)
    which = np.repeat(np.arange(len(count)), count)
    start = np.cumsum(count) - count
    return which, first[which] + np.arange(len(which)) - start[which]
