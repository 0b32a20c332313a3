"""A simulated robot in real time, or faster: stepped again and again, its state written beside."""

from __future__ import annotations

import time
from collections.abc import Callable

from fieldhand.clock import ScaledClock
from fieldhand.execution.drivers.ros2.simulated_robot.robot import SimulatedRobot
from fieldhand.execution.drivers.simulation_state import SimulationState

#: Seconds of the wall clock between two steps, and between two times that the state is written.
_STEP_S, _SAVE_S = 0.005, 0.2


def run_robot(
    robot: SimulatedRobot,
    clock: ScaledClock,
    *,
    ended: Callable[[], str | None],
    save: Callable[[SimulationState], None] = lambda _: None,
    steady: Callable[[], float] = time.monotonic,
) -> str:
    """Let a robot live until it is told to end.

    Args:
        clock: The robot's.
        ended: Why it is to end, once it is.
        save: Keeps what it needs to go on later.
        steady: Seconds of the wall clock.

    Returns:
        Why it ended.
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
