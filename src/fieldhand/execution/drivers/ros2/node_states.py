"""Lifecycle states of the navigation's nodes: a node of Nav2 that is not active rejects all goals."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from fieldhand.execution.drivers.ros2.message_fields import value_at
from fieldhand.execution.drivers.ros2.transport import Client, RosMessage, Transport
from fieldhand.execution.robot_text import robot_text
from fieldhand.robot.bindings import Ros2Bindings

GET_STATE = "lifecycle_msgs/srv/GetState"

#: Primary states of ``lifecycle_msgs/msg/State``.
UNCONFIGURED, INACTIVE, ACTIVE, FINALIZED = 1, 2, 3, 4

#: Seconds between two questions to a node.
_ASK_EVERY_S = 1.0

#: Description and advice for each state but the active one; ``{}`` stands for the node.
_STATES = {
    UNCONFIGURED: ("unconfigured", "configure and activate it (ros2 lifecycle set {} configure, then activate)"),
    INACTIVE: ("inactive", "activate it (ros2 lifecycle set {} activate)"),
    FINALIZED: ("shut down", "start it again"),
}


def state_problem(node: str, state: RosMessage) -> tuple[str, str] | None:
    """Return what keeps a node from working and what to do, by the answer of its ``get_state``; None if it is active.

    Args:
        node: Full name of the node.
        state: Response of ``lifecycle_msgs/srv/GetState``.
    """
    number, label = value_at(state, "current_state.id"), robot_text(str(value_at(state, "current_state.label") or ""))
    if number == ACTIVE:
        return None
    what, advice = _STATES.get(number if isinstance(number, int) else 0, (f"{label or 'in an unknown state'}", ""))
    return f"{node.rpartition('/')[2]} is {what}", advice.format(node)


@dataclass
class _AskedNode:
    """A node and its last answer.

    Attributes:
        asked_s, heard_s: Times of the last question and answer.
        seen: True once it has answered.
    """

    name: str
    client: Client
    asked_s: float = -math.inf
    heard_s: float = -math.inf
    seen: bool = False
    state: RosMessage = field(default_factory=dict)


class NodeStates:
    """The lifecycle nodes of a robot's navigation. A node without a lifecycle, or that does not exist, is ignored.

    Args:
        transport: Transport of the robot's graph.
        bindings: Name the nodes.
        steady: Monotonic clock in seconds.

    Raises:
        Ros2Error: The type of the service is unknown.
    """

    def __init__(self, transport: Transport, bindings: Ros2Bindings, *, steady: Callable[[], float]) -> None:
        self._steady = steady
        names = [bindings.whole_name(node) for node in bindings.navigation.nodes]
        self._nodes = [_AskedNode(name, transport.client(f"{name}/get_state", GET_STATE)) for name in names]

    def look(self) -> None:
        """Ask the nodes that are there, once a second, and process their answers."""
        now = self._steady()
        for node in self._nodes:
            for _, reply in node.client.replies():
                node.state, node.heard_s, node.seen = reply, now, True
            if node.client.servers() and now - node.asked_s >= _ASK_EVERY_S:
                node.asked_s = now
                node.client.ask({})

    def problems(self, since_s: float) -> Iterator[tuple[str, str]]:
        """Yield the nodes that are not active, each with what to do; only answers since a time count."""
        for node in self._nodes:
            short = node.name.rpartition("/")[2]
            if node.client.servers() == 0:
                if node.seen:
                    yield f"{short} is gone", "start it again"
            elif node.heard_s < since_s:
                yield f"{short} does not answer {node.name}/get_state", "check whether it hangs"
            elif (problem := state_problem(node.name, node.state)) is not None:
                yield problem

    def all_active(self, since_s: float) -> bool:
        """Return True if every node has answered since a time that it is active."""
        return bool(self._nodes) and all(
            node.heard_s >= since_s and value_at(node.state, "current_state.id") == ACTIVE for node in self._nodes
        )

    def close(self) -> None:
        """Close all endpoints without sending anything."""
        for node in self._nodes:
            node.client.close()
