"""Lookup of the place of the site that a request means."""

from __future__ import annotations

import numpy as np

from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site

Point = tuple[float, float]


class PlaceLookup:
    """Finds places of a site by name or position.

    Args:
        site: Site of the robot.
        robot: Profile with the stand-off distance from trees.
    """

    def __init__(self, site: Site, robot: RobotProfile) -> None:
        self._site = site
        self._places = (*(tree.place for tree in site.trees), *site.markers.values())
        self._xy = np.array([place.xy for place in self._places])
        self._near_m = max(1.5 * robot.standoff_m, site.spacing_m)

    def named(self, identity: str, kind: str, here: Point) -> Place:
        """Return the place that a request names; without a kind, the name may be a tree's or a marker's.

        Args:
            identity: Name of the place; empty for the nearest.
            kind: ``tree``, ``marker`` or ``point``; empty if the request has none.
            here: Position of the robot, used for points and unknown names.
        """
        if not identity:
            return self.nearest(here)
        tree = self._site.by_id.get(identity)
        if tree is not None and kind in ("", "tree"):
            return tree.place
        marker = self._site.markers.get(identity)
        if marker is not None and kind in ("", "marker"):
            return marker
        return self._point(identity, here)

    def nearest(self, xy: Point) -> Place:
        """Return the nearest tree or marker within reach, otherwise the point itself."""
        away = np.hypot(*(self._xy - np.array(xy)).T)
        nearest = int(np.argmin(away))
        return self._places[nearest] if away[nearest] <= self._near_m else self._point("here", xy)

    def _point(self, identity: str, xy: Point) -> Place:
        ((lat, lon),) = self._site.projection.lat_lon([xy])
        return Place(kind="point", id=identity, x=xy[0], y=xy[1], lat=lat, lon=lon)
