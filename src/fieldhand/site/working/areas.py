"""Units of work over an area lane by lane, along its edge, and along the ends of rows."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely.geometry import LineString, MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.language.words import COMPASS
from fieldhand.site.counting import require_rows
from fieldhand.site.coverage.cover import cover
from fieldhand.site.coverage.headland import rings_at
from fieldhand.site.coverage.plan import CoverageParams, CoveragePlan
from fieldhand.site.coverage.row_passes import cover_rows
from fieldhand.site.working.heading import facing
from fieldhand.site.working.lanes import LanePath, lanes_past
from fieldhand.site.working.stretch import Stretch
from fieldhand.site.working.units import MountedSide, WorkUnit
from fieldhand.terms import Side

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

XY = tuple[float, float]

#: Parts of lanes shorter than this, in metres, are not driven.
_SHORT_M = 1.0
#: Greatest distance in metres between points of an edge that the robot passes.
_EDGE_STEP_M = 8.0
#: Distance in metres that a drive around an area keeps from its edge, beside the robot's clearance.
_OUTSIDE_M = 0.5
#: Metres that a drive along an edge keeps beside the clearance, within which ground is approximated.
_EDGE_M = 0.15
#: Greatest angle in degrees between rows and the direction in which lanes are to run.
_ALONG_ROWS_DEG = 45.0
#: Share of an area's trees in rows from which it is worked along the rows.
_PLANTED = 0.5


@dataclass(frozen=True, kw_only=True)
class AreaWork:
    """Work over an area.

    Attributes:
        units: Lanes and headland passes in driving order.
        area_m2: Ground to be worked.
        covered_m2: Ground that the lanes cover.
        overlap_m2: Ground covered twice, counted for each further time.
    """

    units: tuple[WorkUnit, ...]
    area_m2: float
    covered_m2: float
    overlap_m2: float


def area_work(
    drives: Drives,
    ground: BaseGeometry,
    width_m: float,
    here: XY,
    home: XY | None,
    *,
    bearing_deg: float | None = None,
) -> AreaWork:
    """Return the work over an area: along its rows where it has rows, else in swaths with one pass around it.

    Args:
        drives: Drives of the robot.
        ground: The area in local metres.
        width_m: Working width.
        here, home: Where the robot is, and where it drives afterwards.
        bearing_deg: Bearing of the swaths, clockwise from north; None for the best one.

    Raises:
        PlaceError: There is no ground that the robot can work on, or its rows run another way.
    """
    layout = drives.layout
    free = ground.intersection(layout.free.hard) if layout.free.bounded else ground
    area = _polygons(free)
    if area is None:
        raise PlaceError(
            message("there is no ground to drive on here"),
            where=drives.site.name,
            advice=message("name an area outside keep-outs and inside the boundary"),
        )
    params = CoverageParams(working_width_m=width_m, bearing_deg=bearing_deg)
    if _has_rows(drives, ground):
        _require_rows_along(drives, ground, bearing_deg)
        plan = cover_rows(layout, area, params, start=here, goal=home)
        # The ends of the rows are ground to turn on.
        return _work_of(drives, plan)
    inset = max(0.0, drives.clearance_m - width_m / 2.0) if layout.free.bounded else 0.0
    inner = _polygons(area.buffer(-inset, join_style="mitre")) if inset else area
    return _work_of(drives, cover(area if inner is None else inner, params, start=here, goal=home))


def _has_rows(drives: Drives, ground: BaseGeometry) -> bool:
    site = drives.site
    inside = shapely.intersects_xy(ground, site.xy[:, 0], site.xy[:, 1])
    planted = site.planting.row_of[inside] >= 0 if site.planting.blocks else np.zeros(0, dtype=bool)
    return len(planted) > 1 and float(planted.mean()) >= _PLANTED


def _require_rows_along(drives: Drives, ground: BaseGeometry, bearing_deg: float | None) -> None:
    """Raise an error if lanes were to run across rows.

    Raises:
        PlaceError: The rows run another way.
    """
    site = drives.site
    inside = shapely.intersects_xy(ground, site.xy[:, 0], site.xy[:, 1])
    rows = {int(k) for k in site.planting.row_of[inside] if k >= 0}
    for block in {site.planting.rows[k].block for k in rows}:
        turned = abs((site.planting.blocks[block].bearing_deg - (bearing_deg or 0.0) + 90.0) % 180.0 - 90.0)
        if bearing_deg is not None and turned > _ALONG_ROWS_DEG:
            raise PlaceError(
                message("the lanes of this area run along its rows, and these run another way"),
                where=site.name,
                advice=message("leave the direction of the lanes out"),
            )


def _work_of(drives: Drives, plan: CoveragePlan) -> AreaWork:
    """Return the passes of a plan that the robot can drive, as units in driving order."""
    units: list[WorkUnit] = []
    count = itertools.count(1)
    rounds = itertools.count(1)
    for leg in plan.legs:
        if not leg.works:
            continue
        if leg.kind == "headland":
            name = message("pass {number} around the area", context="log", number=next(rounds))
        else:
            name = message("lane {number}", context="log", number=next(count))
        stretches = tuple(_drivable(drives, name, leg.points))
        if stretches:
            units.append(WorkUnit(options=(stretches,)))
    if not units:
        raise PlaceError(
            message("the robot can drive on no part of this area"),
            where=drives.site.name,
            advice=message("choose another area, or a narrower robot"),
        )
    return AreaWork(
        units=tuple(units),
        area_m2=float(plan.inside.union(plan.covered).area),
        covered_m2=plan.covered_m2,
        overlap_m2=plan.overlap_m2,
    )


def _drivable(drives: Drives, name: str, points: Sequence[XY]) -> Iterator[Stretch]:
    """Yield the parts of a line on drivable ground."""
    line: BaseGeometry = LineString(points)
    if drives.layout.free.bounded:
        line = line.intersection(drives.layout.free.soft.buffer(_SHORT_M / 50.0))
    parts = [p for p in shapely.get_parts(shapely.line_merge(line)) if p.length >= _SHORT_M]
    for number, part in enumerate(parts, start=1):
        called = name if len(parts) == 1 else message("{row}, part {number}", context="log", row=name, number=number)
        yield Stretch(
            name=called, points=tuple((float(x), float(y)) for x, y in part.coords), on=((0.0, float(part.length)),)
        )


# --- edges ------------------------------------------------------------------------------------------------------------


def perimeter_units(
    drives: Drives,
    ground: BaseGeometry,
    inset_m: float,
    *,
    outside: bool,
    mounted: MountedSide,
    from_edge_m: float = 0.0,
    side: Side | None = None,
    clockwise: bool | None = None,
) -> tuple[WorkUnit, ...]:
    """Return the work along the edge of an area, clockwise unless the implement works to the left.

    Args:
        drives: Drives of the robot.
        ground: The area in local metres.
        inset_m: Distance of the drive from the edge: half the working width, or the clearance if that is more.
        outside: True to drive around the area, outside of it.
        mounted: Side of the robot on which the implement works; it faces the area that is driven around, and the edge
            of an area that is driven along inside.
        from_edge_m: Distance by which the drive is farther from the edge than the first round.
        side: Side of the compass to which the worked part of the edge faces; None for all of it.
        clockwise: True to drive clockwise, False for the other way, whatever the implement faces; None for the usual.

    Raises:
        PlaceError: The robot cannot drive along the edge, or that side of it.
    """
    inset = max(inset_m, drives.clearance_m) + _EDGE_M + from_edge_m
    edge = ground.buffer(inset + _OUTSIDE_M, quad_segs=4) if outside else ground
    area = _polygons(edge)
    rings = [] if area is None else rings_at(area, 0.0 if outside else inset, holes=False)
    one_way = mounted in ("left", "right") or clockwise is not None
    clockwise = mounted != ("left" if outside else "right") if clockwise is None else clockwise
    found: list[WorkUnit] = []
    for number, ring in enumerate(rings, start=1):
        at = np.asarray(ring)
        parts = [at[::-1] if clockwise else at]
        if side is not None:
            parts = facing(parts[0], side, clockwise=clockwise)
        lanes: list[LanePath] = []
        for part in parts:
            stops = _stops(part)
            clear = drives.layout.is_clear(np.array(stops))
            lanes += lanes_past(drives, [stop for stop, ok in zip(stops, clear.tolist(), strict=True) if ok])
        name = message("around the area", context="log")
        if len(rings) > 1:
            name = message("around part {number} of the area", context="log", number=number)
        if side is not None:
            name = message("{north} side, {stretch}", context="log", north=COMPASS[side], stretch=name)
        found += _unit(name, lanes, one_way=one_way)
    if not found and rings and side is not None:
        raise PlaceError(
            message("the robot cannot drive along the {north} side of this area", north=COMPASS[side]),
            where=drives.site.name,
            advice=message("name another side"),
        )
    if not found:
        raise PlaceError(
            message("the robot cannot drive along the edge of this area"),
            where=drives.site.name,
            advice=message("choose another area, or a narrower robot"),
        )
    return tuple(found)


def _unit(name: str, lanes: Sequence[LanePath], *, one_way: bool = False) -> list[WorkUnit]:
    """Return the unit of the paths along an edge; none if there is nothing to drive."""
    stretches = []
    for part, lane in enumerate(lanes, start=1):
        called = name if len(lanes) == 1 else message("{row}, part {number}", context="log", row=name, number=part)
        stretch = Stretch(name=called, points=lane.points, on=((lane.at_m[0], lane.at_m[-1]),), one_way=one_way)
        if stretch.length_m >= _SHORT_M:
            stretches.append(stretch)
    return [WorkUnit(options=(tuple(stretches),))] if stretches else []


def _stops(ring: np.ndarray) -> list[XY]:
    """Return the corners of a ring and points between them."""
    found: list[XY] = []
    for (ax, ay), (bx, by) in itertools.pairwise(ring.tolist()):
        steps = max(1, math.ceil(math.dist((ax, ay), (bx, by)) / _EDGE_STEP_M))
        found += [(ax + (bx - ax) * k / steps, ay + (by - ay) * k / steps) for k in range(steps)]
    last = ring[-1].tolist()
    return [*found, (float(last[0]), float(last[1]))]


def headland_units(drives: Drives, trees: Sequence[int]) -> tuple[WorkUnit, ...]:
    """Return the work along both ends of the rows of some trees.

    Raises:
        PlaceError: The trees stand in no row, or no way leads along the ends of the rows.
    """
    site = drives.site
    planting = require_rows(site)
    rows = set(planting.row_of[list(trees)].tolist()) - {-1}
    found: list[WorkUnit] = []
    several = len([g for g in drives.layout.aisles.groups if rows & {r for line in g.lines for r in line.rows}]) > 1
    for group in drives.layout.aisles.groups:
        inside = [k for k, line in enumerate(group.lines) if rows & set(line.rows)]
        if not inside:
            continue
        block = planting.blocks[group.block]
        for end in (0, 1):
            stops = [tuple(map(float, xy)) for k in inside for xy in group.obstacles[k].ends[end].tolist()]
            across = np.array(stops) @ group.frame.across
            ordered: list[XY] = [(stops[k][0], stops[k][1]) for k in np.argsort(across, kind="stable").tolist()]
            clear = drives.layout.is_clear(np.array(ordered)).tolist()
            usable = [stop for stop, ok in zip(ordered, clear, strict=True) if ok]
            name = message("headland {number}", context="log", number=end + 1)
            if several:
                name = message("headland {number} of block {block}", context="log", number=end + 1, block=block.name)
            found += _unit(name, lanes_past(drives, usable))
    if not found:
        raise PlaceError(
            message("the robot cannot drive along the ends of these rows"),
            where=site.name,
            advice=message("choose other rows, or a narrower robot"),
        )
    return tuple(found)


def _polygons(ground: BaseGeometry) -> Polygon | MultiPolygon | None:
    parts = [p for p in shapely.get_parts(ground) if isinstance(p, Polygon) and p.area > 0.0]
    if not parts:
        return None
    return parts[0] if len(parts) == 1 else MultiPolygon(parts)
