"""Checks of work along paths: actions of the right kind, and a tank that suffices."""

from __future__ import annotations

from collections.abc import Iterator

from fieldhand.approval.problem import PlanProblem
from fieldhand.forecast.estimate import Estimate
from fieldhand.forecast.working import amount_of, implement_of
from fieldhand.language import message
from fieldhand.language.words import say_number, say_quantity
from fieldhand.robot.model import RobotProfile
from fieldhand.task.frames import Task
from fieldhand.task.plan import works


def implement_problems(task: Task, robot: RobotProfile) -> Iterator[PlanProblem]:
    """Yield options of work along a path that exclude each other."""
    for node in works(task.composition.plan):
        if node.optional and node.laps > 1:
            yield PlanProblem(
                node=node.id,
                where=message("plan"),
                what=message("work that may be left out in part is done once, not in several laps"),
                advice=message("leave the laps out, or make all of it mandatory"),
            )
        if node.every < 1:
            yield PlanProblem(
                node=node.id,
                where=message("plan"),
                what=message("every {count}th aisle is not possible", count=node.every),
                advice=message("ask for every aisle, every second aisle, ..."),
            )
        lanes = node.heading in ("north_south", "east_west")
        whole_edge = node.mode == "perimeter" and node.sides in ("one", "both")
        no_way = node.mode == "headlands" or whole_edge or lanes != (node.mode == "area")
        if node.heading != "any" and no_way:
            yield PlanProblem(
                node=node.id,
                where=message("plan"),
                what=message("this work has no such direction"),
                advice=message(
                    "lanes of an area run north_south or east_west; rows, aisles and one side of an edge are driven"
                    " north, east, south or west"
                ),
            )
        action = robot.action.get(node.action)
        if (
            node.mode == "area"
            and action is not None
            and (implement_of(node, robot) is None or _no_width(robot, node.action))
        ):
            yield PlanProblem(
                node=node.id,
                where=message("plan"),
                what=message("{action} covers no ground, so no lanes can be laid out", action=node.action),
                advice=message("give its working width in the profile, or work along rows or the edge"),
            )


def _no_width(robot: RobotProfile, action: str) -> bool:
    implement = robot.action[action].implement
    return implement is None or implement.width_m is None


def working_problems(task: Task, robot: RobotProfile, forecast: Estimate) -> Iterator[PlanProblem]:
    """Warn about work that applies more than the tank holds, on the branch with the largest amount."""
    for name in dict.fromkeys(node.action for node in works(task.composition.plan) if node.action):
        implement = robot.action[name].implement
        if implement is None or implement.tank is None:
            continue
        most, unit = 0.0, ""
        for branch in forecast.branches:
            used = 0.0
            for step in branch.walk.steps:
                work = step.node.work
                if work is None or step.stretch is None or work.action != name:
                    continue
                amount = amount_of(work, robot, step.stretch.on_m)
                if amount is not None:
                    used, unit = used + amount.value, amount.unit
            most = max(most, used)
        if most > implement.tank:
            yield PlanProblem(
                where=robot.name,
                what=message(
                    "{action} needs about {amount}, the tank holds {tank}",
                    action=name,
                    amount=say_quantity(float(round(most)), unit),
                    tank=say_quantity(implement.tank, unit),
                ),
                advice=message(
                    "divide the work into {count} missions, and refill in between",
                    count=say_number(float(-(-most // implement.tank))),
                ),
                severity="warning",
            )
