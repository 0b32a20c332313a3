"""Ground where a robot may be: inside the boundary and outside every keep-out, through fences only at gates."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString, Point, Polygon, box
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from fieldhand.language import message
from fieldhand.site.model import Gate, Site, Zone

if TYPE_CHECKING:
    from fieldhand.site.closed_ground import ClosedGround

Points = NDArray[np.float64]

#: Half the thickness in metres of the fence between two touching parts of a site.
_FENCE_M = 0.02

#: Boundaries that overlap in a strip narrower than this, in metres, are treated as touching.
_SLIVER_M = 0.25

#: Tolerance in metres: paths run along edges, so a smaller overlap is a touch.
TOUCH_M = 1e-6

#: Chords per quarter turn that approximate the arc around a corner, outside the true arc.
_CHORDS = 2

#: A traced pond may have thousands of corners. If there are more than this, they are simplified by keeping up to this
#: much more distance, in metres.
_MANY_CORNERS = 900
_GIVE_M = (0.05, 0.1, 0.2, 0.4)

#: Extent in metres of the ground beyond all features of a site without a boundary.
_FAR_M = 50_000.0


@dataclass(frozen=True, eq=False)
class FreeSpace:
    """The ground of a site that is open to a robot of a given width.

    Attributes:
        clearance_m: Distance in metres that the robot keeps from edges.
        bounded: True if the site has a boundary or keep-outs.
        hard: Ground that the robot may never leave.
        soft: Hard ground without a margin of the clearance along its edges.
        keep_outs: Keep-outs with their names, for messages.
        closed: Ground that the mission keeps out of, with its names.
    """

    clearance_m: float
    bounded: bool
    hard: BaseGeometry
    soft: BaseGeometry
    keep_outs: tuple[Zone, ...]
    closed: tuple[ClosedGround, ...] = ()

    def covers(self, shapes: BaseGeometry | NDArray[np.object_], *, soft: bool) -> NDArray[np.bool_]:
        """Return which of the shapes lie on this ground."""
        return self._area(soft).covers(shapes)

    def holds(self, xy: Points, *, soft: bool) -> NDArray[np.bool_]:
        """Return which of the points, shape (n, 2), lie on this ground."""
        return self._area(soft).holds(xy)

    def sees(self, one: Points, two: Points, *, soft: bool) -> NDArray[np.bool_]:
        """Return which straight lines, from points (n, 2) to points (n, 2), lie on this ground."""
        return self._area(soft).sees(one, two)

    def in_the_way(self, shape: BaseGeometry) -> str:
        """Return the obstacle of a line or an area: "keep-out 'pond'" or "the boundary"; empty if there is none."""
        for zone in self.keep_outs:
            if zone.polygon.distance(shape) < self.clearance_m * 1.001:
                return message("keep-out '{zone}'", zone=zone.name)
        for ground in self.closed:
            if ground.shape.distance(shape) < self.clearance_m * 1.001:
                return message("ground on which the robot must not drive")
        return "" if self._area(soft=True).covers(shape)[0] else message("the boundary")

    def _area(self, soft: bool) -> Area:
        return self._soft if soft else self._hard

    @cached_property
    def _soft(self) -> Area:
        return Area(self.soft)

    @cached_property
    def _hard(self) -> Area:
        return Area(self.hard)


class Area:
    """Ground prepared for many spatial queries. Shapes that touch its edge from inside are on it despite rounding.

    Args:
        ground: The ground.
        barriers: Lines off the ground. A straight line between two points of the ground leaves it only across one of
            them. Without barriers the edge of the ground is used.
    """

    def __init__(self, ground: BaseGeometry, barriers: BaseGeometry | None = None) -> None:
        self.edged = ground.buffer(TOUCH_M, join_style="mitre")
        self._barriers = self.edged.boundary if barriers is None else barriers
        shapely.prepare(self.edged)
        shapely.prepare(self._barriers)

    def covers(self, shapes: BaseGeometry | NDArray[np.object_]) -> NDArray[np.bool_]:
        """Return which of the shapes lie on the ground."""
        return np.atleast_1d(np.asarray(shapely.covers(self.edged, np.atleast_1d(np.asarray(shapes)))))

    def holds(self, xy: Points) -> NDArray[np.bool_]:
        """Return which of the points, shape (n, 2), lie on the ground."""
        return np.asarray(shapely.intersects_xy(self.edged, xy[:, 0], xy[:, 1]))

    def sees(self, one: Points, two: Points) -> NDArray[np.bool_]:
        """Return which straight lines, from points (n, 2) to points (n, 2), lie on the ground.

        Both of their ends are on the ground and they cross no barrier, which is much faster to test than coverage.
        """
        clear = self.clear(one, two)
        clear[clear] = self.holds(one[clear])
        clear[clear] = self.holds(two[clear])
        return clear

    def clear(self, one: Points, two: Points) -> NDArray[np.bool_]:
        """Return which straight lines, from points (n, 2) to points (n, 2), both on the ground, do not leave it."""
        return ~np.asarray(shapely.intersects(self._barriers, shapely.linestrings(np.stack([one, two], axis=1))))


def free_space(site: Site, clearance_m: float) -> FreeSpace:
    """Return the ground inside the boundary and outside keep-outs.

    A fence, open at the gates, separates boundaries that touch.
    """
    keep_outs = site.zones_of("keep_out")
    boundaries = [z.polygon for z in site.zones_of("boundary")]
    taken = unary_union([z.polygon for z in keep_outs])
    ground = _fenced(boundaries, site.gates) if boundaries else _endless(site, taken)
    hard = ground.difference(taken) if keep_outs else ground
    return FreeSpace(
        clearance_m=clearance_m,
        bounded=bool(keep_outs or boundaries),
        hard=hard,
        soft=soft_ground(hard, clearance_m),
        keep_outs=keep_outs,
    )


def closed_off(free: FreeSpace, closed: Sequence[ClosedGround]) -> FreeSpace:
    """Return the ground without some that the mission keeps out of, and without a margin of the clearance around that.

    Either is a part of the ground as it was, so that no drive becomes shorter.
    """
    if not closed:
        return free
    taken = unary_union([ground.shape for ground in closed])
    margin = free.clearance_m / math.cos(math.pi / (4 * _CHORDS))
    around = taken.buffer(margin, quad_segs=_CHORDS)
    for give in _GIVE_M:
        if int(shapely.get_num_coordinates(around)) <= _MANY_CORNERS:
            break
        around = taken.buffer(give).simplify(0.9 * give).buffer(margin, join_style="mitre", mitre_limit=2.0)
    return replace(
        free,
        bounded=True,
        hard=free.hard.difference(taken),
        soft=free.soft.difference(around),
        closed=tuple(closed),
    )


def soft_ground(hard: BaseGeometry, clearance_m: float) -> BaseGeometry:
    """Return the ground without a margin of the clearance.

    Ground with very many corners is simplified and shrinks slightly.
    """
    soft = _shrunk(hard, clearance_m)
    for give in _GIVE_M:
        if int(shapely.get_num_coordinates(soft)) <= _MANY_CORNERS:
            break
        # Mitred joins keep a single vertex per corner.
        soft = hard.buffer(-give).simplify(0.9 * give).buffer(-clearance_m, join_style="mitre", mitre_limit=2.0)
    return soft


def _shrunk(ground: BaseGeometry, by: float) -> BaseGeometry:
    """Return the ground without a margin along its edges that is nowhere narrower than ``by``."""
    if by <= 0.0:
        return ground
    return ground.buffer(-by / math.cos(math.pi / (4 * _CHORDS)), quad_segs=_CHORDS)


def _endless(site: Site, taken: BaseGeometry) -> BaseGeometry:
    """Return a rectangle far larger than the site."""
    everything = np.vstack([site.xy, *([p.xy] for p in site.markers.values())])
    (west, south), (east, north) = everything.min(axis=0).tolist(), everything.max(axis=0).tolist()
    if not taken.is_empty:
        w, s, e, n = taken.bounds
        west, south, east, north = min(west, w), min(south, s), max(east, e), max(north, n)
    return box(west - _FAR_M, south - _FAR_M, east + _FAR_M, north + _FAR_M)


def _fenced(boundaries: Sequence[Polygon], gates: Sequence[Gate]) -> BaseGeometry:
    """Return the union of the boundaries, with a fence between touching ones, open at the gates.

    A gate also bridges a gap between two boundaries that were drawn slightly apart.
    """
    ground = unary_union(boundaries)
    openings = unary_union([Point(g.place.xy).buffer(g.width_m / 2.0) for g in gates])
    fences = [f for a, b in itertools.combinations(boundaries, 2) if (f := _fence(a, b)) is not None]
    if fences:
        ground = ground.difference(unary_union(fences).difference(openings).buffer(_FENCE_M, cap_style="flat"))
    bridges = [
        opening
        for opening in (Point(g.place.xy).buffer(g.width_m / 2.0) for g in gates)
        if sum(b.intersects(opening) for b in boundaries) > 1
    ]
    return unary_union([ground, *bridges]) if bridges else ground


def _fence(a: Polygon, b: Polygon) -> BaseGeometry | None:
    """Return the line along which two boundaries touch or barely overlap; None if there is none."""
    if not a.intersects(b):
        return None
    common = a.intersection(b)
    if common.area > _SLIVER_M * common.length / 2.0:
        return None
    if common.area > 0.0:
        common = a.exterior.intersection(common.buffer(TOUCH_M))
    lines = [g for g in getattr(common, "geoms", [common]) if isinstance(g, LineString) and g.length > 0.0]
    return unary_union(lines) if lines else None
