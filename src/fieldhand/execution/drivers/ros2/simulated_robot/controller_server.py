"""Nav2's controller: serves ``follow_path``, and follows its last path on where the navigator has died."""

from __future__ import annotations

from collections.abc import Callable

from fieldhand.execution.drivers.protocol import Progress
from fieldhand.execution.drivers.ros2.simulated_robot.action_server import ActionServer, GoalHandler, ServerGoal
from fieldhand.execution.drivers.ros2.simulated_robot.robot_platform import SimulatedPlatform
from fieldhand.execution.drivers.ros2.transport import RosMessage


class ControllerServer:
    """A :class:`GoalHandler` for paths: those that the navigator has it follow, and those of other clients.

    Args:
        platform: The vehicle.
        paths: Carries out the paths of other clients.
        report: Called with the progress of a path of the navigator that was cancelled.

    Attributes:
        server: Its action server; set by its owner.
    """

    def __init__(
        self, platform: SimulatedPlatform, paths: GoalHandler, report: Callable[[str, Progress], None]
    ) -> None:
        self.server: ActionServer | None = None
        self._platform, self._paths, self._report = platform, paths, report
        self._goal: ServerGoal | None = None
        self._stopped: Callable[[], None] | None = None

    def follow(self, stopped: Callable[[], None]) -> None:
        """Note that the vehicle follows a path of the navigator.

        Args:
            stopped: Called if another client cancels it.
        """
        assert self.server is not None  # noqa: S101  set by its owner
        self._goal, self._stopped = self.server.adopt(), stopped

    def done(self, *, succeeded: bool) -> None:
        """Note that the path has ended."""
        goal, self._goal = self._goal, None
        if goal is not None:
            (goal.succeeded if succeeded else goal.aborted)({})

    def leave(self) -> None:
        """Note that the navigator has died: the path is followed on."""
        self._stopped = None

    def rejection_reason(self, goal: RosMessage) -> str | None:
        if self._goal is not None:
            return "the robot follows a path of its navigator"
        return self._paths.rejection_reason(goal)

    def begin(self, goal: ServerGoal) -> None:
        """Start a path of another client."""
        self._paths.begin(goal)

    def cancel(self, goal: ServerGoal) -> None:
        """Cancel a path; one of the navigator ends its goal, too."""
        if goal is not self._goal:
            self._paths.cancel(goal)
            return
        self._goal, stopped = None, self._stopped
        self._report("cancelled", self._platform.stop_now())
        goal.cancelled({})
        if stopped is not None:
            stopped()
