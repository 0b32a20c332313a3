"""Lifecycle of the navigation's nodes: ``get_state`` and ``change_state`` of each."""

from __future__ import annotations

from fieldhand.execution.drivers.ros2.message_fields import value_at
from fieldhand.execution.drivers.ros2.node_states import ACTIVE, GET_STATE, INACTIVE
from fieldhand.execution.drivers.ros2.transport import Server, Transport

CHANGE_STATE = "lifecycle_msgs/srv/ChangeState"

_LABELS = {INACTIVE: "inactive", ACTIVE: "active"}
#: Transitions of ``lifecycle_msgs/msg/Transition``: the state from which and to which they lead.
_TRANSITIONS = {3: (INACTIVE, ACTIVE), 4: (ACTIVE, INACTIVE)}


class LifecycleServer:
    """The lifecycle services of one node.

    Args:
        transport: Node of the robot.
        name: Full name of the node.

    Attributes:
        state: Primary state.
    """

    def __init__(self, transport: Transport, name: str) -> None:
        self._transport, self._name = transport, name
        self._servers: tuple[Server, Server] | None = None
        self.state = ACTIVE
        self.start(ACTIVE)

    def start(self, state: int) -> None:
        """Start the node in a state."""
        self.state = state
        self._servers = (
            self._transport.serve(f"{self._name}/get_state", GET_STATE),
            self._transport.serve(f"{self._name}/change_state", CHANGE_STATE),
        )

    @property
    def active(self) -> bool:
        """True if the node is there and active."""
        return self._servers is not None and self.state == ACTIVE

    def step(self) -> None:
        """Answer the requests received since the last call."""
        if self._servers is None:
            return
        states, changes = self._servers
        for to, _ in states.requests():
            states.reply(to, {"current_state": {"id": self.state, "label": _LABELS[self.state]}})
        for to, request in changes.requests():
            transition = value_at(request, "transition.id")
            before, after = _TRANSITIONS.get(transition if isinstance(transition, int) else 0, (0, 0))
            if before == self.state:
                self.state = after
            changes.reply(to, {"success": before != 0 and self.state == after})

    def close(self) -> None:
        """End the node."""
        for server in self._servers or ():
            server.close()
        self._servers = None
