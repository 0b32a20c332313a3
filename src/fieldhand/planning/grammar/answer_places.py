"""The places that the answers to a question mean, for showing them on a map."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from fieldhand.errors import DriveFault, PlaceError, TaskError
from fieldhand.forecast.walk_branch import walk_branch
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.planning.planner import Planned
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task.frames import Task
from fieldhand.task.plan import Node, Span, walk


def different_places(
    plans: Sequence[Planned | None], said: Span, site: Site, robot: RobotProfile
) -> tuple[tuple[Place, ...], ...]:
    """Return for each plan the places that some words of its request mean; nothing if they do not differ."""
    found = [_places(plan.task, said, site, robot) if plan is not None else () for plan in plans]
    return tuple(found) if len({frozenset(p.id for p in places) for places in found}) > 1 else ()


def _places(task: Task, said: Span, site: Site, robot: RobotProfile) -> tuple[Place, ...]:
    """Return the places of the nodes that came from some words; of all nodes where none did."""
    nodes = [n for n in walk(task.composition.plan) if n.selector is not None]
    nodes = [n for n in nodes if any(s < said[1] and said[0] < e for s, e in _words_of(n))] or nodes
    try:
        found = list(_resolved(nodes, site) or _reached(nodes, task, site, robot))
    except (PlaceError, DriveFault, TaskError):
        return ()
    return tuple({(p.kind, p.id): p for p in found}.values())


def _words_of(node: Node) -> tuple[Span, ...]:
    return (*node.said, *node.at_said)


def _resolved(nodes: list[Node], site: Site) -> list[Place]:
    """Return the places of selectors that mean the same wherever the robot is; none if one of them does not."""
    selectors = [s for n in nodes if (s := n.selector) is not None]
    if any(s.relative for s in selectors):
        return []
    return [place for s in selectors for place in resolve(s, site, Context(here=site.start))]


def _reached(nodes: list[Node], task: Task, site: Site, robot: RobotProfile) -> Iterator[Place]:
    """The places to which a walk through the plan comes at some nodes, if every condition holds."""
    if any(n.visits_each and n.is_optional for n in walk(task.composition.plan)):
        return  # to choose among visits takes longer than anyone waits for a question
    ids = {node.id for node in nodes}
    for step in walk_branch(task, site, robot, holds=lambda _: True).steps:
        if step.node.id in ids and step.kind in ("drive", "act", "visit-list"):
            yield from step.places
