"""Plan nodes: the composite and atomic tasks of a Task.

Every node has an ``id`` that is unique in its Task and stays the same from planning to the report. ``said`` holds the
character ranges of the request (start, end) from which the node came; empty where nothing in the request says it.

What a plan means is said once, in the node's own file (:mod:`fieldhand.task.nodes`). Preview, robot and reader of a log
carry that out (:class:`fieldhand.task.run.Run`), and differ only in what they answer.

The budget guard may shed what is optional (:attr:`~.nodes.base.PlanNode.is_optional`), and the mission goes on: work
that was shed did not fail. It is asked about an ``OptionalStep`` once, when that is reached, about all of it; in one
stands nothing else that is optional.
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
from fieldhand.task.nodes.repeat import Repeat
from fieldhand.task.nodes.stop_mission import StopMission
from fieldhand.task.nodes.try_otherwise import Try

__all__ = [
    "Act",
    "AnyOrder",
    "ForEach",
    "GoTo",
    "If",
    "InOrder",
    "Node",
    "OptionalStep",
    "Repeat",
    "Span",
    "StopMission",
    "Try",
    "acts",
    "walk",
]

Node = InOrder | AnyOrder | ForEach | Repeat | If | Try | OptionalStep | GoTo | Act | StopMission


def walk(node: Node) -> Iterator[Node]:
    """This node and every one inside it, outermost first."""
    yield node
    for child in node.children:
        yield from walk(child)


def acts(node: Node) -> Iterator[Act]:
    """The actions of this node and of every one inside it, in the order in which they stand."""
    return (inner.act for inner in walk(node) if inner.act is not None)
