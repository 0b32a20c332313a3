"""Where a shortest way over open ground can turn: at the ground's corners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry
from shapely.geometry.polygon import orient

from fieldhand.site.driving.graph import Indices, Points


@dataclass(frozen=True, eq=False)
class Corners:
    """Where ways can turn, shape (n, 2) each; ``vertices`` are all vertices of the ground.

    Attributes:
        before, after: The edges that meet at each corner, along the ring.
    """

    at: Points
    before: Points
    after: Points
    vertices: Points

    def touched(self, which: Indices, towards: Points) -> NDArray[np.bool_]:
        """Whether a line from a corner in this direction only touches the obstacle there: a shortest way has no other
        lines at its turns."""
        before, after = -self.before[which], self.after[which]
        return np.asarray(_cross(towards, before) * _cross(towards, after) >= -1e-9)


def corners_of(ground: BaseGeometry) -> Corners:
    """The vertices at which a way can turn: the ground takes more than half a turn there."""
    parts = ground.geoms if isinstance(ground, MultiPolygon) else [ground]
    found = [np.empty((3, 0, 2))]
    vertices = [np.empty((0, 2))]
    for part in parts:
        if not isinstance(part, Polygon) or part.is_empty:
            continue
        turned = orient(part)  # the ground on the left of every ring
        for ring in (turned.exterior, *turned.interiors):
            at = shapely.get_coordinates(ring)[:-1]
            before, after = at - np.roll(at, 1, axis=0), np.roll(at, -1, axis=0) - at
            corner = _cross(before, after) < 0.0
            found.append(np.stack([at, before, after])[:, corner])
            vertices.append(at)
    at, before, after = np.concatenate(found, axis=1)
    return Corners(at, before, after, np.vstack(vertices))


def _cross(one: Points, two: Points) -> Points:
    return np.asarray(one[..., 0] * two[..., 1] - one[..., 1] * two[..., 0])
