"""Place points on a square grid over an area, and find the trees nearest to them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import NDArray

from fieldhand.errors import PlaceError
from fieldhand.language import Number, counted, message
from fieldhand.language.words import say_rounded
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.points.free_ground import MOST_POINTS, area_called, free_part, free_points, part_of_area
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.site.model import Site
from fieldhand.site.rectangle import named_corners, smallest_rectangle

if TYPE_CHECKING:
    from fieldhand.places.points.grid import Grid

Floats = NDArray[np.float64]


def trees_on_grid(of: PlaceGroup, selector: Grid, notes: ResolutionNotes) -> PlaceGroup:
    """Return for each cell of the grid that contains trees of the group the one nearest to its middle.

    Raises:
        PlaceError: The spacing is not possible.
    """
    if not len(of):
        return of
    origin, axes, step, shape = _frame(of.xy, selector)
    local = (of.xy - origin) @ axes.T / step
    cell = np.minimum(np.maximum(np.floor(local), 0.0), shape - 1.0)
    off = np.round(np.hypot(*(local - cell - 0.5).T), 6)
    key = cell[:, 0] * shape[1] + cell[:, 1]
    order = np.lexsort((of.file_order, off, key))
    _, first = np.unique(key[order], return_index=True)
    empty = int(shape[0] * shape[1]) - len(first)
    if empty:
        notes.remark(counted("{count} cell of the grid has no tree", "{count} cells of the grid have no tree", empty))
    notes.rule = _rule(step)
    return of.keep(order[first])


def points_on_grid(site: Site, selector: Grid, notes: ResolutionNotes) -> PlaceGroup:
    """Return the middles of the cells of the grid that lie on free ground of a zone, or of the whole site.

    Raises:
        PlaceError: There is no such zone, no space in it, or the spacing is not possible.
    """
    area = part_of_area(area_called(site, selector.zone), selector.part)
    free = free_part(site, area)
    origin, axes, step, shape = _frame(shapely.get_coordinates(area), selector)
    columns, rows = (np.arange(int(n)) + 0.5 for n in shape)
    local = np.array([(u, v) for k, u in enumerate(columns) for v in (rows if k % 2 == 0 else rows[::-1])])
    xy = origin + (local * step) @ axes
    shapely.prepare(free)
    xy = xy[shapely.intersects_xy(free, *xy.T)]
    if not len(xy):
        raise PlaceError(
            message("no point of a grid {metres} m wide lies there", metres=_metres(selector)),
            where=site.name,
            advice=message("ask for a narrower grid"),
        )
    notes.rule = _rule(step)
    count = len(xy)
    names = [
        message("grid point {number} of {count} in {zone}", number=k, count=count, zone=selector.zone)
        if selector.zone
        else message("grid point {number} of {count}", number=k, count=count)
        for k in range(1, count + 1)
    ]
    return free_points(site, xy, names)


def _frame(xy: Floats, selector: Grid) -> tuple[Floats, Floats, float, Floats]:
    """Return origin, axes (rows of a 2 x 2 matrix), side of a cell, and number of cells along each axis.

    The grid is centred on the smallest-area rectangle around the points and parallel to its sides; it begins in the
    north-west.
    """
    step = selector.every_m
    if not (np.isfinite(step) and step > 0):
        raise PlaceError(
            message("a grid cannot be {metres} m wide", metres=_metres(selector)),
            advice=message("ask for more than 0 m"),
        )
    corner = named_corners(smallest_rectangle(xy))
    sides = np.array([corner["ne"] - corner["nw"], corner["sw"] - corner["nw"]])
    lengths = np.hypot(*sides.T)
    axes = np.array(
        [
            side / length if length > 0 else unit
            for side, length, unit in zip(sides, lengths, np.array([(1.0, 0.0), (0.0, -1.0)]), strict=True)
        ]
    )
    wider = message("ask for a wider grid, of at most {count} cells", count=MOST_POINTS)
    if (lengths > MOST_POINTS * step).any():  # so many along one side: the number of all may not even be a number
        raise PlaceError(
            message("a grid {metres} m wide has too many cells there", metres=_metres(selector)), advice=wider
        )
    shape = np.maximum(np.round(lengths / step), 1.0)
    if shape.prod() > MOST_POINTS:
        cells = int(shape.prod())
        raise PlaceError(
            message("a grid {metres} m wide has {count} cells there", metres=_metres(selector), count=cells),
            advice=wider,
        )
    origin = corner["nw"] + ((lengths - shape * step) / 2.0) @ axes
    return origin, axes, step, shape


def _metres(selector: Grid) -> Number:
    return Number(f"{selector.every_m:g}")


def _rule(step: float) -> str:
    return message("cells of {metres} m, parallel to the sides of the area", metres=say_rounded(step, 1))
