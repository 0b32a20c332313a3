"""Check the speed limits of a mission against the robot."""

from __future__ import annotations

import math
from collections.abc import Iterator

from fieldhand.approval.problem import PlanProblem
from fieldhand.forecast.slow_ground import slow_speed
from fieldhand.language import message
from fieldhand.language.words import say_number
from fieldhand.robot.model import RobotProfile
from fieldhand.task.frames import Task
from fieldhand.task.plan import walk
from fieldhand.wording.watches import slow_limit_m_s


def speed_problems(task: Task, robot: RobotProfile) -> Iterator[PlanProblem]:
    """Warn of speed limits above the robot's speed, and of those that the robot cannot be told over ROS 2."""
    whole = task.constraints.speed_m_s
    limits = [] if whole is None else [("", whole)]
    limits += [("", slow_speed(slow.speed_m_s, robot)) for slow in task.constraints.slow]
    limits += [("", slow_limit_m_s(w, robot)) for w in task.composition.watches if w.response == "slow"]
    limits += [(node.id, node.pace_m_s) for node in walk(task.composition.plan) if math.isfinite(node.pace_m_s)]
    for node, limit in limits:
        if limit > robot.speed_m_s:
            yield PlanProblem(
                node=node,
                where=message("speed"),
                what=message(
                    "the limit of {limit} m/s has no effect: {robot} drives at most {most} m/s",
                    limit=say_number(limit),
                    robot=robot.name,
                    most=say_number(robot.speed_m_s),
                ),
                severity="warning",
            )
        elif limit < robot.speed_m_s and robot.ros2 is not None and not robot.ros2.navigation.speed_limit:
            yield PlanProblem(
                node=node,
                where=message("speed"),
                what=message(
                    "{robot} accepts no speed limit over ROS 2, so drives at {limit} m/s will fail there",
                    robot=robot.name,
                    limit=say_number(limit),
                ),
                advice=message("name the topic 'navigation.speed_limit' in the robot's profile, or leave it out"),
                severity="warning",
            )
