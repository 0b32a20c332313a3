"""Client of a ROS 2 action: sends one goal at a time, cancels it, and tolerates lost or repeated messages.

    start ──▶ server found ──▶ sent ──▶ accepted ──▶ result
      │            │            │  └──▶ rejected
      └────────────┴────────────┴──── cancel, or a time limit ──▶ cancelling ──▶ confirmed, server gone, or no answer

An action consists of three services and two topics. Replies may be lost, arrive twice, or arrive late, so each is
matched by its request number and goal; feedback and status carry the same information a second time. A goal is sent
exactly once. A goal that was given up stays on record: it is cancelled if the robot later turns out to be executing it.
"""

from __future__ import annotations

import math
import uuid
from collections.abc import Callable, Mapping

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.action_outcome import (
    BUSY,
    BY_STATUS,
    CANCEL_REJECTED,
    CANCEL_TERMINATED,
    CANCEL_UNKNOWN_GOAL,
    GONE_S,
    SUCCEEDED,
    TWO_S,
    ActionOutcome,
    GoalRecord,
)
from fieldhand.execution.drivers.ros2.message_fields import value_at
from fieldhand.execution.drivers.ros2.transport import STATUS_QOS, Client, QosProfile, RosMessage, Transport

#: Seconds without a sign of life, or since the end was reported, after which the result is requested again.
RESULT_AGAIN_S = 3.0
#: Seconds after which an unanswered cancel request is repeated.
CANCEL_AGAIN_S = 1.0
#: Stands in for the number of a request that could not be sent.
_LOST = -1
#: Seconds within which a cancelled goal must end. Longer than execution waits before it reports that the robot does not
#: stop.
CANCEL_S = 15.0


class ActionClient:
    """Client of one action of the robot.

    Args:
        transport: Transport of the robot's graph.
        name: Full name of the action.
        type_name: ``package/action/Name``.
        steady: Monotonic clock for the client's time limits, in seconds.
        accept_s: Seconds to find a server, and again to get the goal accepted or rejected.
        quiet_s: Seconds without feedback after which a goal is given up; None for an action without feedback.
        new_id: Returns the 16 bytes of a goal id, unique across all processes.

    Raises:
        Ros2Error: The type is unknown.
    """

    def __init__(
        self,
        transport: Transport,
        name: str,
        type_name: str,
        *,
        steady: Callable[[], float],
        accept_s: float,
        quiet_s: float | None = None,
        new_id: Callable[[], bytes] = lambda: uuid.uuid4().bytes,
    ) -> None:
        self.name, self.type = name, type_name
        self.feedback: RosMessage = {}
        self._steady, self._accept_s, self._quiet_s, self._new_id = steady, accept_s, quiet_s, new_id
        self._send = transport.client(f"{name}/_action/send_goal", f"{type_name}_SendGoal")
        self._result = transport.client(f"{name}/_action/get_result", f"{type_name}_GetResult")
        self._cancel = transport.client(f"{name}/_action/cancel_goal", "action_msgs/srv/CancelGoal")
        self._feedback = transport.subscribe(
            f"{name}/_action/feedback", f"{type_name}_FeedbackMessage", QosProfile(reliable=True)
        )
        self._status = transport.subscribe(f"{name}/_action/status", "action_msgs/msg/GoalStatusArray", STATUS_QOS)
        self._goal: GoalRecord | None = None
        self._outcome: ActionOutcome | None = None
        self._statuses: dict[bytes, int] = {}
        self._goal_requests: dict[int, bytes] = {}
        self._result_requests: dict[int, bytes] = {}
        self._cancel_requests: dict[int, tuple[bytes, bool]] = {}
        self._abandoned: dict[bytes, float] = {}
        self._own: set[bytes] = set()
        #: True once a server has accepted a goal.
        self.was_accepted = False
        self._cancel_all_requests: set[int] = set()
        self._stopping: set[bytes] = set()
        self._cancel_all_s, self._all_cancelled = -math.inf, False

    # --- requests ------------------------------------------------------------------------------------------------

    def servers(self) -> int:
        """Return the number of servers that offer all services a goal needs."""
        return min(client.servers() for client in self._clients)

    def start(self, goal: RosMessage, *, sending: Callable[[], None] = lambda: None) -> None:
        """Start a goal with these fields; the previous goal must have ended.

        Args:
            goal: Fields of the goal.
            sending: Called just before the goal is sent.
        """
        if self.busy:
            raise RuntimeError(f"a goal of {self.name} is running: a client has one at a time")
        now = self._steady()
        self.feedback = {}
        self._goal = GoalRecord(id=self._new_id(), message=goal, begun_s=now, heard_s=now, sending=sending)
        self._outcome = None

    @property
    def busy(self) -> bool:
        """True while a started goal has not ended."""
        return self._goal is not None and self._outcome is None

    def cancel(self, why: str = "") -> None:
        """Note that the goal is to be cancelled; :meth:`step` sends the request and reports when the goal has ended.

        Repeated calls have no effect.

        Args:
            why: Reason, reported in the outcome unless the goal succeeds.
        """
        if self._goal is not None and self._outcome is None and self._goal.cancel_asked_s is None:
            self._goal.cancel_asked_s, self._goal.why = self._steady(), why

    def step(self) -> ActionOutcome | None:
        """Process received messages and send what is due. Return None before the first goal and while a goal runs."""
        now = self._steady()
        self._receive(now)
        if self._goal is not None and self._outcome is None:
            self._outcome = self._decide(self._goal, now)
            if self._outcome is not None:
                self._stop_tracking(self._goal, now)
        return self._outcome

    def others(self) -> int:
        """Return the number of active goals that other clients have sent."""
        return sum(status in BUSY for goal_id, status in self._statuses.items() if goal_id not in self._own)

    def cancel_everything_again(self) -> None:
        """Let :meth:`cancel_everything` send a new request."""
        self._all_cancelled, self._cancel_all_s = False, -math.inf
        self._stopping.clear()
        self._statuses.clear()

    def cancel_everything(self) -> bool:
        """Cancel every goal of this action, whoever sent it; call repeatedly until it returns True.

        Returns:
            True once the request was answered and no goal is active.
        """
        now = self._steady()
        self._receive(now)
        if not self._all_cancelled and now - self._cancel_all_s >= CANCEL_AGAIN_S:
            self._cancel_all_s = now
            self._cancel_all_requests.add(self._send_request(self._cancel, {}))
        # Statuses arrive on a topic of their own and may lag behind the cancel response.
        self._stopping -= {goal_id for goal_id, status in self._statuses.items() if status in BY_STATUS}
        return (
            self._all_cancelled and not self._stopping and not any(status in BUSY for status in self._statuses.values())
        )

    def close(self) -> None:
        """Close all endpoints without sending anything."""
        for client in self._clients:
            client.close()
        for subscription in (self._feedback, self._status):
            subscription.close()

    @property
    def _clients(self) -> tuple[Client, ...]:
        return self._send, self._result, self._cancel

    # --- replies -------------------------------------------------------------------------------------------------

    def _receive(self, now: float) -> None:
        for message in self._feedback.take():
            self._mark_active(_id(value_at(message, "goal_id.uuid")), now, message)
        for message in self._status.take():
            self._receive_status(message, now)
        for number, reply in self._send.replies():
            self._receive_acceptance(self._goal_requests.pop(number, b""), reply, now)
        for number, reply in self._result.replies():
            self._receive_result(self._result_requests.pop(number, b""), reply, now)
        for number, reply in self._cancel.replies():
            self._receive_cancel_reply(*self._cancel_requests.get(number, (b"", False)), reply)
            self._cancel_requests[number] = b"", False
            if number in self._cancel_all_requests:
                self._receive_cancel_all_reply(reply)

    def _mark_active(self, goal_id: bytes, now: float, feedback: RosMessage | None = None) -> None:
        """Record that the robot is executing a goal."""
        goal = self._goal
        if goal is not None and goal_id == goal.id and self._outcome is None:
            goal.accepted, goal.heard_s = True, now
            self.was_accepted = True
            if feedback is not None:
                inner = feedback.get("feedback")
                self.feedback = inner if isinstance(inner, Mapping) else {}
        elif goal_id in self._abandoned and now - self._abandoned[goal_id] >= CANCEL_AGAIN_S:
            self._abandoned[goal_id] = now
            self._request_cancel(goal_id, settled=True)

    def _receive_status(self, message: RosMessage, now: float) -> None:
        listed = message.get("status_list")
        self._statuses = {
            _id(value_at(entry, "goal_info.goal_id.uuid")): entry["status"]
            for entry in (listed if isinstance(listed, tuple) else ())
            if isinstance(entry, Mapping) and isinstance(entry.get("status"), int)
        }
        for goal_id, status in self._statuses.items():
            if status in BUSY:
                self._mark_active(goal_id, now)
            elif status in BY_STATUS:
                self._abandoned.pop(goal_id, None)
                goal = self._goal
                if goal is not None and goal_id == goal.id and goal.ended is None:
                    goal.accepted, goal.ended, goal.ended_s = True, status, now

    def _receive_acceptance(self, goal_id: bytes, reply: RosMessage, now: float) -> None:
        if reply.get("accepted"):
            self._mark_active(goal_id, now)
        elif self._goal is not None and goal_id == self._goal.id and not self._goal.accepted:
            self._goal.rejected = True

    def _receive_result(self, goal_id: bytes, reply: RosMessage, now: float) -> None:
        goal, status = self._goal, reply.get("status")
        if goal is None or goal_id != goal.id or not isinstance(status, int):
            return
        if status in BY_STATUS:
            result = reply.get("result")
            goal.result = result if isinstance(result, Mapping) else {}
            goal.ended, goal.ended_s = status, now
        else:
            goal.forgotten = True

    def _receive_cancel_reply(self, goal_id: bytes, settled: bool, reply: RosMessage) -> None:
        goal, code = self._goal, reply.get("return_code")
        if code == CANCEL_TERMINATED:
            self._abandoned.pop(goal_id, None)
        if goal is None or goal_id != goal.id:
            return
        goal.refused = code == CANCEL_REJECTED
        # A goal request still in transit was unknown to the server when it answered.
        unknown = code == CANCEL_UNKNOWN_GOAL and settled
        goal.forgotten = goal.forgotten or code == CANCEL_TERMINATED or unknown
        goal.restarted = goal.restarted or (unknown and goal.accepted)  # it knew it before

    def _receive_cancel_all_reply(self, reply: RosMessage) -> None:
        """Record the goals that a cancel-all request ends; a rejected request is repeated."""
        listed = reply.get("goals_canceling")
        self._all_cancelled = self._all_cancelled or reply.get("return_code") != CANCEL_REJECTED
        for entry in listed if isinstance(listed, tuple) else ():
            self._stopping.add(_id(value_at(entry, "goal_id.uuid")))

    # --- decisions -----------------------------------------------------------------------------------------------

    def _decide(self, goal: GoalRecord, now: float) -> ActionOutcome | None:
        if goal.ended is not None:
            return self._end(goal, now)
        if goal.rejected:
            if goal.cancel_asked_s is not None:
                return ActionOutcome(how="cancelled", what=goal.why)
            return ActionOutcome(how="rejected", what=f"{self.name} rejected the goal", server="rejects")
        if goal.sent_s is None:
            return self._send_when_ready(goal, now)
        if self._is_gone(goal, now):
            what = f"{self.name} is gone: nothing answers any more"
            return ActionOutcome(how="untold", what=what, moving=True, server="gone")
        if goal.cancel_asked_s is None:
            self._apply_limits(goal, goal.sent_s, now)
        if goal.cancel_asked_s is not None:
            return self._cancel_until_confirmed(goal, goal.sent_s, goal.cancel_asked_s, now)
        self._request_result(goal, now)
        return None

    def _send_when_ready(self, goal: GoalRecord, now: float) -> ActionOutcome | None:
        """Send the goal once a server is matched; its reply would be lost before."""
        if goal.cancel_asked_s is not None:
            return ActionOutcome(how="cancelled", what=goal.why)
        servers = self.servers()
        if servers > 1:
            if now - goal.begun_s <= TWO_S:
                return None
            return ActionOutcome(how="rejected", what=f"{servers} servers answer {self.name}: which robot is meant?")
        if servers == 1:
            goal.sending()
            try:
                self._goal_requests[self._send.ask({"goal_id": {"uuid": goal.id}, "goal": goal.message})] = goal.id
            except Ros2Error as error:
                return ActionOutcome(how="rejected", what=f"a goal of {self.name} does not fit its type: {error}")
            self._own.add(goal.id)
            goal.sent_s = goal.heard_s = now
        elif now - goal.begun_s > self._accept_s:
            return ActionOutcome(how="untold", what=f"nothing answers {self.name}", server="gone")
        return None

    def _is_gone(self, goal: GoalRecord, now: float) -> bool:
        if self.servers() > 0:
            goal.absent_s = None
            return False
        goal.absent_s = now if goal.absent_s is None else goal.absent_s
        return now - goal.absent_s >= GONE_S

    def _apply_limits(self, goal: GoalRecord, sent_s: float, now: float) -> None:
        """Give up a goal that the server does not seem to be executing."""
        if goal.forgotten:
            goal.restarted = True
            self.cancel(f"{self.name} no longer knows the goal: it was restarted")
        elif not goal.accepted and now - sent_s > self._accept_s:
            self.cancel(f"{self.name} did not accept or reject the goal within {self._accept_s:g} s")
        elif goal.accepted and self._quiet_s is not None and now - goal.heard_s > self._quiet_s:
            self.cancel(f"{self.name} was silent for {self._quiet_s:g} s")

    def _request_result(self, goal: GoalRecord, now: float) -> None:
        """Request the result once the goal is accepted, and again if the request or reply seems lost."""
        asked_s = goal.asked_result_s
        silent = now - goal.heard_s >= RESULT_AGAIN_S or goal.ended is not None
        if goal.accepted and (asked_s is None or (silent and now - asked_s >= RESULT_AGAIN_S)):
            goal.asked_result_s = now
            self._result_requests[self._send_request(self._result, {"goal_id": {"uuid": goal.id}})] = goal.id

    def _request_cancel(self, goal_id: bytes, *, settled: bool) -> None:
        number = self._send_request(self._cancel, {"goal_info": {"goal_id": {"uuid": goal_id}}})
        self._cancel_requests[number] = goal_id, settled

    @staticmethod
    def _send_request(client: Client, request: RosMessage) -> int:
        """Send a request and return its number; a failed send is treated as a lost request and repeated."""
        try:
            return client.ask(request)
        except Ros2Error:
            return _LOST

    def _cancel_until_confirmed(
        self, goal: GoalRecord, sent_s: float, cancel_asked_s: float, now: float
    ) -> ActionOutcome | None:
        """Request cancellation until it is confirmed."""
        if goal.forgotten and goal.asked_cancel_s is not None:
            return ActionOutcome(how="cancelled", what=goal.why, server="restarted" if goal.restarted else "")
        if now - cancel_asked_s > CANCEL_S:
            fault = "refuses to be cancelled" if goal.refused else "does not confirm that it was cancelled"
            begun = f"{goal.why}; then " if goal.why else ""
            return ActionOutcome(how="untold", what=f"{begun}{self.name} {fault}", moving=True)
        if goal.asked_cancel_s is None or now - goal.asked_cancel_s >= CANCEL_AGAIN_S:
            goal.asked_cancel_s = now
            self._request_cancel(goal.id, settled=goal.accepted or now - sent_s > self._accept_s)
        self._request_result(goal, now)
        return None

    def _end(self, goal: GoalRecord, now: float) -> ActionOutcome | None:
        """Return the outcome once the final status is known, waiting a while for the result."""
        assert goal.ended is not None  # noqa: S101  asked for where it is
        wanted = goal.result is None and (goal.cancel_asked_s is None or goal.ended == SUCCEEDED)
        if wanted and now - goal.ended_s < 2 * RESULT_AGAIN_S and self.servers() > 0:
            self._request_result(goal, now)
            return None
        return ActionOutcome(how=BY_STATUS[goal.ended], result=goal.result or {}, what=goal.why)

    def _stop_tracking(self, goal: GoalRecord, now: float) -> None:
        """Stop tracking the goal; if the robot may still be executing it, keep its id to cancel it later."""
        if goal.restarted or self.servers() == 0:
            self._statuses.clear()  # those of a server that is no more
        if goal.sent_s is not None and goal.ended is None:
            self._abandoned[goal.id] = now - CANCEL_AGAIN_S


def _id(value: object) -> bytes:
    """Return a goal id as bytes; empty if there is none."""
    if isinstance(value, bytes):
        return value
    if isinstance(value, tuple) and all(isinstance(v, int) and 0 <= v < 256 for v in value):
        return bytes(value)
    return b""
