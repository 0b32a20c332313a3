"""What passes between robot and sender as JSON: models that one writes and the other reads.

A sender does not know what a later agent says beside this, and passes over it; an agent refuses what it does not know.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from fieldhand.delivery.received_status import LoggedEvent, ReceivedStatus, State
from fieldhand.execution.operator_commands import AgentCommand

#: Events in one answer.
MOST_EVENTS = 500
#: Seconds that an answer may wait for the next event.
LONGEST_WAIT_S = 25.0

Sha256 = Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]


class _Answer(BaseModel):
    model_config = ConfigDict(frozen=True)


class MissionSummary(_Answer):
    """A mission, and how it stands."""

    bundle: Sha256
    mission: str
    task: str
    request: str
    signer: str
    received_at: str
    begun_at: str | None
    state: State
    status: str
    reason: str
    doing: str
    lat: float | None
    lon: float | None
    charge_percent: float | None
    travelled_m: float
    events: int
    fault: str
    report: str = ""  # agents before it wrote none


class Receipt(_Answer):
    """What has arrived: the hashes of every byte, as the robot verified them."""

    hashes: dict[str, Sha256]
    new: bool
    mission: MissionSummary


class RobotState(_Answer):
    """The robot, and the missions that arrived last.

    Attributes:
        on: On what it carries missions out; empty where an older agent does not say.
        missing: What of the robot does not answer now, in words.
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
    """An event as the log of its mission has it."""

    n: int
    at: str
    line: str


class Events(_Answer):
    """Events in their order, without a gap behind what was asked for.

    Attributes:
        idle: Nobody carries the mission out, and no event comes behind these.
    """

    events: list[EventLine]
    idle: bool
    mission: MissionSummary


class CommandRequest(BaseModel):
    """What a mission is told."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    order: AgentCommand
    because: Annotated[str, Field(max_length=500)] = ""


class Heard(_Answer):
    """Whether the mission has heard the order, and how it stands."""

    heard: bool
    mission: MissionSummary


def mission_summary(standing: ReceivedStatus) -> MissionSummary:
    """A mission as it is told to others."""
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
    )


def event_lines(lines: tuple[LoggedEvent, ...]) -> list[EventLine]:
    """Events as they are told to others."""
    return [EventLine(n=line.n, at=line.at, line=line.line) for line in lines]
