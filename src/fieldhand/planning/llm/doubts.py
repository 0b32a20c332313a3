"""Where a model's plan contradicts what the request says: problems for the model, then warnings for a person."""

from __future__ import annotations

from fieldhand.planning.facts import mismatches
from fieldhand.planning.llm.review import Problem
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.codec import Draft
from fieldhand.task.frames import Task
from fieldhand.task.plan import walk


def doubts(task: Task, draft: Draft, site: Site, robot: RobotProfile) -> tuple[Problem, ...]:
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


def warning_of(doubt: Problem) -> str:
    """A doubt as the sentence that an operator reads before approving."""
    return f"Perhaps not what was asked: {doubt.message}."
