"""Nav2's navigator as a process: its action server and its lifecycle, which a world can have die and come back."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from fieldhand.execution.drivers.ros2.node_states import ACTIVE, INACTIVE
from fieldhand.execution.drivers.ros2.simulated_robot.action_server import ActionServer
from fieldhand.execution.drivers.ros2.simulated_robot.lifecycle_servers import LifecycleServer
from fieldhand.execution.drivers.ros2.simulated_robot.navigation_server import NavigationServer
from fieldhand.execution.drivers.simulation.world import GoalClicked, GoalUnexplained, NavigatorDies, WorldFault
from fieldhand.site.model import Place


class Navigator:
    """The navigator of a simulated robot.

    Args:
        handler: Carries out its goals.
        serve: Creates its action server.
        lifecycle: Its lifecycle; None for a navigator without one.
        faults: Faults of the world; those of other kinds are ignored.
        tree_of: Returns the tree that a fault names, by its position in ``faults``.
        metres: Returns the metres that the robot has driven.
        now: Returns the time in seconds.
    """

    def __init__(
        self,
        handler: NavigationServer,
        serve: Callable[[], ActionServer],
        lifecycle: LifecycleServer | None,
        faults: Sequence[WorldFault],
        *,
        tree_of: Callable[[int], Place],
        metres: Callable[[], float],
        now: Callable[[], float],
    ) -> None:
        self._handler, self._serve, self._lifecycle = handler, serve, lifecycle
        self._server: ActionServer | None = serve()
        self._faults = [
            (number, fault)
            for number, fault in enumerate(faults)
            if isinstance(fault, GoalClicked | GoalUnexplained | NavigatorDies)
        ]
        self._tree_of, self._metres, self._now = tree_of, metres, now
        self._back_s = self._active_s = math.inf
        self._inactive_s: float | None = None

    def step(self) -> None:
        """Answer requests, and do what the world says is due."""
        now = self._now()
        if now >= self._back_s:
            self._come_back(now)
        if now >= self._active_s and self._lifecycle is not None:
            self._lifecycle.state, self._active_s = ACTIVE, math.inf
        if self._lifecycle is not None:
            self._lifecycle.step()
        self._handler.active = self._lifecycle is None or self._lifecycle.active
        if self._server is not None:
            self._server.step()
        for number, fault in tuple(self._faults):
            if self._metres() >= fault.after_m and self._server is not None and self._handler.driving:
                self._faults.remove((number, fault))
                self._strike(number, fault)

    def _strike(self, number: int, fault: GoalClicked | GoalUnexplained | NavigatorDies) -> None:
        assert self._server is not None  # noqa: S101  callers have one
        match fault:
            case GoalClicked():
                tree = self._tree_of(number)
                self._handler.begin(self._server.adopt(self._handler.goal_to(tree)))
            case GoalUnexplained():
                self._handler.abort_unexplained(fault.times)
            case NavigatorDies():
                self._die(fault)

    def _die(self, fault: NavigatorDies) -> None:
        assert self._server is not None  # noqa: S101  callers have one
        self._handler.die()
        self._server.close()
        self._server = None
        if self._lifecycle is not None:
            self._lifecycle.close()
        self._back_s = math.inf if fault.down_s is None else self._now() + fault.down_s
        self._inactive_s = fault.inactive_s

    def _come_back(self, now: float) -> None:
        self._server, self._back_s = self._serve(), math.inf
        if self._lifecycle is not None:
            self._lifecycle.start(INACTIVE)
            self._active_s = math.inf if self._inactive_s is None else now + self._inactive_s
