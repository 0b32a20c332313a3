"""Warnings where a plan may differ from its request, derived from the Task alone so that they are always reproduced."""

from __future__ import annotations

from collections.abc import Iterator

from fieldhand.approval.problem import PlanProblem
from fieldhand.language import message
from fieldhand.request_check import mismatches
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task


def request_warnings(task: Task, site: Site, robot: RobotProfile) -> Iterator[PlanProblem]:
    """Yield the warnings that the planner attached to the Task and every detected contradiction with the request."""
    for warning in task.command.warnings:
        yield PlanProblem(
            where=message("request"), what=warning, advice=message("read every line of the plan"), severity="warning"
        )
    if not task.command.request.strip():
        return  # without a request there is nothing to contradict
    for found in mismatches(task, site, robot):
        yield PlanProblem(
            node=found.node,
            where=message("request"),
            what=message("this may not be what was asked: {doubt}", doubt=found.what),
            advice=message("approve only if this is what you want"),
            severity="warning",
        )
