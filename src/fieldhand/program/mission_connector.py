"""Connections of an agent to its robot: one for each mission, opened at its start and closed at its end."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand import missions
from fieldhand.errors import NotApprovedError
from fieldhand.program.review_cache import ReviewCache

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.execution.vehicle import Connection, Vehicle
    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.model import Site
    from fieldhand.task.frames import Task

#: Seconds within which the robot must respond when a mission begins, and when an interrupted one is resumed: in the
#: latter case, it may have been switched on together with its agent.
ANSWERS_WITHIN_S, AWAKE_WITHIN_S = 15.0, 300.0

#: Connects to the robot within a number of seconds, for the duration of the context.
ConnectRobot = Callable[["Site", "RobotProfile", "Task", "Connection", float], AbstractContextManager["Vehicle"]]


@dataclass(frozen=True, kw_only=True)
class _ConnectedRobot:
    """A connection to the robot for one mission.

    Attributes:
        bundle: SHA-256 of the signed mission.
        vehicle: The robot.
        resources: Closes the connection.
    """

    bundle: str
    vehicle: Vehicle
    resources: ExitStack


class MissionConnector:
    """Functions ``check`` and ``carry`` of a mission supervisor, which connect to the robot for each mission.

    Args:
        by: Connection to the robot.
        connect: Connects to it (:func:`fieldhand.execution.drivers.ros2.robot_connection.connected_robot`).
        reviews: Reviews of missions, shared with their reports.
    """

    def __init__(self, by: Connection, connect: ConnectRobot, reviews: ReviewCache | None = None) -> None:
        self._by, self._connect, self._reviews = by, connect, reviews or ReviewCache()
        self._connected: _ConnectedRobot | None = None

    def check(self, bundle: Bundle) -> missions.RobotAtStart:
        """Connect to the robot, and require that a mission can begin: robot on the site, charge enough, no error.

        The connection stays open until the mission is carried out, or another one is checked.

        Raises:
            Ros2Error: The robot does not respond.
            ExecutionError: The robot cannot start from its position.
            NotApprovedError: A check failed, or the charge is not enough.
        """
        self.close()
        task = bundle.authorized.task
        review = self._reviews.review(bundle.authorized, bundle.site, bundle.robot)
        if review.errors:
            raise NotApprovedError("; ".join(str(problem.line()) for problem in review.errors))
        with ExitStack() as stack:
            vehicle = stack.enter_context(self._connect(bundle.site, bundle.robot, task, self._by, ANSWERS_WITHIN_S))
            missions.require_in_place(bundle.site, bundle.robot, vehicle.driver)
            missions.require_charged(review, bundle.site, bundle.robot, vehicle.driver.charge_percent())
            self._connected = _ConnectedRobot(
                bundle=bundle.hashes["bundle"], vehicle=vehicle, resources=stack.pop_all()
            )
        return missions.RobotAtStart(by=self._by, charge_percent=vehicle.charge_percent)

    def carry(self, stored: missions.StoredMission) -> object:
        """Carry out a mission that was checked, or resume an interrupted one.

        Raises:
            Ros2Error: The robot does not respond.
            ExecutionError: The mission was begun in simulation, or the robot cannot start from its position.
            JournalError: As for :func:`fieldhand.missions.carry_out`.
        """
        missions.require_vehicle(stored.id, stored.started_on, simulated=False)
        connected, self._connected = self._connected, None
        with ExitStack() as stack:
            if connected is not None:
                stack.callback(connected.resources.close)
            if connected is None or stored.bundle is None or connected.bundle != stored.bundle.hashes["bundle"]:
                vehicle = stack.enter_context(
                    self._connect(stored.site, stored.robot, stored.authorized.task, self._by, AWAKE_WITHIN_S)
                )
                missions.require_in_place(stored.site, stored.robot, vehicle.driver)
            else:
                vehicle = connected.vehicle
            return missions.carry_out(stored, vehicle=vehicle, emit=lambda _: None)

    def close(self) -> None:
        """Close the connection of a mission that was checked and not carried out."""
        if self._connected is not None:
            self._connected.resources.close()
            self._connected = None
