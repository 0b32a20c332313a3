"""Queries of a Task about recharging."""

from __future__ import annotations

from fieldhand.task.frames import Task
from fieldhand.task.plan import Node, walk


def recharges(task: Task) -> bool:
    """Return True if the robot may or must charge its battery during the mission."""
    return task.constraints.recharge or any(node.recharge is not None for node in walk(task.composition.plan))


def planned_charges(plan: Node) -> float:
    """Return how often a plan charges the battery at most; infinity where the site decides."""
    if plan.recharge is not None:
        return 1.0
    return sum(
        count * (float("inf") if part.times is None else part.times)
        for part in plan.parts
        if (count := planned_charges(part.node))
    )
