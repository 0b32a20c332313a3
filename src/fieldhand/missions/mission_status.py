"""Missions that are kept in a folder: carried out, gone on with, asked how they stand, told something."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand import mission
from fieldhand.errors import ExecutionError
from fieldhand.folders import is_locked
from fieldhand.language import message
from fieldhand.missions.direct_commands import latest
from fieldhand.missions.folder import (
    JOURNAL,
    LOG,
    ORDERS,
    REPORT,
    Departure,
    StoredMission,
    read_about,
    read_kept,
)
from fieldhand.task.event_lines import from_json
from fieldhand.task.results import Event

if TYPE_CHECKING:
    from fieldhand.evaluation.progress import MissionProgress
    from fieldhand.execution.guard import Guard
    from fieldhand.execution.mission_runner import Result
    from fieldhand.execution.operator_commands import FileCommand
    from fieldhand.execution.vehicle import Vehicle


@dataclass(frozen=True, kw_only=True)
class Status:
    """How a mission stands.

    Attributes:
        request: What was asked.
        last_event_at: When its last event was written, ISO 8601; empty before the first.
        order: An order that it has not heard yet.
        report: The page of its report in its folder; empty where none was written there.
    """

    mission: str
    request: str
    now: MissionProgress
    last_event_at: str
    order: str = ""
    report: str = ""


def carry_out(
    stored: StoredMission,
    *,
    speed: float | None = None,
    vehicle: Vehicle | None = None,
    emit: Callable[[Event], None],
    interrupted: Callable[[], str | None] = lambda: None,
    watched: Callable[[Guard], Guard] = lambda guard: guard,
) -> Result:
    """Carry a mission out, or go on with one that was cut off; one that has ended gives its result again.

    Args:
        stored: From :func:`open_mission`.
        vehicle: The robot on which it was begun; None for a mission in simulation, which is made here.
        speed: Of the simulation, as :func:`fieldhand.execution.drivers.simulation.vehicle.simulation`.
        emit: Takes each event that is new, once it is safe on the disk; :func:`events_of` gives those before.
        interrupted, watched: As :func:`fieldhand.mission.carry_out`.

    Raises:
        ExecutionError: It was begun on a robot and this is the simulation, or the other way round.
        JournalError: Another process carries it out; its journal is damaged, of another mission or does not fit; the
            disk is full.
    """
    from fieldhand.execution.drivers.simulation.vehicle import simulation
    from fieldhand.execution.journal.store import Journal
    from fieldhand.execution.operator_commands import CommandFile

    require_vehicle(stored.id, stored.departure, simulated=vehicle is None or vehicle.simulated)
    if vehicle is None:
        vehicle = simulation(stored.site, stored.robot, stored.world, seed=stored.seed, speed=speed)
    elif stored.departure is not None:
        vehicle = replace(vehicle, charge_percent=stored.departure.charge_percent)
    write = vehicle.disk(emit)

    def tell(line: str) -> None:
        event = from_json(line)
        if event is not None:
            write(event)

    folder = stored.folder
    with (
        Journal(folder / JOURNAL, stored.sha256, folder / LOG, tell) as journal,
        closing(CommandFile(folder / ORDERS)) as order_file,
    ):
        approved = mission.ApprovedMission(authorized=stored.authorized, site=stored.site, robot=stored.robot)
        run = mission.carry_out(
            approved,
            vehicle=vehicle,
            seed=stored.seed,
            emit=emit,
            interrupted=interrupted,
            watched=watched,
            orders=latest(stored.told, order_file.current),
            log=journal,
        )
        return run.result


def require_vehicle(name: str, departure: Departure | None, *, simulated: bool) -> None:
    """Refuse to go on with a mission of a robot in simulation, and with one of the simulation on a robot.

    Args:
        name: The mission's.
        departure: On which robot it was begun.
        simulated: Whether it is to be gone on with in simulation.

    Raises:
        ExecutionError: It is to be.
    """
    if departure is None and not simulated:
        raise ExecutionError(
            message("the mission was begun in simulation and cannot be gone on with on a robot"),
            where=name,
            advice=message("resume it without --on, or carry the Task out on the robot as a new mission"),
        )
    if departure is not None and simulated:
        raise ExecutionError(
            message(
                "the mission was begun on a robot ({by}) and cannot be gone on with in simulation", by=str(departure.by)
            ),
            where=name,
            advice=message("resume it on that robot"),
        )


def status(folder: Path) -> Status:
    """How a mission stands, from what is safe on the disk; asks nothing of who carries it out.

    Raises:
        JournalError: This is no mission, or its journal cannot be read.
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
    waiting, said = CommandFile(folder / ORDERS).last()
    return Status(
        mission=folder.name,
        request=task.command.request,
        now=now,
        last_event_at=lines[-1][0] if lines else "",
        order=said if waiting > number and now.state != "ended" else "",
        report=str(folder / REPORT) if (folder / REPORT).is_file() else "",
    )


def stands_still(folder: Path) -> bool:
    """Whether the robot was in no goal when it was last seen; a pause may take a moment until it is so.

    Raises:
        JournalError: This is no mission, or its journal cannot be read.
    """
    from fieldhand.execution.journal.records import observation_of
    from fieldhand.execution.journal.store import read_summary

    sight = read_summary(folder / JOURNAL)[2]
    return sight is None or observation_of(sight).progress.over


def events_of(folder: Path) -> tuple[Event, ...]:
    """The events of a mission that are safe on the disk.

    Raises:
        JournalError: The journal cannot be read.
    """
    from fieldhand.execution.journal.store import read_summary

    events = (from_json(line, where=str(folder)) for _, line in read_summary(folder / JOURNAL)[1])
    return tuple(event for event in events if event is not None)


def lines_after(folder: Path, after: int, most: int) -> tuple[tuple[int, str, str], ...]:
    """(number, time, line) of the events of a mission behind number ``after``, for who follows it from elsewhere.

    Raises:
        JournalError: The journal cannot be read.
    """
    from fieldhand.execution.journal.store import lines_after

    return lines_after(folder / JOURNAL, after, most)


def order(
    folder: Path, said: FileCommand, reason: str, *, wait: Callable[[], bool] = lambda: False
) -> bool:  # fmt: skip
    """Tell a mission something: to pause, to continue, to come home (``return``) or to stop here (``abort``).

    Args:
        reason: Who wants it, or why.
        wait: Waits a moment, and says whether to wait longer for the answer.

    Returns:
        Whether the mission has heard it. One that is cut off hears it when it is resumed.

    Raises:
        ExecutionError: It has ended, or was told to stop before.
        JournalError: This is no mission.
    """
    from fieldhand.execution.journal.store import read_summary
    from fieldhand.execution.operator_commands import CommandFile
    from fieldhand.task.results import Ended

    if any(isinstance(event, Ended) for event in events_of(folder)):
        raise ExecutionError(message("the mission has ended"), where=folder.name)
    number = CommandFile(folder / ORDERS).give(said, reason)
    while is_locked(folder):
        if read_summary(folder / JOURNAL)[0] >= number:
            return True
        if not wait():
            break
    return read_summary(folder / JOURNAL)[0] >= number


def last_order(folder: Path) -> str:
    """What a mission was told last; empty if it was told nothing.

    Raises:
        JournalError: This is no mission.
    """
    from fieldhand.execution.operator_commands import CommandFile

    return CommandFile(folder / ORDERS).last()[1]


def is_running(folder: Path) -> bool:
    """Return True if a process is carrying the mission out."""
    return is_locked(folder)
