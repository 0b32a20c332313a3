"""Models of the JSON that agent and sender exchange.

A sender ignores fields that it does not know, so that later agents may add some; an agent refuses unknown fields.
"""

from __future__ import annotations

from datetime import datetime
from typing import Annotated

from pydantic import AwareDatetime, BaseModel, ConfigDict, Field

from fieldhand.compatibility import UTC
from fieldhand.delivery.received_status import LoggedEvent, ReceivedState, ReceivedStatus
from fieldhand.execution.operator_commands import AgentCommand
from fieldhand.timetable.runs import DueRun

#: Largest number of events in a response.
MOST_EVENTS = 500
#: Seconds for which a response may wait for the next event.
LONGEST_WAIT_S = 25.0

Sha256 = Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]


class _Answer(BaseModel):
    model_config = ConfigDict(frozen=True)


class MissionSummary(_Answer):
    """A mission and its state."""

    bundle: Sha256
    mission: str
    task: str
    request: str
    signer: str
    received_at: str
    begun_at: str | None
    state: ReceivedState
    status: str
    reason: str
    doing: str
    lat: float | None
    lon: float | None
    charge_percent: float | None
    travelled_m: float
    events: int
    fault: str
    report: str = ""  # older agents do not send it
    of: Sha256 | None = None
    due: str = ""


class RunSummary(_Answer):
    """A run that lies ahead. Times are ISO 8601, UTC."""

    due: str
    latest: str
    done_by: str = ""


class Runs(_Answer):
    """The runs of a mission with a timetable: the next ones, and the last ones with their state."""

    mission: MissionSummary
    next: list[RunSummary]
    last: list[MissionSummary]


class Receipt(_Answer):
    """The receipt of a mission: the hashes that the robot verified."""

    hashes: dict[str, Sha256]
    new: bool
    mission: MissionSummary


class RobotState(_Answer):
    """The robot, and the missions that arrived last.

    Attributes:
        on: Driver of its missions; empty for older agents.
        missing: Parts of the robot that do not respond, in words.
    """

    robot: str
    robot_sha256: str
    sites: list[str]
    version: str
    on: str = ""
    missing: list[str] = []
    active: Sha256 | None
    missions: list[MissionSummary]


class EventLine(_Answer):
    """An event in the log of a mission."""

    n: int
    at: str
    line: str


class Events(_Answer):
    """Events in order, without a gap after the requested number.

    Attributes:
        idle: True if no process carries the mission out and these events are the last ones.
    """

    events: list[EventLine]
    idle: bool
    mission: MissionSummary


class CommandRequest(BaseModel):
    """A command to a mission."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    order: AgentCommand
    because: Annotated[str, Field(max_length=500)] = ""
    due: Annotated[AwareDatetime | None, Field(description="With cancel: the one run to leave out.")] = None


class CommandResponse(_Answer):
    """The response to a command: True if the mission has received it, and the state of the mission."""

    heard: bool
    mission: MissionSummary


def mission_summary(standing: ReceivedStatus) -> MissionSummary:
    """Return the model of a mission's state."""
    received = standing.received
    return MissionSummary(
        bundle=received.sha256,
        mission=received.name,
        task=received.task,
        request=received.request,
        signer=received.signer,
        received_at=received.received_at,
        begun_at=received.begun_at,
        state=standing.state,
        status=standing.status,
        reason=standing.reason,
        doing=standing.doing,
        lat=standing.lat,
        lon=standing.lon,
        charge_percent=standing.charge_percent,
        travelled_m=standing.travelled_m,
        events=standing.events,
        fault=standing.fault,
        report=standing.report,
        of=None if received.run is None else received.run.of,
        due="" if received.run is None else utc_text(datetime.fromtimestamp(received.run.due, UTC)),
    )


def run_summary(run: DueRun) -> RunSummary:
    """Return the model of a run that lies ahead."""
    done_by = "" if run.done_by is None else utc_text(run.done_by)
    return RunSummary(due=utc_text(run.due), latest=utc_text(run.latest), done_by=done_by)


def utc_text(at: datetime) -> str:
    """Return an instant as ISO 8601 in UTC, to the second."""
    return at.astimezone(UTC).isoformat(timespec="seconds")


def event_lines(lines: tuple[LoggedEvent, ...]) -> list[EventLine]:
    """Return the models of events."""
    return [EventLine(n=line.n, at=line.at, line=line.line) for line in lines]
