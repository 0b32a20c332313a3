"""Plan the drive that works on the aisles of a planted area: along the rows, never across them."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from shapely.geometry import LineString, MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.site.coverage.cover import SwathLine, inside_parts, plan_lanes, validate
from fieldhand.site.coverage.ground import RowGround
from fieldhand.site.coverage.plan import XY, CoverageCell, CoverageParams, CoveragePlan
from fieldhand.site.coverage.strips import centres
from fieldhand.site.driving.aisles import RowGroup
from fieldhand.site.driving.graph import Points
from fieldhand.site.driving.layout import Layout
from fieldhand.site.driving.rowlines import Frame, RowLine

#: Aisles and sides of which less than this, in square metres, lies in the area are left out.
_LITTLE_M2 = 0.01

#: Tolerance in metres to which the line of a pass is simplified at least.
_FINE_M = 0.01


def cover_rows(
    layout: Layout,
    area: Polygon | MultiPolygon,
    params: CoverageParams,
    *,
    start: XY | None = None,
    goal: XY | None = None,
) -> CoveragePlan:
    """Plan the drive that works on all aisles of an area, from the first to the last plant.

    Each aisle gets as many passes as its greatest width needs, evenly spaced between its rows and following them where
    they are curved. The outer sides of the outermost rows get one pass each, where the area reaches that far. The ends
    of the rows are the headland: the robot turns there, and drives from aisle to aisle, on the drivable ground of the
    site. Passes that it cannot reach are left out, and their ground is listed as missed.

    Args:
        layout: Drivable layout of the site for the robot (:attr:`fieldhand.site.drives.Drives.layout`).
        area: Area in local metres, such as the outline of a block. Only aisles inside it are worked on.
        params: Working width and others; headlands, overlap with the next row, and bearings have no effect.
        start, goal: As in :func:`fieldhand.site.coverage.cover.cover`.

    Raises:
        PlaceError: The area has no aisle that the robot can drive through, or no way connects two of them.
    """
    validate(area, params)
    if params.passes_per_aisle is not None and params.passes_per_aisle < 1:
        raise PlaceError(
            message("an aisle needs at least one pass"), advice=message("correct the area or the implement")
        )
    ground = area.intersection(layout.free.soft) if layout.free.bounded else area
    workable = area.intersection(layout.free.hard) if layout.free.bounded else area
    lanes: list[SwathLine] = []
    cells: list[CoverageCell] = []
    strips: list[BaseGeometry] = []
    run = 0
    for group in layout.aisles.groups:
        for between in _aisles(layout, group):
            strip = between.polygon(params).intersection(workable)
            if strip.area < _LITTLE_M2:
                continue
            cells.append(CoverageCell(polygon=strip, bearing_deg=_bearing(between.frame)))
            strips.append(strip)
            for line in between.passes(params):
                lanes += [SwathLine(points=part, cell=len(cells) - 1, run=run) for part in inside_parts(line, ground)]
        run += 1
    lanes = _reachable(layout, lanes, start)
    if not lanes:
        raise PlaceError(
            message("the robot can reach no aisle of the area and drive through it"),
            advice=message("name an area with rows, or use a narrower robot"),
        )
    return plan_lanes(
        lanes, tuple(cells), (), RowGround(layout), params,
        area=area, inside=shapely.union_all(strips), start=start, goal=goal,
    )  # fmt: skip


def _reachable(layout: Layout, lanes: list[SwathLine], start: XY | None) -> list[SwathLine]:
    """Return the passes on the ground that the start is on; without a start, on that with the longest passes."""
    if not layout.open or not lanes:
        return lanes
    parts: dict[int, list[SwathLine]] = {}
    for lane in lanes:
        one, two = layout.spots([lane.points[0], lane.points[-1]])
        if one.part == two.part >= 0:
            parts.setdefault(one.part, []).append(lane)
    if start is not None:
        return parts.get(layout.spot(start).part, [])
    return max(parts.values(), key=lambda some: sum(LineString(lane.points).length for lane in some), default=[])


@dataclass(frozen=True, eq=False)
class _Between:
    """The ground on one side of a row or between two rows, in the frame of their group.

    Attributes:
        group: Group of the rows.
        below, above: The rows on either side; None for the open side of an outermost row.
        clearance_m: Distance in metres that the robot keeps from rows.
    """

    group: RowGroup
    below: RowLine | None
    above: RowLine | None
    clearance_m: float

    @property
    def frame(self) -> Frame:
        return self.group.frame

    @cached_property
    def along(self) -> Points:
        """Return the u at which the rows are sampled, from the first plant beside the aisle to the last."""
        lines = [line for line in (self.below, self.above) if line is not None]
        return np.unique(np.concatenate([line.u for line in lines]))

    def edges(self, params: CoverageParams) -> tuple[Points, Points]:
        """Return the least and the greatest v that is worked on, at each u."""
        gap, wide = params.row_gap_m, params.working_width_m
        if self.below is None:
            assert self.above is not None  # noqa: S101 - one of the rows is there
            high = np.interp(self.along, self.above.u, self.above.low) - gap
            return high - max(wide, wide / 2.0 + self.clearance_m - gap), high
        low = np.interp(self.along, self.below.u, self.below.high) + gap
        if self.above is None:
            return low, low + max(wide, wide / 2.0 + self.clearance_m - gap)
        high = np.interp(self.along, self.above.u, self.above.low) - gap
        return low, np.maximum(high, low)

    def polygon(self, params: CoverageParams) -> BaseGeometry:
        """Return the ground that is to be worked on."""
        low, high = self.edges(params)
        if len(self.along) < 2 or not (high > low).any():
            return Polygon()
        ring = np.vstack([np.column_stack([self.along, low]), np.column_stack([self.along, high])[::-1]])
        strip = Polygon(self.frame.world(ring))
        return strip if strip.is_valid else strip.buffer(0.0)

    def passes(self, params: CoverageParams) -> Iterator[LineString]:
        """Yield the centre lines of the passes, from below to above; none where the robot does not fit."""
        if len(self.along) < 2:
            return
        low, high = self.edges(params)
        # Where the robot keeps its clearance from both rows, which may be bent.
        least = np.full(len(self.along), -np.inf) if self.below is None else np.interp(self.along, *self.below.upper)
        most = np.full(len(self.along), np.inf) if self.above is None else np.interp(self.along, *self.above.lower)
        if (least > most).any():
            return
        widest = float((high - low).max())
        if params.passes_per_aisle is None or self.below is None or self.above is None:
            shares = centres(0.0, widest, params.working_width_m, params.working_width_m - params.overlap_m)
        else:
            edge = min(params.working_width_m, widest) / 2.0
            count = params.passes_per_aisle
            shares = np.linspace(edge, widest - edge, count) if count > 1 else np.array([widest / 2.0])
        half = params.working_width_m / 2.0
        # A pass that is wider than its aisle need not follow every plant that stands out of line.
        spare = half - widest / 2.0 if len(shares) == 1 else 0.0
        for position in shares.tolist():
            share = 0.5 if len(shares) == 1 else (position - half) / (widest - 2.0 * half)
            # In a narrower part of the aisle the passes overlap more, and their outer edges stay at the rows.
            first, last = np.minimum(low + half, (low + high) / 2.0), np.maximum(high - half, (low + high) / 2.0)
            v = np.clip(first + share * (last - first), least, most)
            line = LineString(self.frame.world(np.column_stack([self.along, v])))
            yield shapely.simplify(line, max(_FINE_M, spare))


def _aisles(layout: Layout, group: RowGroup) -> Iterator[_Between]:
    """Yield the outer side of the first row of a group, its aisles, and the outer side of its last row."""
    lines = [None, *group.lines, None]
    for below, above in itertools.pairwise(lines):
        yield _Between(group, below, above, layout.free.clearance_m)


def _bearing(frame: Frame) -> float:
    """Return the bearing of rows, clockwise from true north, 0 up to 180."""
    return float(np.degrees(np.arctan2(frame.along[0], frame.along[1])) % 180.0)
