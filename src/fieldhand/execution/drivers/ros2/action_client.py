"""The client of a ROS 2 action: one goal at a time, from the request to its end, whatever gets lost between.

    start ──▶ found ──▶ sent ──▶ accepted ──▶ result
      │         │        │  └──▶ rejected
      └─────────┴────────┴──── cancel, or a limit is over ──▶ stopping ──▶ it confirms, is gone, or says nothing

An action is three services and two topics. Replies may be lost, come twice, or come when nobody waits any more, so each
is known by its number and its goal; feedback and status tell the same a second time. A goal is sent once, never again.
One that was given up is not forgotten: whatever shows later that the robot is at it gets it cancelled.
"""

from __future__ import annotations

import math
import uuid
from collections.abc import Callable, Mapping

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.goal_outcome import (
    BUSY,
    BY_STATUS,
    CANCEL_REJECTED,
    CANCEL_TERMINATED,
    CANCEL_UNKNOWN_GOAL,
    GONE_S,
    SUCCEEDED,
    TWO_S,
    GoalOutcome,
    GoalRecord,
)
from fieldhand.execution.drivers.ros2.message_fields import value_at
from fieldhand.execution.drivers.ros2.transport import STATUS_QOS, Client, Message, QosProfile, Transport

#: Seconds without a sign of life, or since the end was told, after which the result is asked for again.
RESULT_AGAIN_S = 3.0
#: Seconds until a cancellation that was not answered is repeated.
CANCEL_AGAIN_S = 1.0
#: Stands for the number of a request that did not go out; none that did has it.
_LOST = -1
#: Seconds in which a cancelled goal has to end. More than execution waits before it says that the robot does not stop.
CANCEL_S = 15.0


class ActionClient:
    """Asks an action of the robot.

    Args:
        transport: Carries its messages.
        name: Whole name of the action.
        type_name: ``package/action/Name``.
        steady: Seconds that pass whatever the mission's clock does: by them its limits are.
        accept_s: Within that a server is found, and within that a goal is accepted or rejected.
        quiet_s: Seconds without feedback after which a goal is given up; None for an action that need not give any.
        new_id: Makes the 16 bytes that name a goal; no two of them may be the same in any process.

    Raises:
        Ros2Error: The type is not known.
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
        self.feedback: Message = {}
        self._steady, self._accept_s, self._quiet_s, self._new_id = steady, accept_s, quiet_s, new_id
        self._send = transport.client(f"{name}/_action/send_goal", f"{type_name}_SendGoal")
        self._result = transport.client(f"{name}/_action/get_result", f"{type_name}_GetResult")
        self._cancel = transport.client(f"{name}/_action/cancel_goal", "action_msgs/srv/CancelGoal")
        self._feedback = transport.subscribe(
            f"{name}/_action/feedback", f"{type_name}_FeedbackMessage", QosProfile(reliable=True)
        )
        self._status = transport.subscribe(f"{name}/_action/status", "action_msgs/msg/GoalStatusArray", STATUS_QOS)
        self._goal: GoalRecord | None = None
        self._outcome: GoalOutcome | None = None
        self._statuses: dict[bytes, int] = {}
        self._sent: dict[int, bytes] = {}
        self._asked: dict[int, bytes] = {}
        self._cancelled: dict[int, tuple[bytes, bool]] = {}
        self._given_up: dict[bytes, float] = {}
        self._sweeps: set[int] = set()
        self._stopping: set[bytes] = set()
        self._sweep_s, self._swept = -math.inf, False

    # --- what is asked -------------------------------------------------------------------------------------------

    def servers(self) -> int:
        """How many servers answer all that a goal needs."""
        return min(client.servers() for client in self._clients)

    def start(self, goal: Message, *, sending: Callable[[], None] = lambda: None) -> None:
        """Begin a goal of these fields; the one before must be over. ``sending`` is called just before it is sent."""
        if self.busy:
            raise RuntimeError(f"a goal of {self.name} is running: a client has one at a time")
        now = self._steady()
        self.feedback = {}
        self._goal = GoalRecord(id=self._new_id(), message=goal, begun_s=now, heard_s=now, sending=sending)
        self._outcome = None

    @property
    def busy(self) -> bool:
        """Whether a goal was begun that is not over."""
        return self._goal is not None and self._outcome is None

    def cancel(self, why: str = "") -> None:
        """Ask for the end of the goal; it is over when :meth:`step` says so. Does nothing the second time.

        Args:
            why: Told in the outcome if the goal then does not succeed.
        """
        if self._goal is not None and self._outcome is None and self._goal.stop_s is None:
            self._goal.stop_s, self._goal.why = self._steady(), why

    def step(self) -> GoalOutcome | None:
        """Hear what has arrived and do what is due. None while the goal runs, and before the first."""
        now = self._steady()
        self._hear(now)
        if self._goal is not None and self._outcome is None:
            self._outcome = self._decide(self._goal, now)
            if self._outcome is not None:
                self._leave(self._goal, now)
        return self._outcome

    def cancel_everything(self) -> bool:
        """Ask for the end of every goal of this action, whoever sent it: again and again, until it is True.

        Returns:
            Whether that was answered, and nothing is carried out any more.
        """
        now = self._steady()
        self._hear(now)
        if not self._swept and now - self._sweep_s >= CANCEL_AGAIN_S:
            self._sweep_s = now
            self._sweeps.add(self._asked_of(self._cancel, {}))
        # Statuses come on another way than the answer: those that it ends may not be told yet.
        self._stopping -= {goal_id for goal_id, status in self._statuses.items() if status in BY_STATUS}
        return self._swept and not self._stopping and not any(status in BUSY for status in self._statuses.values())

    def close(self) -> None:
        """End it, without a word to the robot."""
        for client in self._clients:
            client.close()
        for subscription in (self._feedback, self._status):
            subscription.close()

    @property
    def _clients(self) -> tuple[Client, ...]:
        return self._send, self._result, self._cancel

    # --- what is heard -------------------------------------------------------------------------------------------

    def _hear(self, now: float) -> None:
        for message in self._feedback.take():
            self._alive(_id(value_at(message, "goal_id.uuid")), now, message)
        for message in self._status.take():
            self._hear_status(message, now)
        for number, reply in self._send.replies():
            self._hear_accepted(self._sent.pop(number, b""), reply, now)
        for number, reply in self._result.replies():
            self._hear_result(self._asked.pop(number, b""), reply, now)
        for number, reply in self._cancel.replies():
            self._hear_cancelled(*self._cancelled.get(number, (b"", False)), reply)
            self._cancelled[number] = b"", False
            if number in self._sweeps:
                self._hear_swept(reply)

    def _alive(self, goal_id: bytes, now: float, feedback: Message | None = None) -> None:
        """The robot is at a goal."""
        goal = self._goal
        if goal is not None and goal_id == goal.id and self._outcome is None:
            goal.accepted, goal.heard_s = True, now
            if feedback is not None:
                inner = feedback.get("feedback")
                self.feedback = inner if isinstance(inner, Mapping) else {}
        elif goal_id in self._given_up and now - self._given_up[goal_id] >= CANCEL_AGAIN_S:
            self._given_up[goal_id] = now
            self._ask_cancel(goal_id, settled=True)

    def _hear_status(self, message: Message, now: float) -> None:
        listed = message.get("status_list")
        self._statuses = {
            _id(value_at(entry, "goal_info.goal_id.uuid")): entry["status"]
            for entry in (listed if isinstance(listed, tuple) else ())
            if isinstance(entry, Mapping) and isinstance(entry.get("status"), int)
        }
        for goal_id, status in self._statuses.items():
            if status in BUSY:
                self._alive(goal_id, now)
            elif status in BY_STATUS:
                self._given_up.pop(goal_id, None)
                goal = self._goal
                if goal is not None and goal_id == goal.id and goal.ended is None:
                    goal.accepted, goal.ended, goal.ended_s = True, status, now

    def _hear_accepted(self, goal_id: bytes, reply: Message, now: float) -> None:
        if reply.get("accepted"):
            self._alive(goal_id, now)
        elif self._goal is not None and goal_id == self._goal.id and not self._goal.accepted:
            self._goal.rejected = True

    def _hear_result(self, goal_id: bytes, reply: Message, now: float) -> None:
        goal, status = self._goal, reply.get("status")
        if goal is None or goal_id != goal.id or not isinstance(status, int):
            return
        if status in BY_STATUS:
            result = reply.get("result")
            goal.result = result if isinstance(result, Mapping) else {}
            goal.ended, goal.ended_s = status, now
        else:
            goal.forgotten = True

    def _hear_cancelled(self, goal_id: bytes, settled: bool, reply: Message) -> None:
        goal, code = self._goal, reply.get("return_code")
        if code == CANCEL_TERMINATED:
            self._given_up.pop(goal_id, None)
        if goal is None or goal_id != goal.id:
            return
        goal.refused = code == CANCEL_REJECTED
        # A request that was still on its way was not known then, either.
        goal.forgotten = goal.forgotten or code == CANCEL_TERMINATED or (code == CANCEL_UNKNOWN_GOAL and settled)

    def _hear_swept(self, reply: Message) -> None:
        """Which goals it ends; one that refuses is asked again."""
        listed = reply.get("goals_canceling")
        self._swept = self._swept or reply.get("return_code") != CANCEL_REJECTED
        for entry in listed if isinstance(listed, tuple) else ():
            self._stopping.add(_id(value_at(entry, "goal_id.uuid")))

    # --- what is done --------------------------------------------------------------------------------------------

    def _decide(self, goal: GoalRecord, now: float) -> GoalOutcome | None:
        if goal.ended is not None:
            return self._end(goal, now)
        if goal.rejected:
            if goal.stop_s is not None:
                return GoalOutcome(how="cancelled", what=goal.why)
            return GoalOutcome(how="rejected", what=f"{self.name} rejected the goal")
        if goal.sent_s is None:
            return self._set_out(goal, now)
        if self._is_gone(goal, now):
            return GoalOutcome(how="untold", what=f"{self.name} is gone: nothing answers any more", moving=True)
        if goal.stop_s is None:
            self._mind_limits(goal, goal.sent_s, now)
        if goal.stop_s is not None:
            return self._stop(goal, goal.sent_s, goal.stop_s, now)
        self._ask_result(goal, now)
        return None

    def _set_out(self, goal: GoalRecord, now: float) -> GoalOutcome | None:
        """Send it once a server is there: before, its reply would get lost."""
        if goal.stop_s is not None:
            return GoalOutcome(how="cancelled", what=goal.why)
        servers = self.servers()
        if servers > 1:
            if now - goal.begun_s <= TWO_S:
                return None
            return GoalOutcome(how="rejected", what=f"{servers} servers answer {self.name}: which robot would drive?")
        if servers == 1:
            goal.sending()
            try:
                self._sent[self._send.ask({"goal_id": {"uuid": goal.id}, "goal": goal.message})] = goal.id
            except Ros2Error as error:
                return GoalOutcome(how="rejected", what=f"a goal of {self.name} does not fit its type: {error}")
            goal.sent_s = goal.heard_s = now
        elif now - goal.begun_s > self._accept_s:
            return GoalOutcome(how="untold", what=f"nothing answers {self.name}")
        return None

    def _is_gone(self, goal: GoalRecord, now: float) -> bool:
        if self.servers() > 0:
            goal.absent_s = None
            return False
        goal.absent_s = now if goal.absent_s is None else goal.absent_s
        return now - goal.absent_s >= GONE_S

    def _mind_limits(self, goal: GoalRecord, sent_s: float, now: float) -> None:
        """Give a goal up that nobody seems to be at."""
        if goal.forgotten:
            self.cancel(f"{self.name} does not know the goal any more: it was started anew")
        elif not goal.accepted and now - sent_s > self._accept_s:
            self.cancel(f"{self.name} did not say within {self._accept_s:g} s whether it takes the goal")
        elif goal.accepted and self._quiet_s is not None and now - goal.heard_s > self._quiet_s:
            self.cancel(f"{self.name} was silent for {self._quiet_s:g} s")

    def _ask_result(self, goal: GoalRecord, now: float) -> None:
        """Once it is accepted; again where it seems that the answer, or the question, got lost."""
        asked_s = goal.asked_result_s
        silent = now - goal.heard_s >= RESULT_AGAIN_S or goal.ended is not None
        if goal.accepted and (asked_s is None or (silent and now - asked_s >= RESULT_AGAIN_S)):
            goal.asked_result_s = now
            self._asked[self._asked_of(self._result, {"goal_id": {"uuid": goal.id}})] = goal.id

    def _ask_cancel(self, goal_id: bytes, *, settled: bool) -> None:
        number = self._asked_of(self._cancel, {"goal_info": {"goal_id": {"uuid": goal_id}}})
        self._cancelled[number] = goal_id, settled

    @staticmethod
    def _asked_of(client: Client, request: Message) -> int:
        """Ask; what the network does not take is lost like any other, and asked again."""
        try:
            return client.ask(request)
        except Ros2Error:
            return _LOST

    def _stop(self, goal: GoalRecord, sent_s: float, stop_s: float, now: float) -> GoalOutcome | None:
        """Ask for its end until it is confirmed."""
        if goal.forgotten and goal.asked_cancel_s is not None:
            return GoalOutcome(how="cancelled", what=goal.why)
        if now - stop_s > CANCEL_S:
            said = "refuses to be cancelled" if goal.refused else "does not confirm that it was cancelled"
            begun = f"{goal.why}; then " if goal.why else ""
            return GoalOutcome(how="untold", what=f"{begun}{self.name} {said}", moving=True)
        if goal.asked_cancel_s is None or now - goal.asked_cancel_s >= CANCEL_AGAIN_S:
            goal.asked_cancel_s = now
            self._ask_cancel(goal.id, settled=goal.accepted or now - sent_s > self._accept_s)
        self._ask_result(goal, now)
        return None

    def _end(self, goal: GoalRecord, now: float) -> GoalOutcome | None:
        """Its last status is known; its result is, too, or is asked for and waited for a while."""
        assert goal.ended is not None  # noqa: S101  asked for where it is
        wanted = goal.result is None and (goal.stop_s is None or goal.ended == SUCCEEDED)
        if wanted and now - goal.ended_s < 2 * RESULT_AGAIN_S and self.servers() > 0:
            self._ask_result(goal, now)
            return None
        return GoalOutcome(how=BY_STATUS[goal.ended], result=goal.result or {}, what=goal.why)

    def _leave(self, goal: GoalRecord, now: float) -> None:
        """It is over here; where the robot may still be at it, that is not forgotten."""
        if goal.sent_s is not None and goal.ended is None:
            self._given_up[goal.id] = now - CANCEL_AGAIN_S


def _id(value: object) -> bytes:
    """The name of a goal; empty where there is none."""
    if isinstance(value, bytes):
        return value
    if isinstance(value, tuple) and all(isinstance(v, int) and 0 <= v < 256 for v in value):
        return bytes(value)
    return b""
