"""A robot whose thermal camera looks to one side."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable
from dataclasses import replace

from fieldhand.robot.camera import Camera, CameraSide
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.results import Acted, Event
from support.missions.rig import husky, of_type

PICTURE = "take_thermal_picture"
#: Sides as unit vectors, ahead and to the left of the robot.
_SIDES: dict[CameraSide, complex] = {"front": 1, "left": 1j, "back": -1, "right": -1j}


def looking(side: CameraSide, turn_deg_s: float | None, *, robot: RobotProfile | None = None) -> RobotProfile:
    """The husky with a camera on one side; without a speed it does not turn on the spot."""
    robot = husky() if robot is None else robot
    actions = tuple(
        replace(action, camera=Camera(side=side)) if action.name == PICTURE else action for action in robot.actions
    )
    return replace(robot, actions=actions, turn_deg_s=turn_deg_s)


def off_view(site: Site, event: Acted, side: CameraSide) -> float:
    """Degrees between the plant and the middle of the picture, from the robot's position and heading in the log."""
    assert event.robot_lat is not None
    assert event.robot_lon is not None
    assert event.heading_deg is not None
    here, there = (complex(*site.projection.metres(lat, lon)[0]) for lat, lon in
                   ((event.robot_lat, event.robot_lon), (event.lat, event.lon)))  # fmt: skip
    ahead = cmath.rect(1.0, math.radians(90.0 - event.heading_deg))
    return abs(math.degrees(cmath.phase((there - here) / (ahead * _SIDES[side]))))


def pictures(events: Iterable[Event]) -> list[Acted]:
    """The pictures that were taken."""
    return [event for event in of_type(events, Acted) if event.action == PICTURE and event.status == "success"]
