"""An action server of a robot that does what a script says: the other end of the driver's state machines."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from fieldhand.execution.drivers.ros2.transport import STATUS_QOS, QosProfile, RosMessage, Transport

STATUS_OF = {"executing": 2, "succeeded": 4, "cancelled": 5, "aborted": 6}


@dataclass(frozen=True, kw_only=True)
class Script:
    """The course of one goal."""

    accepts: bool = True
    lasts_s: float = 5.0
    ends: Literal["succeeded", "aborted", "cancelled"] = "succeeded"
    result: RosMessage = field(default_factory=dict)
    feedback_every_s: float | None = 0.5
    cancels: bool = True
    cancel_takes_s: float = 0.5
    feedback: Callable[[], RosMessage] = dict
    on_step: Callable[[RosMessage, float], None] = lambda goal, part: None


@dataclass
class Served:
    """A goal that the server has taken."""

    id: bytes
    goal: RosMessage
    script: Script
    begun_s: float
    state: str = "executing"
    cancelled_s: float | None = None
    fed_s: float = 0.0
    askers: list[object] = field(default_factory=list)


class ScriptedAction:
    """Serves one action."""

    def __init__(
        self,
        node: Transport,
        name: str,
        type_name: str,
        now: Callable[[], float],
        script: Callable[[RosMessage], Script],
    ) -> None:
        self.now, self.script = now, script
        self.goals: dict[bytes, Served] = {}
        self.received: list[RosMessage] = []
        self._send = node.serve(f"{name}/_action/send_goal", f"{type_name}_SendGoal")
        self._result = node.serve(f"{name}/_action/get_result", f"{type_name}_GetResult")
        self._cancel = node.serve(f"{name}/_action/cancel_goal", "action_msgs/srv/CancelGoal")
        self._feedback = node.publish(f"{name}/_action/feedback", f"{type_name}_FeedbackMessage", QosProfile())
        self._status = node.publish(f"{name}/_action/status", "action_msgs/msg/GoalStatusArray", STATUS_QOS)

    def close(self) -> None:
        """The process of the server ends, in order."""
        for end in (self._send, self._result, self._cancel, self._feedback, self._status):
            end.close()

    @property
    def executing(self) -> list[Served]:
        return [g for g in self.goals.values() if g.state == "executing"]

    def step(self) -> None:
        now = self.now()
        for to, request in self._send.requests():
            self._take(to, request, now)
        for served in self.executing:
            self._advance(served, now)
        for to, request in self._cancel.requests():
            self._cancel.reply(to, self._cancelling(_plain(request).get("goal_info", {}), now))
        for to, request in self._result.requests():
            served = self.goals.get(_plain(request)["goal_id"]["uuid"])
            if served is None:
                self._result.reply(to, {"status": 0, "result": {}})
            else:
                served.askers.append(to)
                self._answer(served)

    def _take(self, to: object, request: RosMessage, now: float) -> None:
        whole = _plain(request)
        self.received.append(whole["goal"])
        script, goal_id = self.script(whole["goal"]), whole["goal_id"]["uuid"]
        accepted = script.accepts and goal_id not in self.goals
        if accepted:
            self.goals[goal_id] = Served(goal_id, whole["goal"], script, now)
            self._tell()
        self._send.reply(to, {"accepted": accepted, "stamp": {}})

    def _advance(self, served: Served, now: float) -> None:
        script, passed = served.script, now - served.begun_s
        script.on_step(served.goal, 1.0 if passed >= script.lasts_s else passed / script.lasts_s)
        if served.cancelled_s is not None and now >= served.cancelled_s + script.cancel_takes_s:
            self._end(served, "cancelled")
        elif passed >= script.lasts_s:
            self._end(served, script.ends)
        elif script.feedback_every_s is not None and now >= served.fed_s + script.feedback_every_s:
            served.fed_s = now
            self._feedback.send({"goal_id": {"uuid": served.id}, "feedback": script.feedback()})

    def _cancelling(self, goal_info: Mapping[str, Any], now: float) -> RosMessage:
        goal_id = goal_info.get("goal_id", {}).get("uuid", bytes(16))
        wanted = self.executing if goal_id == bytes(16) else [g for g in self.goals.values() if g.id == goal_id]
        if goal_id != bytes(16) and not wanted:
            return {"return_code": 2, "goals_canceling": ()}
        if wanted and all(g.state != "executing" for g in wanted):
            return {"return_code": 3, "goals_canceling": ()}
        willing = [g for g in wanted if g.script.cancels]
        for served in willing:
            served.cancelled_s = now if served.cancelled_s is None else served.cancelled_s
        listed = tuple({"goal_id": {"uuid": g.id}} for g in willing)
        return {"return_code": 1 if wanted and not willing else 0, "goals_canceling": listed}

    def _end(self, served: Served, state: str) -> None:
        served.state = state
        self._tell()
        self._answer(served)

    def _answer(self, served: Served) -> None:
        if served.state != "executing":
            result = served.script.result if served.state != "cancelled" else {}
            for to in served.askers:
                self._result.reply(to, {"status": STATUS_OF[served.state], "result": result})
            served.askers.clear()

    def _tell(self) -> None:
        listed = tuple(
            {"goal_info": {"goal_id": {"uuid": g.id}}, "status": STATUS_OF[g.state]} for g in self.goals.values()
        )
        self._status.send({"status_list": listed})


def _plain(message: RosMessage) -> Any:
    return message
