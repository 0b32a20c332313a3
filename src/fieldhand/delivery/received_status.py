"""The status of a mission on a robot, and the events of its log."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from fieldhand.delivery.received_missions import ReceivedMission

#: ``waiting``: it has arrived and was never begun. ``lost``: it was begun, and its folder is gone
#: or cannot be read.
State = Literal["waiting", "running", "paused", "interrupted", "ended", "lost"]


@dataclass(frozen=True, kw_only=True)
class ReceivedStatus:
    """The status of a received mission.

    Attributes:
        status: How it ended (``completed``, ...); empty before.
        reason: Why.
        doing: What it does, in words; empty before it was begun.
        events: How many are safe on the disk.
        fault: Why it could not be gone on with, or not reported, if that was so.
        report: Where its report lies on this machine; empty before it was written.
    """

    received: ReceivedMission
    state: State
    status: str = ""
    reason: str = ""
    doing: str = ""
    lat: float | None = None
    lon: float | None = None
    charge_percent: float | None = None
    travelled_m: float = 0.0
    events: int = 0
    fault: str = ""
    report: str = ""


@dataclass(frozen=True, kw_only=True)
class LoggedEvent:
    """An event from the log of a mission.

    Attributes:
        n: Its number, from 1, without a gap.
        at: When it was written, ISO 8601.
        line: JSON.
    """

    n: int
    at: str
    line: str
