"""Plan nodes: the composite and atomic tasks of a Task.

Every node has an ``id`` that is unique in its Task and stays the same from planning to the report. ``said`` lists the
character ranges of the request (start, end) from which the node came; it is empty where the request does not state it.

The semantics of a node are defined once, in its own file (:mod:`fieldhand.task.nodes`). Preview, robot and log reader
all execute that definition (:class:`fieldhand.task.run.Run`) and differ only in how they answer its instructions.

The budget guard may shed optional work (:attr:`~.nodes.base.PlanNode.is_optional`); the mission continues, and shed
work did not fail. It decides about an ``OptionalStep`` once and as a whole, when the step is reached; nothing inside
one is optional itself.
"""

from __future__ import annotations

from collections.abc import Iterator

from fieldhand.task.nodes.act import Act
from fieldhand.task.nodes.any_order import AnyOrder
from fieldhand.task.nodes.base import Span
from fieldhand.task.nodes.for_each import ForEach
from fieldhand.task.nodes.go_to import GoTo
from fieldhand.task.nodes.if_else import If
from fieldhand.task.nodes.in_order import InOrder
from fieldhand.task.nodes.optional_step import OptionalStep
from fieldhand.task.nodes.pace import Pace
from fieldhand.task.nodes.recharge import Recharge
from fieldhand.task.nodes.repeat import Repeat
from fieldhand.task.nodes.stop_mission import StopMission
from fieldhand.task.nodes.try_otherwise import Try
from fieldhand.task.nodes.wait import Wait
from fieldhand.task.nodes.work_along import WorkAlong

__all__ = [
    "Act",
    "AnyOrder",
    "ForEach",
    "GoTo",
    "If",
    "InOrder",
    "Node",
    "OptionalStep",
    "Pace",
    "Recharge",
    "Repeat",
    "Span",
    "StopMission",
    "Try",
    "Wait",
    "WorkAlong",
    "acts",
    "walk",
    "works",
]

Node = (
    InOrder
    | AnyOrder
    | ForEach
    | Repeat
    | If
    | Try
    | OptionalStep
    | GoTo
    | Act
    | WorkAlong
    | Recharge
    | StopMission
    | Wait
    | Pace
)


def walk(node: Node) -> Iterator[Node]:
    """Yield this node and all nodes inside it, outermost first."""
    yield node
    for child in node.children:
        yield from walk(child)


def acts(node: Node) -> Iterator[Act]:
    """Yield the actions in this node and all nodes inside it, in document order."""
    return (inner.act for inner in walk(node) if inner.act is not None)


def works(node: Node) -> Iterator[WorkAlong]:
    """Yield the work along paths in this node and all nodes inside it, in document order."""
    return (inner.work for inner in walk(node) if inner.work is not None)


def actions_of(node: Node) -> frozenset[str]:
    """Return the names of the actions in this node and all nodes inside it, at places and along paths."""
    return frozenset((*(act.action for act in acts(node)), *(work.action for work in works(node))))
