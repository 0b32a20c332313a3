"""The planned path of a mission in the map frame, as the YAML of a ``nav_msgs/msg/Path``."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping

import numpy as np

from fieldhand.errors import InputError
from fieldhand.exchange.nav2.frame import MapFrame, Points
from fieldhand.exchange.routes.route import ExportedRoute
from fieldhand.language import message
from fieldhand.language.words import say_number
from fieldhand.robot.map_datum import degrees_to_map

#: Greatest distance in metres between two poses, as controllers expect it.
_STEP_M = 0.25

#: Greatest number of poses: 50 km.
MOST_POSES = 200_000

#: Legs shorter than this, in metres, have no direction.
_NO_LEG_M = 1e-3


def write_path(route: ExportedRoute, frame: MapFrame) -> bytes:
    """Return the ways of a route as poses that face along them, and at a stop as the robot stands there.

    Raises:
        InputError: The route is too long, or the robot does not move.
    """
    corners, yaws = _corners(route, frame)
    poses = _poses(corners, yaws)
    if len(poses) < 2:
        raise InputError(
            message("the mission has no path: the robot does not move"),
            where="--task",
            advice=message("leave it out, or give another Task"),
        )
    name = _quoted(frame.name)
    lines = [f"header: {{frame_id: {name}}}", "poses:"]
    for x, y, yaw in poses:
        position = f"{{x: {x:.3f}, y: {y:.3f}, z: 0.0}}"
        orientation = f"{{x: 0.0, y: 0.0, z: {math.sin(yaw / 2.0):.6f}, w: {math.cos(yaw / 2.0):.6f}}}"
        lines.append(f"- header: {{frame_id: {name}}}")
        lines.append(f"  pose: {{position: {position}, orientation: {orientation}}}")
    return ("\n".join(lines) + "\n").encode()


def _quoted(name: str) -> str:
    return "'" + name.replace("'", "''") + "'"


def _corners(route: ExportedRoute, frame: MapFrame) -> tuple[Points, dict[int, float]]:
    """Return the corners of all ways in metres of the map, without repeated ones, and the yaw at the stops."""
    degrees = [point for stop in route.stops for point in stop.way]
    if not degrees:
        return np.empty((0, 2)), {}
    at = np.array(degrees_to_map(frame.datum, degrees))
    kept = np.concatenate([[True], np.hypot(*np.diff(at, axis=0).T) > _NO_LEG_M])
    numbers = np.cumsum(kept) - 1
    ends = np.cumsum([len(stop.way) for stop in route.stops]) - 1
    return np.asarray(at[kept]), {
        int(numbers[end]): math.radians(frame.datum.heading_deg - stop.heading_deg)
        for stop, end in zip(route.stops, ends.tolist(), strict=True)
        if stop.way and stop.heading_deg is not None
    }


def _poses(corners: Points, yaws: Mapping[int, float]) -> list[tuple[float, float, float]]:
    """Return x, y and yaw along a path; at a corner the robot faces along the way to it, unless a yaw is given.

    Raises:
        InputError: The path is too long.
    """
    metres = sum(math.dist(a, b) for a, b in itertools.pairwise(corners.tolist()))
    if metres / _STEP_M + len(corners) > MOST_POSES:
        raise InputError(
            message("a path of {length} km is too long", length=say_number(round(metres / 1000.0, 1))),
            where="--task",
            advice=message("leave it out, or give a shorter mission"),
        )
    poses: list[tuple[float, float, float]] = []
    for number, ((x0, y0), (x1, y1)) in enumerate(itertools.pairwise(corners.tolist()), start=1):
        yaw, steps = math.atan2(y1 - y0, x1 - x0), max(1, math.ceil(math.dist((x0, y0), (x1, y1)) / _STEP_M))
        shares = [k / steps for k in range(1 if poses else 0, steps + 1)]
        poses.extend((x0 + (x1 - x0) * share, y0 + (y1 - y0) * share, yaw) for share in shares)
        poses[-1] = (*poses[-1][:2], yaws.get(number, yaw))
    return poses
