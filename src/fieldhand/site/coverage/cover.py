"""Plan the drive that works on a whole area, swath by swath."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import LineString, MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.site.coverage.cells import CellSearch, SwathCell, divisions
from fieldhand.site.coverage.connections import Pose, connection, turn_metres
from fieldhand.site.coverage.ground import OpenGround, TransitGround
from fieldhand.site.coverage.headland import headland_rings, headland_width, inset, nearest_ring_order
from fieldhand.site.coverage.measures import ends_of, missed_parts, overlap_m2, worked_by
from fieldhand.site.coverage.order import SwathOrder, shortest_swath_order
from fieldhand.site.coverage.plan import XY, CoverageCell, CoverageLeg, CoverageParams, CoveragePlan, Swath
from fieldhand.site.coverage.strips import in_frame, strips, swath_frame

#: Divisions of an area whose whole drive is planned.
_PLANNED = 3

#: Areas with more swaths than this are planned for the cheapest division only.
_MANY_SWATHS = 400

#: Greatest number of swaths of a plan.
MOST_SWATHS = 2_000

#: Swaths shorter than this, in metres, are rounding errors.
_NOTHING_M = 1e-6

#: Orders of the swaths that are tried because turns of an order do not fit on the ground.
_TRIES = 4

#: Metres, in turning radii, that a turn counts for if it does not fit on the ground.
_TIGHT = 40.0


@dataclass(frozen=True, kw_only=True)
class SwathLine:
    """A swath that has no direction yet: its centre line, its cell, and the run of neighbouring swaths it is in."""

    points: tuple[XY, ...]
    cell: int
    run: int


def cover(
    area: Polygon | MultiPolygon,
    params: CoverageParams,
    *,
    ground: BaseGeometry | None = None,
    start: XY | None = None,
    goal: XY | None = None,
) -> CoveragePlan:
    """Plan the drive that works on an area without rows.

    The swaths cover all ground outside the declared headlands, if these are at least half the working width wide: then
    the full width can be driven over every slanted end. With no headland, the robot's centre stays in the area, and
    what its implement cannot reach at slanted edges is listed as missed.

    Args:
        area: Area in local metres; holes are neither worked on nor driven through.
        params: Working width, headlands, turning radius and other parameters.
        ground: Ground on which the robot may drive between swaths; None for the area.
        start: Point from which the drive starts, to choose a near first swath. The drive to it is not included.
        goal: Point at which the robot is to arrive afterwards.

    Raises:
        PlaceError: The area is empty or in parts that no way connects, or a parameter is out of range.
    """
    validate(area, params)
    width, apart = params.working_width_m, params.working_width_m - params.overlap_m
    rings = headland_rings(area, params)
    wide = headland_width(params)
    inside = inset(area, wide)
    if inside.is_empty and not rings:  # too narrow for a headland: swaths from edge to edge
        wide, inside = 0.0, area
    driven = _ground_of(area if ground is None else ground, wide, width)
    turn = params.turn_m if params.turn_m is not None else max(width, math.pi * params.turning_radius_m)
    search = CellSearch(width, apart, turn, params.bearing_deg)
    plans = []
    for cells in divisions(inside, search, _PLANNED) or [()]:
        lanes = _lanes(cells, area, width, apart)
        plans.append(
            plan_lanes(
                lanes, tuple(CoverageCell(polygon=c.polygon, bearing_deg=c.bearing_deg % 180.0) for c in cells),
                rings, driven, params, area=area, inside=inside, start=start, goal=goal,
            )
        )  # fmt: skip
        if len(lanes) > _MANY_SWATHS:
            break
    return min(plans, key=lambda plan: round(_cost(plan, turn), 6))


def _cost(plan: CoveragePlan, turn_m: float) -> float:
    """Return what plans are compared by: metres driven, missed ground, turns, and turns that do not fit."""
    missed = plan.missed_m2 / max(float(plan.area.area), 1e-9)
    return plan.length_m * (1.0 + missed) + turn_m * (len(plan.swaths) + 10.0 * plan.tight_turns)


def validate(area: BaseGeometry, params: CoverageParams) -> None:
    """Raise an error if there is no area to cover, or a parameter is out of range."""
    numbers = [value for value in vars(params).values() if isinstance(value, float)]
    west, south, east, north = area.bounds if not area.is_empty else (0.0, 0.0, 0.0, 0.0)
    extent = math.hypot(east - west, north - south)
    problems = [
        (not all(map(math.isfinite, numbers)), message("the numbers of a coverage must be finite")),
        (not params.working_width_m > 0.0, message("the working width must be greater than 0")),
        (not 0.0 <= params.overlap_m < params.working_width_m,
         message("the overlap of swaths must be less than the working width")),
        (not params.turning_radius_m >= 0.0, message("the turning radius cannot be negative")),
        (params.headland_passes < 0 or (params.headland_m or 0.0) < 0.0, message("a headland cannot be negative")),
        (area.is_empty or not area.area > 0.0, message("there is no area to cover")),
        (not area.is_valid, message("the edge of the area crosses itself")),
        (extent > MOST_SWATHS * (params.working_width_m - params.overlap_m),
         message("the area needs more than {most} swaths", most=MOST_SWATHS)),
    ]  # fmt: skip
    for is_wrong, problem in problems:
        if is_wrong:
            raise PlaceError(problem, advice=message("correct the area or the implement"))


def _ground_of(area: BaseGeometry, headland_m: float, width_m: float) -> OpenGround:
    """Return the ground for the drives between swaths: inside the middle of the outermost pass, if there is one."""
    by = min(headland_m - width_m / 2.0, width_m / 2.0)
    if by <= 0.0:
        return OpenGround(area)
    give = min(0.05 * width_m, by / 2.0)
    smaller = area.buffer(-by + give, quad_segs=4).simplify(0.99 * give)
    whole = len(shapely.get_parts(smaller)) == len(shapely.get_parts(area))
    return OpenGround(smaller if whole and area.covers(smaller) else area)


def _lanes(cells: Sequence[SwathCell], area: BaseGeometry, width_m: float, apart_m: float) -> list[SwathLine]:
    """Return the swaths of all cells, with the part of each that lies in the area."""
    lanes: list[SwathLine] = []
    runs = 0
    for number, cell in enumerate(cells):
        frame = swath_frame(cell.bearing_deg)
        found = strips(in_frame(cell.polygon, frame), width_m, apart_m)
        ends = np.array([[(s.first, s.v), (s.last, s.v)] for s in found]).reshape(-1, 2)
        for strip, line in zip(found, map(LineString, frame.world(ends).reshape(-1, 2, 2)), strict=True):
            run = runs + strip.run
            lanes += [SwathLine(points=part, cell=number, run=run) for part in inside_parts(line, area)]
        runs += max((strip.run for strip in found), default=0) + 1
    return lanes


def inside_parts(line: LineString, area: BaseGeometry) -> list[tuple[XY, ...]]:
    """Return the parts of a line that lie in an area; lines along its edge are in it despite rounding."""
    around = area.buffer(1e-7, join_style="mitre")
    if around.covers(line):
        return [_points(line)]
    parts = shapely.get_parts(line.intersection(around))
    return [_points(part) for part in parts if isinstance(part, LineString) and part.length > _NOTHING_M]


def _points(line: LineString) -> tuple[XY, ...]:
    return tuple((x, y) for x, y in shapely.get_coordinates(line).tolist())


def plan_lanes(
    lanes: Sequence[SwathLine],
    cells: tuple[CoverageCell, ...],
    rings: Sequence[np.ndarray],
    ground: TransitGround,
    params: CoverageParams,
    *,
    area: BaseGeometry,
    inside: BaseGeometry,
    start: XY | None,
    goal: XY | None,
) -> CoveragePlan:
    """Order swaths and headland passes, connect them, and measure what they cover.

    Args:
        lanes: Swaths.
        cells: Cells that the swaths refer to.
        rings: Closed passes of the headland.
        ground: Ground between the passes.
        params: Parameters.
        area, inside: As in :class:`CoveragePlan`.
        start, goal: As in :func:`cover`.

    Raises:
        PlaceError: No way connects two of the passes.
    """
    width = params.working_width_m
    before: list[tuple[XY, ...]] = []
    if rings and params.headland_first:
        before = [_ring_points(ring) for ring in nearest_ring_order(rings, start)]
    ordered = _ordered(lanes, ground, params, before[-1][-1] if before else start, goal)
    after: list[tuple[XY, ...]] = []
    if rings and not params.headland_first:
        at = ordered[-1].points[-1] if ordered else start
        after = [_ring_points(ring) for ring in nearest_ring_order(rings, at)]
    swaths = tuple(Swath(points=lane.points, width_m=width, cell=lane.cell) for lane in ordered)
    passes = [
        *(CoverageLeg(kind="headland", points=ring) for ring in before),
        *(CoverageLeg(kind="swath", points=swath.points, swath=k) for k, swath in enumerate(swaths)),
        *(CoverageLeg(kind="headland", points=ring) for ring in after),
    ]
    legs = _connected(passes, ground, params)
    worked = [worked_by(leg.line, width) for leg in passes]
    covered = shapely.union_all(worked).intersection(area)
    to_work = area if rings else inside
    missed_inside = missed_parts(inside, covered)
    size = float(inside.area)
    return CoveragePlan(
        area=area,
        inside=inside,
        legs=tuple(legs),
        swaths=swaths,
        headlands=tuple(leg.points for leg in passes if leg.kind == "headland"),
        cells=cells,
        covered=covered,
        missed=missed_parts(to_work, covered),
        covered_share=1.0 - sum(part.area for part in missed_inside) / size if size else 1.0,
        overlap_m2=overlap_m2(worked, area, covered),
    )


def _ring_points(ring: np.ndarray) -> tuple[XY, ...]:
    return tuple((x, y) for x, y in ring.tolist())


def _ordered(
    lanes: Sequence[SwathLine], ground: TransitGround, params: CoverageParams, start: XY | None, goal: XY | None
) -> list[SwathLine]:
    """Return the swaths in driving order, each in its direction."""
    if not lanes:
        return []
    if len(lanes) > MOST_SWATHS:
        raise PlaceError(
            message("the area needs more than {most} swaths", most=MOST_SWATHS),
            advice=message("cover each part separately, or correct the area"),
        )
    ends = ends_of([lane.points for lane in lanes])
    extra = [point for point in (start, goal) if point is not None]
    metres = ground.lengths([*ends, *extra])
    n, radius = len(ends), params.turning_radius_m
    between = metres[:n, :n].copy()
    if radius > 0.0:
        between = np.maximum(between, turn_metres(_poses(lanes), radius))
    runs = [list(group) for _, group in itertools.groupby(range(len(lanes)), key=lambda k: lanes[k].run)]
    away = [metres[:n, n + k] if n + k < len(metres) else None for k in range(2)]
    first, last = (away[0], away[1]) if start is not None else (None, away[0] if goal is not None else None)
    best: tuple[float, list[SwathLine]] | None = None
    for attempt in range(_TRIES if radius > 0.0 else 1):
        problem = SwathOrder(between, first, last)
        enters = shortest_swath_order(problem, runs, params.seed + attempt)
        order = [_directed(lanes[end // 2], end % 2 == 1) for end in enters.tolist()]
        if radius == 0.0:
            return order
        tight, length = [], 0.0
        for k, (one, two) in enumerate(itertools.pairwise(order)):
            leg = _connection(ground, Pose.leaving(one.points), Pose.entering(two.points), radius)
            length += 0.0 if leg is None else leg.length_m
            if leg is not None and leg.is_tight:
                tight.append((int(enters[k]) ^ 1, int(enters[k + 1])))
        length += _TIGHT * radius * len(tight)
        if best is None or length < best[0]:
            best = (length, order)
        if not tight:
            break
        for one_end, two_end in tight:
            between[[one_end, two_end], [two_end, one_end]] += _TIGHT * radius
    return best[1] if best is not None else []


def _poses(lanes: Sequence[SwathLine]) -> np.ndarray:
    """Return the pose at which each lane is left at its two ends, shape (2 n, 3)."""
    return np.array([Pose.leaving(points).array for lane in lanes for points in (lane.points[::-1], lane.points)])


def _directed(lane: SwathLine, backwards: bool) -> SwathLine:
    return SwathLine(points=lane.points[::-1], cell=lane.cell, run=lane.run) if backwards else lane


def _connected(passes: Sequence[CoverageLeg], ground: TransitGround, params: CoverageParams) -> list[CoverageLeg]:
    """Return the passes with the drives between them."""
    legs: list[CoverageLeg] = []
    for leg in passes:
        if legs:
            way = _connection(ground, Pose.leaving(legs[-1].points), Pose.entering(leg.points), params.turning_radius_m)
            if way is not None:
                legs.append(way)
        legs.append(leg)
    return legs


def _connection(ground: TransitGround, one: Pose, two: Pose, radius_m: float) -> CoverageLeg | None:
    try:
        return connection(ground, one, two, radius_m)
    except ValueError:
        raise PlaceError(
            message("no way connects the parts of the area"),
            advice=message("cover each part separately, or correct the area"),
        ) from None
