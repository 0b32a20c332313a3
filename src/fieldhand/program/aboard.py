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
Board = Callable[["Site", "RobotProfile", "Task", "Connection", float], AbstractContextManager["Vehicle"]]


@dataclass(frozen=True, kw_only=True)
class _Boarded:
    """The robot, reached for one mission.

    Attributes:
        bundle: SHA-256 of the mission.
        let_go: Ends it.
    """

    bundle: str
    vehicle: Vehicle
    let_go: ExitStack


class Aboard:
    """Gives :class:`~fieldhand.delivery.crew.Crew` its ``check`` and its ``carry``. One mission at a time.

    Args:
        by: How the robot is reached.
        board: Reaches it (:func:`fieldhand.execution.drivers.ros2.robot_connection.connected_robot`).
    """

    def __init__(self, by: Connection, board: Board) -> None:
        self._by, self._board = by, board
        self._boarded: _Boarded | None = None

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
            vehicle = stack.enter_context(self._board(bundle.site, bundle.robot, task, self._by, ANSWERS_WITHIN_S))
            missions.require_in_place(bundle.site, bundle.robot, vehicle.driver)
            missions.require_charged(review, bundle.site, bundle.robot, vehicle.driver.charge_percent())
            self._boarded = _Boarded(bundle=bundle.hashes["bundle"], vehicle=vehicle, let_go=stack.pop_all())
        return missions.Departure(by=self._by, charge_percent=vehicle.charge_percent)

    def carry(self, given: missions.Mission) -> object:
        """Carry a mission out that was checked, or go on with one that was cut off.

        Raises:
            Ros2Error: The robot does not answer.
            ExecutionError: It was begun in simulation, or the robot cannot go on from where it stands.
            JournalError: As :func:`fieldhand.missions.carry_out`.
        """
        missions.require_vehicle(given.id, given.departure, simulated=False)
        boarded, self._boarded = self._boarded, None
        with ExitStack() as stack:
            if boarded is not None:
                stack.callback(boarded.let_go.close)
            if boarded is None or given.bundle is None or boarded.bundle != given.bundle.hashes["bundle"]:
                vehicle = stack.enter_context(
                    self._board(given.site, given.robot, given.authorized.task, self._by, AWAKE_WITHIN_S)
                )
                missions.require_in_place(given.site, given.robot, vehicle.driver)
            else:
                vehicle = boarded.vehicle
            return missions.carry_out(given, vehicle=vehicle, emit=lambda _: None)

    def close(self) -> None:
        """Let go of a robot that was reached for a mission that was not carried out."""
        if self._boarded is not None:
            self._boarded.let_go.close()
            self._boarded = None
