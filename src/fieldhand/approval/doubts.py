"""Warnings where a plan is perhaps not what was asked: found from the Task alone, so that none is lost on its way."""

from __future__ import annotations

from collections.abc import Iterator

from fieldhand.approval.problem import Problem
from fieldhand.facts import mismatches
from fieldhand.language import message
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task


def doubts(task: Task, site: Site, robot: RobotProfile) -> Iterator[Problem]:
    """A warning for each that its planner gave with it, and for each certain contradiction with its request."""
    for said in task.command.warnings:
        yield Problem(
            where=message("request"), what=said, advice=message("read every line of the plan"), severity="warning"
        )
    if not task.command.request.strip():
        return  # nothing was asked that a plan could contradict
    for found in mismatches(task, site, robot):
        yield Problem(
            node=found.node,
            where=message("request"),
            what=message("perhaps not what was asked: {doubt}", doubt=found.message),
            advice=message("approve only if it is meant so"),
            severity="warning",
        )
