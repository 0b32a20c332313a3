"""Drives between places: straight where nothing is in the way, else the shortest way around keep-outs.

The robot keeps its clearance from keep-outs and stays inside the boundary. Near a place that itself stands closer than
that (a tree beside the pond) the clearance gives way; the keep-out itself never does.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import box
from shapely.ops import unary_union

from fieldhand.errors import DriveFault
from fieldhand.site.ground import XY, Ground
from fieldhand.site.model import Place, Site


@dataclass(frozen=True)
class Drive:
    """A way from one place to another.

    Attributes:
        points: Metres east and north, from the first place to the last; at least two.
        length_m: Metres along the points.
    """

    points: tuple[XY, ...]
    length_m: float

    def at(self, metres: float) -> XY:
        """The point that many metres along the way; its ends for less than nothing and more than its length."""
        left = metres
        for (x0, y0), (x1, y1) in zip(self.points, self.points[1:], strict=False):
            step = float(np.hypot(x1 - x0, y1 - y0))
            if left < step:
                part = max(left, 0.0) / step
                return (x0 + part * (x1 - x0), y0 + part * (y1 - y0))
            left -= step
        return self.points[-1]


class Drives:
    """Ways between the places of one site, remembered.

    Args:
        site: With its keep-outs and boundaries.
        clearance_m: Metres to keep from keep-outs and the boundary: half the robot's width.
    """

    def __init__(self, site: Site, clearance_m: float) -> None:
        self.site = site
        self.clearance_m = clearance_m
        self._ground = _ground(site, clearance_m)
        self._found: dict[tuple[XY, XY], Drive] = {}

    def between(self, a: Place, b: Place) -> Drive:
        """The shortest way from ``a`` to ``b``; from ``b`` to ``a`` it is the same way back.

        Raises:
            DriveFault: One of them lies inside a keep-out or outside the boundary, or there is no way.
        """
        key = (min(a.xy, b.xy), max(a.xy, b.xy))
        if key not in self._found:
            self._found[key] = self._find(a, b, *key)
        drive = self._found[key]
        return drive if a.xy == key[0] else Drive(drive.points[::-1], drive.length_m)

    def lengths(self, places: Sequence[Place]) -> NDArray[np.float64]:
        """Metres of the drive between every two of the places, shape (n, n), symmetric, 0 on the diagonal.

        Raises:
            DriveFault: As :meth:`between`, for any two of them.
        """
        xy = np.array([p.xy for p in places], dtype=np.float64).reshape(-1, 2)
        if self._ground is None or len(places) == 0:
            return np.asarray(np.hypot(*(xy[:, None, :] - xy[None, :, :]).transpose(2, 0, 1)))
        self._check(places)
        lengths = self._ground.lengths(xy)
        if np.isinf(lengths).any():
            i, j = np.argwhere(np.isinf(lengths))[0].tolist()
            raise self._no_way(places[i], places[j])
        return lengths

    def problem(self, place: Place) -> str:
        """Why a place can never be driven to ("inside the keep-out 'pond'"); empty if it can."""
        for zone in self.site.zones_of("keep_out"):
            if shapely.contains_xy(zone.polygon, place.x, place.y):
                return f"inside the keep-out {zone.name!r}"
        boundaries = self.site.zones_of("boundary")
        if boundaries and not any(shapely.intersects_xy(z.polygon, place.x, place.y) for z in boundaries):
            return "outside the boundary"
        return ""

    def _find(self, a: Place, b: Place, one: XY, two: XY) -> Drive:
        self._check((a, b))
        points: tuple[XY, ...] | None = (one, two)
        if self._ground is not None and one != two:
            points = self._ground.way(one, two)
        if points is None:
            raise self._no_way(a, b)
        steps = np.diff(np.array(points), axis=0)
        return Drive(points, float(np.hypot(steps[:, 0], steps[:, 1]).sum()))

    def _check(self, places: Iterable[Place]) -> None:
        for place in places:
            reason = self.problem(place)
            if reason:
                raise DriveFault(
                    f"{_called(place)} is {reason}",
                    where=self.site.name,
                    advice="choose another place, or correct the site",
                )

    def _no_way(self, a: Place, b: Place) -> DriveFault:
        return DriveFault(
            f"there is no way from {_called(a)} to {_called(b)} for a robot {2 * self.clearance_m:g} m wide",
            where=self.site.name,
            advice="keep-outs or the boundary close it off; choose other places",
        )


def _ground(site: Site, clearance_m: float) -> Ground | None:
    """Where a robot may be: inside the boundaries, outside the keep-outs. None where it may be everywhere."""
    keep_outs = [z.polygon for z in site.zones_of("keep_out")]
    boundaries = [z.polygon for z in site.zones_of("boundary")]
    if not keep_outs and not boundaries:
        return None
    if boundaries:
        free = unary_union(boundaries)
    else:  # a frame that is never in the way
        west, south, east, north = unary_union(keep_outs).bounds
        (x0, y0), (x1, y1) = site.xy.min(axis=0).tolist(), site.xy.max(axis=0).tolist()
        far = 50_000.0
        free = box(min(west, x0) - far, min(south, y0) - far, max(east, x1) + far, max(north, y1) + far)
    return Ground(free.difference(unary_union(keep_outs)) if keep_outs else free, clearance_m)


def _called(place: Place) -> str:
    return {"tree": f"tree {place.id}", "marker": f"the {place.id} marker"}.get(place.kind, place.id)
