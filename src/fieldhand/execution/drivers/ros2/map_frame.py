"""Points in the robot's map frame, and poses as ROS messages."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Callable, Generator, Sequence

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.protocol import DriveGoal
from fieldhand.execution.drivers.ros2.message_fields import number_at
from fieldhand.execution.drivers.ros2.service_call import TimeLimit, call_service
from fieldhand.execution.drivers.ros2.transport import Client, RosMessage
from fieldhand.robot.bindings import FieldBinding
from fieldhand.robot.map_datum import degrees_to_map as degrees_to_map
from fieldhand.robot.map_datum import map_to_degrees as map_to_degrees
from fieldhand.site.bearings import ahead_of

Point = tuple[float, float]

#: Tolerated deviation of a leg's length in the robot's map: a fraction, for scaled maps, and metres.
_SCALE, _SLACK_M = 0.01, 0.25

#: Length in metres of the shortest leg from which the rotation of the map can be computed.
_TURN_M = 1.0

#: Metres to the corner that gives a heading its yaw in the map; metres of a degree of latitude.
_AIM_M, _DEGREE_M = 5.0, 111_200.0
#: Squared length below which a quaternion was not filled in.
_NO_QUATERNION = 0.5

_X, _Y = FieldBinding(path="map_point.x"), FieldBinding(path="map_point.y")


def query_map_points(
    client: Client, name: str, goal: DriveGoal, limit: TimeLimit, steady: Callable[[], float]
) -> Generator[None, None, tuple[Point, ...]]:
    """Query the robot's own service (``robot_localization/srv/FromLL``) for the map coordinates of a drive's corners.

    Raises:
        Ros2Error: The service does not answer, or its points do not fit the path: before it is ready it returns 0, 0.
    """
    requests = [{"ll_point": {"latitude": lat, "longitude": lon, "altitude": 0.0}} for lat, lon in goal.path_degrees]
    replies = yield from call_service(client, name, requests, limit, steady)
    points: list[Point] = []
    for reply in replies:
        x, y = number_at(reply, _X), number_at(reply, _Y)
        if x is None or y is None:
            raise Ros2Error(
                f"{name} returned no point", advice="check whether navsat_transform knows the robot's datum"
            )
        points.append((x, y))
    legs = zip(itertools.pairwise(points), itertools.pairwise(goal.path_m), strict=True)
    for (a, b), (here, there) in legs:
        long_m, wanted_m = math.dist(a, b), math.dist(here, there)
        if abs(long_m - wanted_m) > _SCALE * wanted_m + _SLACK_M:
            raise Ros2Error(
                f"{name} returns {long_m:.1f} m for a leg of {wanted_m:.1f} m: its points do not fit the path",
                advice="check whether navsat_transform knows the robot's datum",
            )
    return tuple(points)


def site_to_map(path_m: Sequence[Point], points: Sequence[Point]) -> Callable[[Point], Point] | None:
    """Return the transformation from site to map coordinates, fitted to one path known in both.

    Args:
        path_m: Corners in metres of the site.
        points: The same corners in the map.

    Returns:
        None if the path is too short to compute the rotation.
    """
    legs = zip(itertools.pairwise(path_m), itertools.pairwise(points), strict=True)
    (here, there), (a, b) = max(legs, key=lambda leg: math.dist(*leg[0]))
    if math.dist(here, there) < _TURN_M:
        return None
    turn = yaw_of(a, b) - yaw_of(here, there)
    sin, cos = math.sin(turn), math.cos(turn)

    def placed(point: Point) -> Point:
        east, north = point[0] - here[0], point[1] - here[1]
        return a[0] + cos * east - sin * north, a[1] + sin * east + cos * north

    return placed


def yaw_of(here: Point, there: Point) -> float:
    """Return the yaw of a leg in radians, from the x axis towards the y axis."""
    return math.atan2(there[1] - here[1], there[0] - here[0])


def orientation(yaw: float) -> RosMessage:
    """Return a ``geometry_msgs/msg/Quaternion`` for a yaw in radians."""
    return {"x": 0.0, "y": 0.0, "z": math.sin(yaw / 2.0), "w": math.cos(yaw / 2.0)}


def yaw_in(message: RosMessage, path: str) -> float | None:
    """Return the yaw in radians of the quaternion at a path of a message; None if there is none."""
    x, y, z, w = (number_at(message, FieldBinding(path=f"{path}.{part}")) for part in "xyzw")
    if x is None or y is None or z is None or w is None or x * x + y * y + z * z + w * w < _NO_QUATERNION:
        return None
    return math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)


def aimed(goal: DriveGoal, heading_deg: float) -> DriveGoal:
    """Return a drive with one corner more, ahead of its end in a heading (degrees clockwise from true north).

    The map is rotated against true north by an angle that only the robot may know: the yaw of the heading in the map is
    that of the leg to this corner.
    """
    lat, lon = goal.path_degrees[-1]
    east, north = ahead_of((0.0, 0.0), heading_deg, _AIM_M)
    degrees = lat + north / _DEGREE_M, lon + east / (_DEGREE_M * math.cos(math.radians(lat)))
    there = ahead_of(goal.path_m[-1], heading_deg, _AIM_M)
    return dataclasses.replace(goal, path_m=(*goal.path_m, there), path_degrees=(*goal.path_degrees, degrees))


def pose(frame: str, here: Point, there: Point, yaw: float | None = None) -> RosMessage:
    """Return a ``geometry_msgs/msg/PoseStamped`` at the end of a leg, facing along it unless a yaw is given.

    Its stamp stays 0, which selects the newest transform: the clocks of robot and computer need not agree.
    """
    position = {"x": there[0], "y": there[1], "z": 0.0}
    return {
        "header": {"frame_id": frame},
        "pose": {"position": position, "orientation": orientation(yaw_of(here, there) if yaw is None else yaw)},
    }


def geographic_pose(degrees: Point, yaw: float) -> RosMessage:
    """Return a ``geographic_msgs/msg/GeoPose``."""
    position = {"latitude": degrees[0], "longitude": degrees[1], "altitude": 0.0}
    return {"position": position, "orientation": orientation(yaw)}
