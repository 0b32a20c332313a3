"""Missions of an agent on a real robot: it is reached when one begins or goes on, and let go at its end."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand import mission, missions
from fieldhand.errors import NotApprovedError

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.execution.vehicle import Connection, Vehicle
    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.model import Site
    from fieldhand.task.frames import Task

#: Seconds within which the robot has to answer when a mission is to begin, and when one that was cut off is to go on:
#: then it may have been switched on with its agent just now.
ANSWERS_WITHIN_S, AWAKE_WITHIN_S = 15.0, 300.0

#: Reaches the robot within so many seconds, for as long as the context lasts.
ConnectRobot = Callable[["Site", "RobotProfile", "Task", "Connection", float], AbstractContextManager["Vehicle"]]


@dataclass(frozen=True, kw_only=True)
class _ConnectedRobot:
    """The robot, reached for one mission.

    Attributes:
        bundle: SHA-256 of the mission.
        let_go: Ends it.
    """

    bundle: str
    vehicle: Vehicle
    let_go: ExitStack


class MissionConnector:
    """Connection to the robot for each mission: ``check`` and ``carry`` of a mission supervisor, one mission at a time.

    Args:
        by: How the robot is reached.
        connect: Reaches it (:func:`fieldhand.execution.drivers.ros2.robot_connection.connected_robot`).
    """

    def __init__(self, by: Connection, connect: ConnectRobot) -> None:
        self._by, self._connect = by, connect
        self._connected: _ConnectedRobot | None = None

    def check(self, bundle: Bundle) -> missions.Departure:
        """See that a mission may begin: the robot answers, stands on the site and has the charge.

        It is held until the mission is carried out, or another is checked.

        Raises:
            Ros2Error: It does not answer.
            ExecutionError, NotApprovedError: It may not set out.
        """
        self.close()
        task = bundle.authorized.task
        review = mission.review(task, bundle.site, bundle.robot)
        if review.errors:
            raise NotApprovedError("; ".join(str(problem.line()) for problem in review.errors))
        with ExitStack() as stack:
            vehicle = stack.enter_context(self._connect(bundle.site, bundle.robot, task, self._by, ANSWERS_WITHIN_S))
            missions.require_in_place(bundle.site, bundle.robot, vehicle.driver)
            missions.require_charged(review, bundle.site, bundle.robot, vehicle.driver.charge_percent())
            self._connected = _ConnectedRobot(bundle=bundle.hashes["bundle"], vehicle=vehicle, let_go=stack.pop_all())
        return missions.Departure(by=self._by, charge_percent=vehicle.charge_percent)

    def carry(self, stored: missions.StoredMission) -> object:
        """Carry a mission out that was checked, or go on with one that was cut off.

        Raises:
            Ros2Error: The robot does not answer.
            ExecutionError: It was begun in simulation, or the robot cannot go on from where it stands.
            JournalError: As :func:`fieldhand.missions.carry_out`.
        """
        missions.require_vehicle(stored.id, stored.departure, simulated=False)
        connected, self._connected = self._connected, None
        with ExitStack() as stack:
            if connected is not None:
                stack.callback(connected.let_go.close)
            if connected is None or stored.bundle is None or connected.bundle != stored.bundle.hashes["bundle"]:
                vehicle = stack.enter_context(
                    self._connect(stored.site, stored.robot, stored.authorized.task, self._by, AWAKE_WITHIN_S)
                )
                missions.require_in_place(stored.site, stored.robot, vehicle.driver)
            else:
                vehicle = connected.vehicle
            return missions.carry_out(stored, vehicle=vehicle, emit=lambda _: None)

    def close(self) -> None:
        """Let go of a robot that was reached for a mission that was not carried out."""
        if self._connected is not None:
            self._connected.let_go.close()
            self._connected = None
