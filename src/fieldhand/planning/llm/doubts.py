"""Where a model's plan contradicts what the request says: problems for the model.

What it does not mend, approval finds again, and a person has to confirm it.
"""

from __future__ import annotations

from fieldhand.facts import mismatches
from fieldhand.planning.llm.review import Problem
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.codec import TaskDraft
from fieldhand.task.frames import Task
from fieldhand.task.plan import walk


def doubts(task: Task, draft: TaskDraft, site: Site, robot: RobotProfile) -> tuple[Problem, ...]:
    """Every certain contradiction between a Task and its request.

    Args:
        task: Made from the draft; its nodes stand in the same order.
        draft: Its ids say where in the model's document a node stands.
    """
    places = dict(zip((n.id for n in walk(task.composition.plan)), (n.id for n in walk(draft.plan)), strict=True))
    return tuple(
        Problem(kind="request", message=found.message, where=places.get(found.node, ""))
        for found in mismatches(task, site, robot)
    )
