"""The two drivers of ROS 2 as entry points of the group ``fieldhand.drivers``."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from fieldhand.execution.drivers.registry import DriverKind, Presence
from fieldhand.execution.vehicle import Connection, Vehicle

if TYPE_CHECKING:
    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.model import Site
    from fieldhand.task.frames import Task


@contextmanager
def _connect(site: Site, robot: RobotProfile, task: Task, by: Connection, within_s: float) -> Iterator[Vehicle]:
    from fieldhand.execution.drivers.ros2.robot_connection import connected_robot

    with connected_robot(site, robot, task, by, within_s) as vehicle:
        yield vehicle


def _watch(robot: RobotProfile, by: Connection) -> Presence:
    from fieldhand.execution.drivers.ros2.robot_connection import RobotPresence, effective_bindings, open_node

    bindings = effective_bindings(robot, by)
    return RobotPresence(open_node(by, bindings)[0], bindings)


DDS = DriverKind(connect=_connect, summary="ROS 2 over Cyclone DDS; needs no ROS here", ros2=True, watch=_watch)
RCLPY = DriverKind(connect=_connect, summary="ROS 2 by rclpy; needs a sourced ROS here", ros2=True, watch=_watch)
