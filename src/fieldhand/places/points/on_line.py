"""Place points at an exact spacing on a straight line beside a row or across an area."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString, Point
from shapely.geometry.base import BaseGeometry

from fieldhand import language
from fieldhand.errors import PlaceError
from fieldhand.language import Number, message
from fieldhand.language.words import COMPASS, say_number, say_rounded
from fieldhand.places.neighbours.distances import Origin, distance_to, nearest_of
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.points.free_ground import (
    MOST_POINTS,
    area_around,
    area_called,
    free_part,
    free_points,
    segments,
    tree_index,
)
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.site import counting
from fieldhand.site.counting import row_words, wind
from fieldhand.site.model import Site
from fieldhand.site.names import short
from fieldhand.site.planting import Row
from fieldhand.site.rectangle import smallest_rectangle

if TYPE_CHECKING:
    from fieldhand.places.points.spaced import Spaced


Floats = NDArray[np.float64]

#: Minimum offset from a row, as a fraction of the row spacing, at which the origin determines the side of the line.
_ASIDE = 0.25

#: Number of lines tried across an area.
_LINES = 41


@dataclass(frozen=True, kw_only=True)
class _Line:
    """A straight line for points.

    Attributes:
        pieces: Free pieces of the line.
        where: Suffix of the points' ids: "east of row 3" in "15 m point 2 east of row 3".
        words: Wording in messages: "beside row 3".
    """

    pieces: Sequence[LineString]
    where: str
    words: str


#: Distance of a line from its row towards the next one, as a fraction of the row spacing; nearer to its own row.
_BESIDE = 0.4


def on_line(spots: PlaceGroup, near: Origin, selector: Spaced, notes: ResolutionNotes) -> PlaceGroup:
    """Return points at an exact spacing on one straight line, starting at the end nearer to ``near``.

    Raises:
        PlaceError: The points do not fit; the message gives the number that does.
    """
    site, apart, count = spots.site, selector.apart_m, selector.count
    if not (np.isfinite(apart) and apart > 0):
        raise PlaceError(
            message("points cannot be {apart} m apart", apart=Number(f"{apart:g}")),
            advice=message("ask for more than 0 m"),
        )
    if not 0 <= count <= MOST_POINTS:
        raise PlaceError(
            message("{count} points are too many for one line", count=count),
            advice=message("ask for at most {count}", count=MOST_POINTS),
        )
    in_row = spots.keep(spots.row >= 0) if not selector.zone and site.planting.blocks else spots.keep([])
    lines = _beside_row(in_row, near, notes) if len(in_row) else _across_area(spots, selector.zone, notes)
    line, piece = _fitting(lines, _from(near, spots), apart, count, notes)
    fit = min(int(piece.length / apart + 1e-6) + 1, MOST_POINTS)
    if fit < count or not fit:
        raise _does_not_fit(site, selector, line, piece, fit)
    ends = np.array(piece.coords)[[0, -1]]
    step = (ends[1] - ends[0]) / np.hypot(*(ends[1] - ends[0]))
    xy = ends[0] + np.arange(count or fit)[:, None] * apart * step
    notes.remark(
        message(
            "the line runs {north} {beside_row}, {metres} m long",
            north=COMPASS[wind(step)],
            beside_row=line.words,
            metres=say_rounded(piece.length),
        )
    )
    names = [
        message("{distance} m point {number} {beside_row}", distance=say_number(apart), number=k, beside_row=line.where)
        for k in range(1, len(xy) + 1)
    ]
    return free_points(site, xy, names)


def _fitting(
    lines: Iterator[_Line], near: Floats, apart: float, count: int, notes: ResolutionNotes
) -> tuple[_Line, LineString]:
    """Return the first line with a piece long enough for the count, and that piece, starting at the end nearer to
    ``near``; else the longest piece. Without a count, return the longest piece of the first line that has one.
    """
    longest: tuple[_Line, LineString] | None = None
    for line in lines:
        pieces = sorted((_begun(p, near) for p in line.pieces), key=lambda p: round(Point(near).distance(p), 3))
        if len(pieces) > 1:
            notes.remark(
                message(
                    "keep-outs or the boundary cut the line {beside_row} into {count} pieces; one of them is used",
                    beside_row=line.words,
                    count=len(pieces),
                )
            )
        for piece in pieces:
            if longest is None or piece.length > longest[1].length + 1e-6:
                longest = (line, piece)
            if count and piece.length >= (count - 1) * apart - 1e-6:
                return line, piece
        if not count and longest is not None:
            return longest
    if longest is None:
        raise PlaceError(
            message("there is no free line there"),
            advice=message("all of it is inside keep-outs or outside the boundary"),
        )
    return longest


def _begun(piece: LineString, near: Floats) -> LineString:
    """Return the piece directed so that it begins at the end nearer to ``near``."""
    first, last = (np.hypot(*(np.array(piece.coords[k]) - near)) for k in (0, -1))
    return piece if first <= last + 1e-6 else LineString(list(piece.coords)[::-1])


def _does_not_fit(site: Site, selector: Spaced, line: _Line, piece: LineString, fit: int) -> PlaceError:
    return PlaceError(
        language.counted(
            "{wanted} points {metres} m apart do not fit {line}: {count} does on its {length} m",
            "{wanted} points {metres} m apart do not fit {line}: {count} do on its {length} m",
            fit,
            wanted=selector.count,
            metres=say_number(selector.apart_m),
            line=line.words,
            length=Number(f"{piece.length:.0f}"),
        ),
        where=site.name,
        advice=message("ask for at most {count}, or for points nearer to each other", count=fit),
    )


def _from(near: Origin, spots: PlaceGroup) -> Floats:
    """Return the origin point: the first place of ``near``, or the point of a zone nearest to a tree."""
    if isinstance(near, PlaceGroup):
        return np.asarray(near.xy[0])
    return np.asarray(nearest_of(near, spots.ranked(distance_to(spots, near), 1))[0])


def _beside_row(in_row: PlaceGroup, near: Origin, notes: ResolutionNotes) -> Iterator[_Line]:
    """Yield lines beside the row of the tree nearest to ``near``, those on the side of ``near`` first."""
    site = in_row.site
    nearest = in_row.ranked(distance_to(in_row, near), 1)
    row = site.planting.rows[int(nearest.row[0])]
    block = site.planting.blocks[row.block]
    at = next(k for k, r in enumerate(block.rows) if r is row)
    u, v = counting.along(block), counting.across(block)
    centre, slope = _course(site, row, u, v)
    begin, end = (float(site.xy[row.trees[k]] @ u) for k in (0, -1))
    begun = _from(near, in_row)
    aside = float(begun @ v) - (centre + slope * float(begun @ u))
    spacing = block.row_spacing_m if np.isfinite(block.row_spacing_m) else block.tree_spacing_m
    inner = [k for k in (1, -1) if 0 <= at + k < len(block.rows)]
    sides = inner + [k for k in (1, -1) if k not in inner]
    if abs(aside) > _ASIDE * spacing:
        sides.sort(key=lambda k: k * aside < 0)
    notes.rule = f"{row_words(site, row)} is the nearest row"
    for side in sides:
        if side in inner:
            c, s = _course(site, block.rows[at + side], u, v)
            middle, tilt = centre + _BESIDE * (c - centre), slope + _BESIDE * (s - slope)
        else:
            middle, tilt = centre + side * block.tree_spacing_m / 2, slope
        ends = [t * u + (middle + tilt * t) * v for t in (begin, end)]
        line = LineString(ends) if end - begin > 1e-6 else LineString([ends[0], ends[0] + 1e-3 * u])
        words = row_words(site, row)
        yield _Line(
            pieces=segments(free_part(site, line)),
            where=message("{north} of {row}", context="beside", north=COMPASS[wind(side * v)], row=words),
            words=message("beside {row}", row=words),
        )


def _course(site: Site, row: Row, u: Floats, v: Floats) -> tuple[float, float]:
    """Return the fitted line of a row: its offset across at the origin, and its slope."""
    xy = site.xy[row.trees]
    along, aside = xy @ u, xy @ v
    if len(xy) < 5 or np.ptp(along) < 1.0:
        return float(aside.mean()), 0.0
    slope, offset = np.polyfit(along - along.mean(), aside, 1)
    return float(offset - slope * along.mean()), float(slope)


def _across_area(spots: PlaceGroup, zone: str, notes: ResolutionNotes) -> Iterator[_Line]:
    """Yield straight lines through a zone or the extent of the trees, clear of trees and near the middle first."""
    site = spots.site
    area = area_called(site, zone) if zone else area_around(spots.xy, site.spacing_m / 2)
    u = _long_way(site, area)
    v = np.array([-u[1], u[0]])
    middle = np.array(area.centroid.coords[0])
    outline = (shapely.get_coordinates(area) - middle) @ v
    reach = float(np.hypot(*np.ptp(shapely.get_coordinates(area), axis=0)))
    free = free_part(site, area)
    notes.rule = "a straight line " + (f"inside {short(zone)}" if zone else "through the trees")
    offsets = [0.0, *np.linspace(outline.min(), outline.max(), _LINES)[1:-1].tolist()]
    found = []
    for offset in offsets:
        at = middle + offset * v
        pieces = segments(LineString([at - reach * u, at + reach * u]).intersection(free))
        if pieces:
            found.append((-_clear(site, pieces), abs(offset), offset, pieces))
    found.sort(key=lambda f: f[:3])
    through = message("through the trees")
    where = message("in {zone}", zone=zone) if zone else through
    words = message("inside {zone}", zone=short(zone)) if zone else through
    for _, _, _, pieces in found:
        yield _Line(pieces=pieces, where=where, words=words)


def _long_way(site: Site, area: BaseGeometry) -> Floats:
    """Return the unit vector along the rows in an area, or along the area if it has no rows."""
    inside = np.flatnonzero(shapely.intersects_xy(area, *site.xy.T))
    rows = site.planting.row_of[inside]
    if (rows >= 0).any():
        row = site.planting.rows[int(np.bincount(rows[rows >= 0]).argmax())]
        return counting.along(site.planting.blocks[row.block])
    corners = smallest_rectangle(shapely.get_coordinates(area))
    sides = corners[1] - corners[0], corners[3] - corners[0]
    longer = max(sides, key=lambda side: round(float(np.hypot(*side)), 3))
    return np.asarray(longer / np.hypot(*longer))


def _clear(site: Site, pieces: Sequence[LineString]) -> float:
    """Return the distance from a line to the nearest tree in steps of 0.5 m, capped at half a tree spacing."""
    along = [np.linspace(0, piece.length, min(int(piece.length) + 2, 400)) for piece in pieces]
    xy = np.vstack(
        [shapely.get_coordinates(shapely.line_interpolate_point(p, t)) for p, t in zip(pieces, along, strict=True)]
    )
    nearest = float(np.min(tree_index(site).nearest(xy)[0]))
    return round(2 * min(nearest, site.spacing_m / 2)) / 2
