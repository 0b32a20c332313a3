"""Connecting to a robot over ROS 2 for a mission, and watching whether it is present."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import replace

from fieldhand.clock import Clock, ScaledClock, SystemWallClock
from fieldhand.errors import ProfileError
from fieldhand.execution.drivers.ros2 import ros_clock
from fieldhand.execution.drivers.ros2.driver import READY_WITHIN_S, Ros2Driver
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.open_transport import open_transport
from fieldhand.execution.drivers.ros2.release import sourced_release, wait_for_release
from fieldhand.execution.drivers.ros2.ros_clock import RosClock
from fieldhand.execution.drivers.ros2.transport import Transport
from fieldhand.execution.vehicle import Connection, Vehicle
from fieldhand.language import message
from fieldhand.robot.bindings import Ros2Bindings
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task
from fieldhand.task.plan import actions_of
from fieldhand.task.recharging import recharges
from fieldhand.task.watches import watched_events

#: Least time in seconds for a robot to become ready after its release was heard, or was not.
_LEAST_S = 3.0


def effective_bindings(robot: RobotProfile, by: Connection) -> Ros2Bindings:
    """Return the profile's ROS 2 bindings with the connection's overrides.

    Raises:
        ProfileError: The profile has no ROS 2 part.
    """
    if robot.ros2 is None:
        raise ProfileError(
            message("the profile of {name} does not define how the robot is reached over ROS 2", name=robot.name),
            where=robot.source,
            advice=message("add a ros2 section (docs/formats.md), or run the mission in simulation"),
        )
    namespace = robot.ros2.namespace if by.namespace is None else by.namespace
    return replace(robot.ros2, namespace=namespace, use_sim_time=robot.ros2.use_sim_time or by.sim_time)


def with_release(bindings: Ros2Bindings, on: str, domain: int | None, within_s: float) -> Ros2Bindings:
    """Return the bindings with the robot's release: the profile's, else the one that is sourced for rclpy, else the one
    that is heard. They are unchanged if no navigation is heard.

    Args:
        on: Name of the transport.
        domain: ROS domain id; None for that of the environment.
        within_s: Seconds to wait for the robot.

    Raises:
        InputError: A required package is not installed.
        Ros2Error: The network cannot be used, or the robot has no known release.
    """
    if bindings.distro is not None:
        return bindings
    if on == "rclpy" and (sourced := sourced_release()) is not None:
        return replace(bindings, distro=sourced)
    with closing(open_transport(on, Interfaces({}), domain)) as node:
        heard = wait_for_release(node, bindings, within_s=within_s, steady=time.monotonic, sleep=time.sleep)
    return replace(bindings, distro=heard)


def open_node(by: Connection, bindings: Ros2Bindings) -> tuple[Transport, Interfaces]:
    """Open a node in the robot's graph and load its types.

    Raises:
        InputError: A required package is not installed.
        ProfileError: An interface definition of the profile cannot be parsed.
        Ros2Error: The network cannot be used.
    """
    interfaces = Interfaces.of(bindings.release, bindings.interfaces)
    return open_transport(by.transport, interfaces, by.domain), interfaces


@contextmanager
def connected_robot(
    site: Site, robot: RobotProfile, task: Task, by: Connection, within_s: float = READY_WITHIN_S
) -> Iterator[Vehicle]:
    """Connect to the robot for the duration of the context; goals left over from earlier missions are cancelled.

    Args:
        site: Site of the mission; positions are in its local metres.
        robot: Profile of the robot.
        task: Task of the mission; all actions it needs must be available.
        by: Transport, domain and namespace.
        within_s: Seconds of the wall clock within which the whole robot must respond.

    Raises:
        ProfileError: The profile has no ROS 2 part.
        InputError: A required package is not installed.
        Ros2Error: The robot does not respond, or not as its profile says; every problem is named.
    """
    begun_s = time.monotonic()
    bindings = with_release(effective_bindings(robot, by), by.transport, by.domain, within_s)
    within_s = max(within_s - (time.monotonic() - begun_s), min(within_s, _LEAST_S))
    transport, interfaces = open_node(by, bindings)
    driver: Ros2Driver | None = None
    try:
        clock: Clock = RosClock.wait_for_first(transport, within_s) if bindings.use_sim_time else ScaledClock()
        driver = Ros2Driver.connect(
            transport,
            interfaces,
            site,
            replace(robot, ros2=bindings),
            clock=clock,
            within_s=within_s,
            actions=needed_actions(task, robot),
            events=watched_events(task.composition.watches),
        )
        yield Vehicle(
            driver=driver,
            clock=clock,
            charge_percent=driver.charge_percent(),
            # The time of day is meaningless in a simulation that runs at its own pace.
            wall=None if bindings.use_sim_time else SystemWallClock(),
            by=by,
            remark="" if bindings.use_sim_time else ros_clock.unused_clock_remark(transport),
        )
    finally:
        if driver is not None:
            driver.leave()
        transport.close()


def needed_actions(task: Task, robot: RobotProfile) -> set[str]:
    """Return the names of everything that the robot has to do, at places and along paths."""
    charging = robot.energy.charging if recharges(task) else None
    docking = set() if charging is None else {action.name for action in charging.maneuvers}
    return {name for name in actions_of(task.composition.plan) if name} | docking


class RobotPresence:
    """Presence of a robot, derived from discovery; sends nothing. Thread-safe.

    Args:
        transport: Open transport; closed by :meth:`close`.
        bindings: ROS 2 bindings of the robot.
    """

    def __init__(self, transport: Transport, bindings: Ros2Bindings) -> None:
        self._transport, self._bindings = transport, bindings
        self._guard = threading.Lock()

    def missing(self) -> tuple[str, ...]:
        """Return the parts of the robot that are missing now, in words."""
        bindings, whole = self._bindings, self._bindings.whole_name
        topics = {"position": whole(bindings.position.fix.topic), "battery": whole(bindings.battery.topic.topic)}
        if bindings.use_sim_time:
            topics["its time"] = ros_clock.TOPIC
        navigation = whole(bindings.navigation.action)
        with self._guard:
            missing = (
                [] if self._transport.servers_of(f"{navigation}/_action/send_goal") else [("navigation", navigation)]
            )
            missing += [(what, topic) for what, topic in topics.items() if not self._transport.writers_of(topic)]
        return tuple(f"{what} ({name})" for what, name in missing)

    def close(self) -> None:
        """Leave the ROS graph."""
        with self._guard:
            self._transport.close()
