"""Which place of the site is meant."""

from __future__ import annotations

import numpy as np

from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site

Point = tuple[float, float]


class PlaceLookup:
    """Which place of a site is meant.

    Args:
        site: Whose.
        robot: Stands beside the tree that it works on.
    """

    def __init__(self, site: Site, robot: RobotProfile) -> None:
        self._site = site
        self._places = (*(tree.place for tree in site.trees), *site.markers.values())
        self._xy = np.array([place.xy for place in self._places])
        self._near_m = max(1.5 * robot.standoff_m, site.spacing_m)

    def named(self, identity: str, kind: str, here: Point) -> Place:
        """The place that a request names; a name without a kind may be a tree's or a marker's.

        Args:
            identity: Its name; empty means the nearest.
            kind: ``tree``, ``marker`` or ``point``; empty where the request has none.
            here: Where the robot stands: a point has no other position, nor has what the site does not know.
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
        """What the robot would work on there: the nearest tree or marker, or the point itself far from any."""
        away = np.hypot(*(self._xy - np.array(xy)).T)
        nearest = int(np.argmin(away))
        return self._places[nearest] if away[nearest] <= self._near_m else self._point("here", xy)

    def _point(self, identity: str, xy: Point) -> Place:
        lat, lon = self._site.projection.degrees(xy)[0]
        return Place(kind="point", id=identity, x=xy[0], y=xy[1], lat=float(lat), lon=float(lon))
