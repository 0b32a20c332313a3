"""The ground of a site as shapes in the map frame: where no robot may drive, and where it drives slowly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import LineString, Point, box
from shapely.geometry.base import BaseGeometry

from fieldhand.exchange.nav2.frame import MapFrame, Points
from fieldhand.exchange.nav2.grid import MapGrid
from fieldhand.forecast.slow_ground import BESIDE_M, SlowGround
from fieldhand.site.drives import Drives
from fieldhand.site.driving.free_space import free_space
from fieldhand.site.model import Site

#: Distance in metres between the boundary and the edge of the map.
_AROUND_BOUNDARY_M = 1.0

#: Least distance in metres between everything on a site without a boundary and the edge of the map.
_AROUND_M = 10.0


@dataclass(frozen=True, kw_only=True, eq=False)
class MappedGround:
    """The ground of a site in the map frame.

    Attributes:
        bounds: Extent of the map: least x, least y, greatest x, greatest y.
        ground: Ground inside the boundary and outside keep-outs, for a robot of no width; fences are gaps in it.
        walls: Lines through the trees of each row, which no robot crosses, and trees in no row; with a trunk radius,
            polygons.
        closed: Ground that a mission keeps out of.
        slow: Outlines of slow ground, each with its speed limit in m/s.
    """

    bounds: tuple[float, float, float, float]
    ground: BaseGeometry
    walls: BaseGeometry
    closed: BaseGeometry
    slow: tuple[tuple[BaseGeometry, float], ...] = ()


def mapped_ground(drives: Drives, frame: MapFrame, slow: SlowGround, *, trunk_m: float = 0.0) -> MappedGround:
    """Return the ground of a site in the map frame.

    Args:
        drives: Drives of the robot on the site, with the ground that the mission keeps out of.
        frame: The map frame.
        slow: Slow ground of the mission.
        trunk_m: Radius of a trunk in metres, by which walls are widened.
    """
    site = drives.site
    bounds = _bounds(drives, frame)
    west, south, east, north = bounds
    # A little larger than the map, so that its edge is no wall.
    window = box(west - 1.0, south - 1.0, east + 1.0, north + 1.0)
    walls = frame.shape(_walls(site, drives))
    return MappedGround(
        bounds=bounds,
        ground=shapely.intersection(frame.shape(free_space(site, 0.0).hard), window),
        walls=walls.buffer(trunk_m) if trunk_m > 0.0 else walls,
        closed=frame.shape(shapely.union_all([one.shape for one in drives.closed])),
        slow=tuple((frame.shape(shape.buffer(BESIDE_M)), speed) for shape, speed in slow.grounds),
    )


def occupied(ground: MappedGround, grid: MapGrid) -> np.ndarray:
    """Return the cells on which no robot may drive: off the ground, on its edge, and on walls."""
    cells = ~grid.with_centre_in(ground.ground)
    cells |= grid.touched(ground.ground)
    cells |= grid.covered(ground.walls)
    return cells


def _bounds(drives: Drives, frame: MapFrame) -> tuple[float, float, float, float]:
    """Return the extent of the map of a site: the boundary, or everything on the site with room to drive around it."""
    site = drives.site
    boundaries = [shapely.get_coordinates(zone.polygon) for zone in site.zones_of("boundary")]
    around = _AROUND_BOUNDARY_M if boundaries else max(_AROUND_M, 3.0 * (drives.standoff_m + 2.0 * drives.clearance_m))
    shown: list[Points] = boundaries or [
        site.xy,
        *(shapely.get_coordinates(zone.polygon) for zone in site.zones),
        *(np.array([place.xy]) for place in site.markers.values()),
        *(np.array([gate.place.xy]) for gate in site.gates),
    ]
    at = frame.points(np.concatenate(shown))
    (west, south), (east, north) = (at.min(axis=0) - around).tolist(), (at.max(axis=0) + around).tolist()
    return (west, south, east, north)


def _walls(site: Site, drives: Drives) -> BaseGeometry:
    """Return the lines of the rows, and the other trees as points."""
    lines: list[BaseGeometry] = []
    for group in drives.layout.aisles.groups:
        for line in group.lines:
            trees = np.concatenate([site.planting.rows[row].trees for row in line.rows])
            lines.append(LineString(site.xy[trees]) if len(trees) > 1 else Point(site.xy[trees[0]]))
    lines.extend(Point(xy) for xy in lone_trees(drives))
    return shapely.geometrycollections(lines)


def lone_trees(drives: Drives) -> Points:
    """Return the trees in no row, in metres of the site, shape (n, 2); none on a site without rows, where the robot
    stands at a tree itself."""
    site = drives.site
    return site.xy[site.planting.row_of < 0] if drives.layout.aisles.groups else np.empty((0, 2))
