"""Check the conditions that a mission watches: that they can be detected, and that their responses can be given."""

from __future__ import annotations

from collections.abc import Iterator

from fieldhand.approval.problem import PlanProblem
from fieldhand.language import message
from fieldhand.language.words import listed, say_action, say_name
from fieldhand.robot.model import RobotProfile
from fieldhand.task.frames import Task
from fieldhand.task.plan import actions_of, acts, walk
from fieldhand.task.watches import ReadingBeyond, Watch
from fieldhand.wording.watches import say_watched


def watch_problems(task: Task, robot: RobotProfile) -> Iterator[PlanProblem]:
    """Yield the problems of a Task's watches."""
    loops = any(node.visits_each for node in walk(task.composition.plan))
    for watch in task.composition.watches:
        what = say_watched(watch, robot)
        if not loops and {watch.response, watch.fallback if watch.response == "wait" else ""} & {"skip", "skip_row"}:
            yield _problem(
                message("“{what}” is to leave out a visit, and the plan has no list of visits", what=what),
                message("let it wait, go home or end, or visit the places in a for-each"),
            )
        done = actions_of(task.composition.plan)
        if watch.during and watch.during not in done:
            yield _problem(
                message(
                    "“{what}” is to be noticed only in the steps to {action}, and the plan has none",
                    what=what,
                    action=say_action(watch.during),
                ),
                message("watch it during an action of the plan, or at any time"),
            )
        if isinstance(watch.condition, ReadingBeyond):
            yield from _of_reading(task, watch, watch.condition, what, robot)


def _of_reading(
    task: Task, watch: Watch, condition: ReadingBeyond, what: str, robot: RobotProfile
) -> Iterator[PlanProblem]:
    if watch.response == "wait":
        yield _problem(
            message("“{what}” is to be waited out, but nothing is read while the robot waits", what=what),
            message("let it go home, end, or leave out the visit"),
        )
    able = [action.name for action in robot.actions if condition.quantity in action.measures]
    if not any(act.action in able for act in acts(task.composition.plan)):
        yield _problem(
            message(
                "“{what}” is to be noticed, but the mission never reads the {quantity}",
                what=what,
                quantity=say_name(condition.quantity),
            ),
            message("let it {actions} at some places", actions=listed([say_name(name) for name in able], "or")),
        )


def _problem(what: str, advice: str) -> PlanProblem:
    return PlanProblem(where=message("watches"), what=what, advice=advice)
