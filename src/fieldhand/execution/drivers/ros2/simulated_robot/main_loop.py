"""Main loop of a simulated robot, in real time or faster."""

from __future__ import annotations

import time
from collections.abc import Callable

from fieldhand.clock import ScaledClock
from fieldhand.execution.drivers.ros2.simulated_robot.robot import SimulatedRobot
from fieldhand.execution.drivers.simulation.state import SimulationState

#: Seconds of the wall clock between two steps, and between two writes of the state.
_STEP_S, _SAVE_S = 0.005, 0.2


def run_robot(
    robot: SimulatedRobot,
    clock: ScaledClock,
    *,
    ended: Callable[[], str | None],
    save: Callable[[SimulationState], None] = lambda _: None,
    steady: Callable[[], float] = time.monotonic,
) -> str:
    """Step a robot until the end is requested.

    Args:
        clock: Clock of the robot.
        ended: Returns the reason to end; None to continue.
        save: Stores the state from which the robot can continue.
        steady: Monotonic clock in seconds.

    Returns:
        The reason why it ended.
    """
    saved_s = -_SAVE_S
    while (why := ended()) is None:
        robot.step()
        if steady() - saved_s >= _SAVE_S:
            save(robot.state())
            saved_s = steady()
        clock.advance(_STEP_S * clock.speed)
    save(robot.state())
    return why
