"""Carry out a stored mission, or resume it after an interruption."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from typing import TYPE_CHECKING

from fieldhand import mission
from fieldhand.errors import ExecutionError
from fieldhand.language import message
from fieldhand.missions.direct_commands import latest
from fieldhand.missions.folder import JOURNAL, LOG, ORDERS, RobotAtStart, StoredMission
from fieldhand.task.event_lines import from_json
from fieldhand.task.results import Event

if TYPE_CHECKING:
    from fieldhand.execution.guard import Guard
    from fieldhand.execution.mission_runner import Result
    from fieldhand.execution.vehicle import Vehicle


def carry_out(
    stored: StoredMission,
    *,
    speed: float | None = None,
    vehicle: Vehicle | None = None,
    emit: Callable[[Event], None],
    interrupted: Callable[[], str | None] = lambda: None,
    watched: Callable[[Guard], Guard] = lambda guard: guard,
) -> Result:
    """Carry out a mission, or the rest of an interrupted one; of a mission that has ended, return its result.

    Args:
        stored: Mission from :func:`begin` or :func:`open_mission`.
        vehicle: Robot on which the mission was begun; None to simulate it.
        speed: Simulated seconds per second; None for as fast as possible.
        emit: Called with each new event once it is on disk; :func:`events_of` returns the earlier ones.
        interrupted: As for :func:`fieldhand.mission.carry_out`.
        watched: As for :func:`fieldhand.mission.carry_out`.

    Raises:
        ExecutionError: The mission was begun on a robot and would be simulated, or the other way round.
        JournalError: Another process is carrying it out; its journal is damaged or of another mission; the replay
            differs from the journal; or the disk is full.
    """
    from fieldhand.execution.drivers.simulation.vehicle import simulation
    from fieldhand.execution.journal.store import Journal
    from fieldhand.execution.operator_commands import CommandFile

    require_vehicle(stored.id, stored.started_on, simulated=vehicle is None or vehicle.simulated)
    if vehicle is None:
        vehicle = simulation(stored.site, stored.robot, stored.world, seed=stored.seed, speed=speed)
    elif stored.started_on is not None:
        vehicle = replace(vehicle, charge_percent=stored.started_on.charge_percent)
    write = vehicle.disk(emit)

    def write_line(line: str) -> None:
        event = from_json(line)
        if event is not None:
            write(event)

    folder = stored.folder
    with (
        Journal(folder / JOURNAL, stored.sha256, folder / LOG, write_line) as journal,
        closing(CommandFile(folder / ORDERS)) as command_file,
    ):
        approved = mission.ApprovedMission(authorized=stored.authorized, site=stored.site, robot=stored.robot)
        run = mission.carry_out(
            approved,
            vehicle=vehicle,
            seed=stored.seed,
            emit=emit,
            interrupted=interrupted,
            watched=watched,
            orders=latest(stored.direct_command, command_file.current),
            log=journal,
            images=folder,
        )
        return run.result


def require_vehicle(name: str, started_on: RobotAtStart | None, *, simulated: bool) -> None:
    """Require that a mission of a robot is resumed on a robot, and a simulated one in simulation.

    Args:
        name: Name of the mission.
        started_on: Robot on which it was begun; None for the simulation.
        simulated: True to resume it in simulation.

    Raises:
        ExecutionError: It was begun on the other kind.
    """
    if started_on is None and not simulated:
        raise ExecutionError(
            message("the mission was started in simulation and cannot be continued on a robot"),
            where=name,
            advice=message("resume it without --on, or run the Task on the robot as a new mission"),
        )
    if started_on is not None and simulated:
        raise ExecutionError(
            message(
                "the mission was started on a robot ({by}) and cannot be continued in simulation",
                by=str(started_on.by),
            ),
            where=name,
            advice=message("resume it on that robot"),
        )
