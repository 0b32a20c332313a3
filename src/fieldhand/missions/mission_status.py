"""The state and the events of a stored mission, read from its folder by any process."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.folders import is_locked
from fieldhand.missions.folder import JOURNAL, ORDERS, REPORT, read_about, read_kept
from fieldhand.task.event_lines import from_json
from fieldhand.task.results import Event

if TYPE_CHECKING:
    from fieldhand.evaluation.progress import MissionProgress


@dataclass(frozen=True, kw_only=True)
class Status:
    """The status of a stored mission.

    Attributes:
        mission: Name of the mission.
        request: Request that it was planned from.
        now: State, position, progress and limits.
        last_event_at: Time of its last event, ISO 8601; empty before the first one.
        order: Command that it has not received yet; empty if there is none.
        report: Path of its report; empty if none was written to its folder.
    """

    mission: str
    request: str
    now: MissionProgress
    last_event_at: str
    order: str = ""
    report: str = ""


def status(folder: Path) -> Status:
    """Return the status of a mission from its folder, without contacting the process that carries it out.

    Raises:
        JournalError: The folder is not that of a mission, or its journal cannot be read.
    """
    from fieldhand.evaluation.progress import mission_progress
    from fieldhand.execution.journal.records import observation_of
    from fieldhand.execution.journal.store import read_summary
    from fieldhand.execution.operator_commands import CommandFile
    from fieldhand.robot.loader import parse_profile
    from fieldhand.task.codec import decode

    about, _ = read_about(folder)
    running = is_locked(folder)
    number, lines, sight, _ = read_summary(folder / JOURNAL)
    events = tuple(e for e in (from_json(line, where=str(folder)) for _, line in lines) if e is not None)
    task = decode(read_kept(folder, "task.xml", about["files"]["task.xml"]), source=str(folder / "task.xml"))
    robot = parse_profile(read_kept(folder, "robot.yaml", about["files"]["robot.yaml"]), source=f"{folder}/robot.yaml")
    now = mission_progress(task, robot, events, running=running)
    if sight is not None and now.state != "ended":
        seen = observation_of(sight)
        now = replace(
            now,
            lat=seen.position.lat,
            lon=seen.position.lon,
            seconds=max(now.seconds, seen.t),
            charge_percent=seen.charge_percent,
        )
    waiting, command = CommandFile(folder / ORDERS).last()
    return Status(
        mission=folder.name,
        request=task.command.request,
        now=now,
        last_event_at=lines[-1][0] if lines else "",
        order=command if waiting > number and now.state != "ended" else "",
        report=str(folder / REPORT) if (folder / REPORT).is_file() else "",
    )


def stands_still(folder: Path) -> bool:
    """Return True if the robot had no goal when it was last observed; a pause may take a moment to get there.

    Raises:
        JournalError: The folder is not that of a mission, or its journal cannot be read.
    """
    from fieldhand.execution.journal.records import observation_of
    from fieldhand.execution.journal.store import read_summary

    sight = read_summary(folder / JOURNAL)[2]
    return sight is None or observation_of(sight).progress.over


def events_of(folder: Path) -> tuple[Event, ...]:
    """Return the events of a mission that are on disk.

    Raises:
        JournalError: The journal cannot be read.
    """
    from fieldhand.execution.journal.store import read_summary

    events = (from_json(line, where=str(folder)) for _, line in read_summary(folder / JOURNAL)[1])
    return tuple(event for event in events if event is not None)


def lines_after(folder: Path, after: int, most: int) -> tuple[tuple[int, str, str], ...]:
    """Return number, time and JSON line of the events of a mission after number ``after``, at most ``most``.

    Raises:
        JournalError: The journal cannot be read.
    """
    from fieldhand.execution.journal.store import lines_after

    return lines_after(folder / JOURNAL, after, most)


def is_running(folder: Path) -> bool:
    """Return True if a process is carrying the mission out."""
    return is_locked(folder)
