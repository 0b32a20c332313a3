"""State and outcome of one goal of a ROS 2 action, and the resulting end of a drive or capture."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal

from fieldhand.execution.drivers.protocol import CapturedImage, GoalFault, GoalState
from fieldhand.execution.drivers.ros2.transport import RosMessage

#: Seconds without any server after which it counts as gone; shorter gaps occur in discovery.
GONE_S = 2.0
#: Seconds after which two servers count as two robots. A killed server remains visible for the ten seconds of its
#: lease, beside the one that replaces it.
TWO_S = 12.0
#: Values of ``action_msgs/msg/GoalStatus``.
ACCEPTED, EXECUTING, CANCELING, SUCCEEDED, CANCELED, ABORTED = range(1, 7)
#: Return codes of ``action_msgs/srv/CancelGoal``.
CANCEL_REJECTED, CANCEL_UNKNOWN_GOAL, CANCEL_TERMINATED = 1, 2, 3

#: How a goal ended. ``untold``: the server did not report it; see :attr:`ActionOutcome.what`.
OutcomeKind = Literal["succeeded", "aborted", "cancelled", "rejected", "untold"]

#: Condition of the server, as far as the end of a goal shows it: no server is visible, one that does not know the goal,
#: or one that rejected it; empty if it shows nothing.
ServerCondition = Literal["", "gone", "restarted", "rejects"]

#: Final statuses.
BY_STATUS: Mapping[int, OutcomeKind] = {SUCCEEDED: "succeeded", CANCELED: "cancelled", ABORTED: "aborted"}
#: Statuses of a goal that is still active.
BUSY = (ACCEPTED, EXECUTING, CANCELING)


@dataclass(frozen=True, kw_only=True)
class ActionOutcome:
    """Outcome of a goal.

    Attributes:
        result: Result message of the action; empty if there is none.
        what: Cause of a failure that the action itself does not report.
        moving: True if the robot did not confirm that it stopped executing the goal.
        server: Condition of the server.
    """

    how: OutcomeKind
    result: RosMessage = field(default_factory=dict)
    what: str = ""
    moving: bool = False
    server: ServerCondition = ""


@dataclass(frozen=True, kw_only=True)
class GoalEnd:
    """End of a drive or a capture, as reported by :class:`~fieldhand.execution.drivers.protocol.Progress`."""

    state: GoalState
    what: str = ""
    fault: GoalFault = "none"
    readings: Mapping[str, float] = field(default_factory=dict)
    images: tuple[CapturedImage, ...] = ()


@dataclass(kw_only=True)
class GoalRecord:
    """Everything known about a started goal. Times are seconds of the steady clock.

    Attributes:
        sending: Called just before the goal is sent.
        heard_s: Time of the last sign of life.
        absent_s: Time since which no server is visible.
        cancel_asked_s: Time at which cancellation was requested; ``why`` is the reason.
        forgotten: True if the server no longer knows the goal.
        restarted: True if that is why the goal was given up.
        ended: Final status, once known.
    """

    id: bytes
    message: RosMessage
    begun_s: float
    sending: Callable[[], None]
    sent_s: float | None = None
    accepted: bool = False
    rejected: bool = False
    heard_s: float = 0.0
    asked_result_s: float | None = None
    asked_cancel_s: float | None = None
    absent_s: float | None = None
    cancel_asked_s: float | None = None
    why: str = ""
    refused: bool = False
    forgotten: bool = False
    restarted: bool = False
    ended: int | None = None
    ended_s: float = 0.0
    result: RosMessage | None = None
