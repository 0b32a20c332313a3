"""Check the charge that a Task leaves against the levels at which its robot acts."""

from __future__ import annotations

from collections.abc import Iterator

from fieldhand.approval.problem import Problem
from fieldhand.forecast.resource_limits import reserve_percent
from fieldhand.language import message
from fieldhand.language.words import say_number
from fieldhand.robot.model import RobotProfile
from fieldhand.task.frames import Task


def battery_problems(task: Task, robot: RobotProfile) -> Iterator[Problem]:
    """Find a reserve below the charge at which the robot stops where it stands: it would never come home with that."""
    reserve, stop = reserve_percent(task.constraints, robot), robot.energy.stop_percent
    if stop is not None and stop > 0.0 and reserve <= stop:
        yield Problem(
            where=message("battery"),
            what=message(
                "the mission leaves {reserve} % charge, and {robot} stops where it stands at {stop} %",
                reserve=say_number(reserve),
                robot=robot.name,
                stop=say_number(stop),
            ),
            advice=message("leave more than that"),
        )
