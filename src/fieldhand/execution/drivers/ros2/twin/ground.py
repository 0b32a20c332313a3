"""Where things are: the map frame of the robot, and which place of the site is meant."""

from __future__ import annotations

import math

import numpy as np

from fieldhand.robot.bindings import Datum
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.site.projection import Projection

Point = tuple[float, float]


class MapFrame:
    """A plane through a point of the earth: metres along its x axis and, to the left of that, its y axis.

    Args:
        datum: Its origin.
    """

    def __init__(self, datum: Datum) -> None:
        self.datum = datum
        self._projection = Projection(datum.lat, datum.lon)

    def of(self, lat: float, lon: float) -> Point:
        """Degrees to x and y."""
        east, north = self._projection.metres(lat, lon)[0]
        sine, cosine = self._turn()
        return float(cosine * east + sine * north), float(cosine * north - sine * east)

    def degrees(self, x: float, y: float) -> tuple[float, float]:
        """X and y to latitude and longitude."""
        sine, cosine = self._turn()
        lat, lon = self._projection.degrees((cosine * x - sine * y, cosine * y + sine * x))[0]
        return float(lat), float(lon)

    def yaw(self, heading_deg: float) -> float:
        """A heading, clockwise from north, to an angle counted from the x axis to the left, in radians."""
        return math.radians(self.datum.heading_deg - heading_deg)

    def _turn(self) -> tuple[float, float]:
        """Of the x axis from east to the left."""
        turned = math.radians(90.0 - self.datum.heading_deg)
        return math.sin(turned), math.cos(turned)


class Places:
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
