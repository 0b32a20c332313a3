"""The status of a mission on a robot, and the events of its log."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from fieldhand.delivery.received_missions import ReceivedMission

#: ``waiting``: received, and never begun. ``lost``: begun, and its folder is missing or unreadable. ``scheduled``: its
#: timetable is kept. ``missed``: a run that did not begin.
ReceivedState = Literal["waiting", "scheduled", "running", "paused", "interrupted", "ended", "lost", "missed"]


@dataclass(frozen=True, kw_only=True)
class ReceivedStatus:
    """The status of a received mission.

    Attributes:
        received: The mission.
        state: State of the mission.
        status: Final status (``completed``, ...); empty before the end.
        reason: Reason of the final status.
        doing: Current action in words; empty before it was begun.
        lat: Latitude of the robot, in degrees.
        lon: Longitude of the robot, in degrees.
        charge_percent: Charge of the battery, in percent.
        travelled_m: Distance driven, in metres.
        events: Number of events on disk.
        fault: Reason why it could not be resumed or reported; empty if there is none.
        report: Path of its report on the robot; empty before it is written.
    """

    received: ReceivedMission
    state: ReceivedState
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
        n: Number of the event, from 1, without gaps.
        at: Time at which it was logged, ISO 8601.
        line: The event as JSON.
    """

    n: int
    at: str
    line: str
