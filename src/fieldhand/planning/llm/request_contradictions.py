"""Contradictions between a model's plan and the request, reported to the model as problems.

Contradictions that the model does not correct are found again in approval, where a person must confirm them.
"""

from __future__ import annotations

from fieldhand.planning.llm.review import AnswerProblem
from fieldhand.request_check import mismatches
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.codec import TaskDraft
from fieldhand.task.frames import Task
from fieldhand.task.plan import walk


def request_contradictions(task: Task, draft: TaskDraft, site: Site, robot: RobotProfile) -> tuple[AnswerProblem, ...]:
    """Return every certain contradiction between a Task and its request.

    Args:
        task: Task made from the draft, with its nodes in the same order.
        draft: Draft whose node ids give the positions in the model's document.
    """
    places = dict(zip((n.id for n in walk(task.composition.plan)), (n.id for n in walk(draft.plan)), strict=True))
    return tuple(
        AnswerProblem(kind="request", message=found.what, where=places.get(found.node, ""))
        for found in mismatches(task, site, robot)
    )
