"""What is known of one goal of a ROS 2 action, how it ended, and what that means to a mission."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal

from fieldhand.execution.drivers.protocol import GoalFault, GoalState
from fieldhand.execution.drivers.ros2.transport import Message

#: Seconds without any server after which it is gone: shorter gaps are discovery's.
GONE_S = 2.0
#: Seconds after which two servers are two robots: one that was killed still seems to be there, for the ten seconds of
#: its lease, beside the one that took its place.
TWO_S = 12.0
#: ``action_msgs/msg/GoalStatus``.
ACCEPTED, EXECUTING, CANCELING, SUCCEEDED, CANCELED, ABORTED = range(1, 7)
#: ``action_msgs/srv/CancelGoal``.
CANCEL_REJECTED, CANCEL_UNKNOWN_GOAL, CANCEL_TERMINATED = 1, 2, 3

#: How a goal ended. ``untold``: nobody said; what is known stands in :attr:`GoalOutcome.what`.
OutcomeKind = Literal["succeeded", "aborted", "cancelled", "rejected", "untold"]

#: What is no more carried out.
BY_STATUS: Mapping[int, OutcomeKind] = {SUCCEEDED: "succeeded", CANCELED: "cancelled", ABORTED: "aborted"}
#: What is.
BUSY = (ACCEPTED, EXECUTING, CANCELING)


@dataclass(frozen=True, kw_only=True)
class GoalOutcome:
    """How a goal ended.

    Attributes:
        result: What the action said; empty where it said nothing.
        what: Why it did not succeed, where it is not the action that says so.
        moving: Nobody confirmed that the robot is not at it any more.
    """

    how: OutcomeKind
    result: Message = field(default_factory=dict)
    what: str = ""
    moving: bool = False


@dataclass(frozen=True, kw_only=True)
class GoalEnd:
    """What that means to a mission: the end of a drive or a capture, as
    :class:`~fieldhand.execution.drivers.protocol.Progress` tells it.
    """

    state: GoalState
    what: str = ""
    fault: GoalFault = "none"
    readings: Mapping[str, float] = field(default_factory=dict)


@dataclass(kw_only=True)
class GoalRecord:
    """What is known of a goal that was begun.

    Attributes:
        sending: Called just before it is sent.
        heard_s: When there was a sign of life.
        absent_s: Since when no server is there.
        stop_s: When its end was asked for, and why if by a limit.
        forgotten: The server does not know it any more.
        ended: Its status, once that is its last.
    """

    id: bytes
    message: Message
    begun_s: float
    sending: Callable[[], None]
    sent_s: float | None = None
    accepted: bool = False
    rejected: bool = False
    heard_s: float = 0.0
    asked_result_s: float | None = None
    asked_cancel_s: float | None = None
    absent_s: float | None = None
    stop_s: float | None = None
    why: str = ""
    refused: bool = False
    forgotten: bool = False
    ended: int | None = None
    ended_s: float = 0.0
    result: Message | None = None
