"""Server of a ROS 2 action: three services and two topics, with the behavior of rclcpp's server."""

from __future__ import annotations

import uuid
from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

from fieldhand.execution.drivers.ros2.action_outcome import ABORTED, ACCEPTED, CANCELED, CANCELING, EXECUTING, SUCCEEDED
from fieldhand.execution.drivers.ros2.transport import STATUS_QOS, RosMessage, Transport

#: Return codes of ``action_msgs/srv/CancelGoal``.
NO_ERROR, UNKNOWN_GOAL, TERMINATED = 0, 2, 3

_OVER = (SUCCEEDED, CANCELED, ABORTED)
#: Finished goals that are remembered, for clients that request the result late.
_MOST_KEPT = 50
_NO_ID = bytes(16)


class GoalHandler(Protocol):
    """Carries out the goals of an action server."""

    def rejection_reason(self, goal: RosMessage) -> str | None:
        """Return why a goal is rejected; None to accept it."""
        ...

    def begin(self, goal: ServerGoal) -> None:
        """Start an accepted goal."""
        ...

    def cancel(self, goal: ServerGoal) -> None:
        """Cancel a goal; confirmed by :meth:`ServerGoal.cancelled`, now or later."""
        ...


@dataclass(eq=False)
class ServerGoal:
    """A goal of a server.

    Attributes:
        id: Goal id, 16 bytes.
        asked: Goal message.
        since: Time of acceptance, as ``builtin_interfaces/msg/Time``.
    """

    id: bytes
    goal_message: RosMessage
    since: Mapping[str, int]
    server: ActionServer
    status: int = ACCEPTED
    result: RosMessage = field(default_factory=dict)
    waiting: list[object] = field(default_factory=list)

    @property
    def over(self) -> bool:
        """True once the goal has ended."""
        return self.status in _OVER

    def feedback(self, message: RosMessage) -> None:
        """Publish feedback."""
        self.server.send_feedback(self, message)

    def succeeded(self, result: RosMessage) -> None:
        """End the goal as succeeded."""
        self.server.end(self, SUCCEEDED, result)

    def aborted(self, result: RosMessage) -> None:
        """End the goal as aborted."""
        self.server.end(self, ABORTED, result)

    def cancelled(self, result: RosMessage) -> None:
        """End the goal as cancelled."""
        self.server.end(self, CANCELED, result)


class ActionServer:
    """Server of an action.

    Args:
        transport: Transport of the robot's graph.
        name: Full name of the action.
        type_name: ``package/action/Name``.
        handler: Carries out the goals.
        stamp: Returns the current time as ``builtin_interfaces/msg/Time``.
        refused: Called with the reason of each rejected goal.

    Raises:
        Ros2Error: The type is unknown.
    """

    def __init__(
        self,
        transport: Transport,
        name: str,
        type_name: str,
        handler: GoalHandler,
        *,
        stamp: Callable[[], Mapping[str, int]],
        refused: Callable[[str], None],
    ) -> None:
        self._handler, self._stamp, self._refused = handler, stamp, refused
        self._send = transport.serve(f"{name}/_action/send_goal", f"{type_name}_SendGoal")
        self._result = transport.serve(f"{name}/_action/get_result", f"{type_name}_GetResult")
        self._cancel = transport.serve(f"{name}/_action/cancel_goal", "action_msgs/srv/CancelGoal")
        self._feedback = transport.publish(f"{name}/_action/feedback", f"{type_name}_FeedbackMessage")
        self._status = transport.publish(f"{name}/_action/status", "action_msgs/msg/GoalStatusArray", STATUS_QOS)
        self._goals: OrderedDict[bytes, ServerGoal] = OrderedDict()

    def adopt(self, message: RosMessage | None = None) -> ServerGoal:
        """Add a goal that a program of the robot itself has sent; it is executing."""
        goal = ServerGoal(
            id=uuid.uuid4().bytes, goal_message=message or {}, since=self._stamp(), server=self, status=EXECUTING
        )
        self._goals[goal.id] = goal
        self._publish()
        return goal

    def close(self) -> None:
        """End the server; nobody is told of its goals any more."""
        for end in (self._send, self._result, self._cancel, self._feedback, self._status):
            end.close()

    def step(self) -> None:
        """Answer the requests received since the last call."""
        for to, request in self._send.requests():
            self._accept(to, request)
        for to, request in self._cancel.requests():
            self._cancel.reply(to, self._cancelling(_part(request, "goal_info")))
        for to, request in self._result.requests():
            goal = self._goals.get(_id(request.get("goal_id")))
            if goal is None:
                self._result.reply(to, {"status": 0})
            elif goal.over:
                self._result.reply(to, {"status": goal.status, "result": goal.result})
            else:
                goal.waiting.append(to)

    def send_feedback(self, goal: ServerGoal, message: RosMessage) -> None:
        """Publish feedback of a goal."""
        self._feedback.send({"goal_id": {"uuid": goal.id}, "feedback": message})

    def end(self, goal: ServerGoal, status: int, result: RosMessage) -> None:
        """Record the end of a goal and send its result."""
        if goal.over:
            return
        goal.status, goal.result = status, result
        for to in goal.waiting:
            self._result.reply(to, {"status": status, "result": result})
        goal.waiting.clear()
        over = [known for known in self._goals.values() if known.over]
        for old in over[:-_MOST_KEPT]:
            del self._goals[old.id]
        self._publish()

    def _accept(self, to: object, request: RosMessage) -> None:
        identity, goal_message = _id(request.get("goal_id")), _part(request, "goal")
        stamp = self._stamp()
        why = "its id is taken" if identity in self._goals else self._handler.rejection_reason(goal_message)
        self._send.reply(to, {"accepted": why is None, "stamp": stamp})
        if why is not None:
            self._refused(why)
            return
        goal = self._goals[identity] = ServerGoal(id=identity, goal_message=goal_message, since=stamp, server=self)
        self._publish()
        goal.status = EXECUTING
        self._publish()
        self._handler.begin(goal)

    def _cancelling(self, info: RosMessage) -> RosMessage:
        """Cancel one goal, those accepted up to a time, or all, by the rules of ``action_msgs/srv/CancelGoal``."""
        identity, until = _id(info.get("goal_id")), _nanoseconds(info.get("stamp"))
        named = self._goals.get(identity)
        if identity != _NO_ID and named is None and not until:
            return {"return_code": UNKNOWN_GOAL}
        if named is not None and named.over and not until:
            return {"return_code": TERMINATED}
        everything = identity == _NO_ID and not until
        chosen = [
            goal
            for goal in self._goals.values()
            if not goal.over and (everything or goal is named or (until and _nanoseconds(goal.since) <= until))
        ]
        for goal in chosen:
            goal.status = CANCELING
        self._publish()
        for goal in chosen:
            self._handler.cancel(goal)
        return {
            "return_code": NO_ERROR,
            "goals_canceling": tuple({"goal_id": {"uuid": goal.id}, "stamp": goal.since} for goal in chosen),
        }

    def _publish(self) -> None:
        self._status.send(
            {
                "status_list": tuple(
                    {"goal_info": {"goal_id": {"uuid": goal.id}, "stamp": goal.since}, "status": goal.status}
                    for goal in self._goals.values()
                )
            }
        )


def _part(message: RosMessage, name: str) -> RosMessage:
    part = message.get(name)
    return part if isinstance(part, Mapping) else {}


def _id(value: object) -> bytes:
    """Return the bytes of a ``unique_identifier_msgs/msg/UUID``."""
    uuid = value.get("uuid") if isinstance(value, Mapping) else None
    return uuid if isinstance(uuid, bytes) else bytes(uuid) if isinstance(uuid, tuple) else _NO_ID


def _nanoseconds(stamp: object) -> int:
    if not isinstance(stamp, Mapping):
        return 0
    return int(stamp.get("sec", 0)) * 10**9 + int(stamp.get("nanosec", 0))
