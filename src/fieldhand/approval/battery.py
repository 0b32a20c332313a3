"""Check the remaining charge of a mission against the robot's battery thresholds."""

from __future__ import annotations

from collections.abc import Iterator

from fieldhand.approval.problem import PlanProblem
from fieldhand.forecast.resource_limits import reserve_percent
from fieldhand.language import message
from fieldhand.language.words import say_number
from fieldhand.robot.model import RobotProfile
from fieldhand.task.frames import Task


def battery_problems(task: Task, robot: RobotProfile) -> Iterator[PlanProblem]:
    """Report a reserve at or below the charge at which the robot stops: it could not drive home with that reserve."""
    reserve, stop = reserve_percent(task.constraints, robot), robot.energy.stop_percent
    if stop is not None and stop > 0.0 and reserve <= stop:
        yield PlanProblem(
            where=message("battery"),
            what=message(
                "the mission leaves only {reserve} % charge, but {robot} stops on the spot at {stop} %",
                reserve=say_number(reserve),
                robot=robot.name,
                stop=say_number(stop),
            ),
            advice=message("set a larger reserve"),
        )
