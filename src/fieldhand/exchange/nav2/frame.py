"""The map frame of an export: the robot's own, by the datum of its profile or one that is given."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from fieldhand.errors import InputError
from fieldhand.language import message
from fieldhand.robot.bindings import Datum
from fieldhand.robot.map_datum import degrees_to_map
from fieldhand.robot.model import RobotProfile
from fieldhand.site.projection import Projection

Points = NDArray[np.float64]

#: Greatest distance in metres between the datum and the site: map coordinates are exact to 1 cm up to there.
FAR_M = 5_000.0


@dataclass(frozen=True, kw_only=True)
class MapFrame:
    """The map frame of Nav2 on a site.

    Attributes:
        name: Name of the frame, such as ``map``.
        datum: Position and heading of its origin.
        projection: Projection of the site.
    """

    name: str
    datum: Datum
    projection: Projection

    def points(self, xy: Points) -> Points:
        """Convert points in metres of the site to metres of the map, shape (n, 2)."""
        if not len(xy):
            return np.empty((0, 2))
        return np.array(degrees_to_map(self.datum, self.projection.lat_lon(xy)))

    def shape(self, shape: BaseGeometry) -> BaseGeometry:
        """Convert a shape in metres of the site to metres of the map; its edges stay straight."""
        moved: BaseGeometry = shapely.transform(shape, self.points)
        return moved if moved.is_valid else moved.buffer(0.0)


def map_frame(robot: RobotProfile, projection: Projection, datum: Datum | None = None) -> MapFrame:
    """Return the map frame of a robot on a site.

    Args:
        robot: Profile of the robot.
        projection: Projection of the site.
        datum: Datum in place of that of the profile.

    Raises:
        InputError: There is no datum, or it is far from the site.
    """
    navigation = None if robot.ros2 is None else robot.ros2.navigation
    origin = datum or (None if navigation is None else navigation.datum)
    if origin is None:
        raise InputError(
            message("the profile of {robot} does not state where its map frame lies", robot=robot.name),
            where="--datum",
            advice=message("give latitude and longitude of its origin, as in --datum 37.0711,-120.2583"),
        )
    frame = MapFrame(name="map" if navigation is None else navigation.frame, datum=origin, projection=projection)
    away_m = float(np.hypot(*frame.points(np.zeros((1, 2)))[0]))
    if not away_m <= FAR_M:
        raise InputError(
            message("the origin of the map is {metres} km from the site", metres=f"{away_m / 1000.0:.1f}"),
            where="--datum",
            advice=message("give one within 5 km"),
        )
    return frame
