"""The simulated robot as a vehicle for a mission: its driver, its clocks and its disk."""

from __future__ import annotations

from datetime import datetime

import numpy as np

from fieldhand.clock import Clock, ScaledClock, SimulatedClock, SimulatedWallClock, WallClock
from fieldhand.compatibility import UTC
from fieldhand.errors import OutputError
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import ClockJumps, DiskFull, World
from fieldhand.execution.mission_clock import MissionClock
from fieldhand.execution.vehicle import Vehicle, Writer
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.results import Event

#: Start of a mission whose world changes the wall clock without defining when the mission begins.
DEFAULT_START = datetime(2026, 1, 1, 6, 0, tzinfo=UTC)


def simulation(site: Site, robot: RobotProfile, world: World, *, seed: int, speed: float | None = None) -> Vehicle:
    """Create the simulated robot at the start of a site.

    Args:
        site, robot: Site and profile of the mission.
        world: Sensor readings and faults.
        seed: Random seed.
        speed: Simulated seconds per second; None for as fast as possible.

    Raises:
        WorldError: The world does not fit the site or the robot.
    """
    clock = MissionClock(SimulatedClock() if speed is None else ScaledClock(speed))
    return Vehicle(
        driver=SimulatedDriver(site, robot, world, clock, np.random.default_rng(seed)),
        clock=clock,
        charge_percent=world.charge_percent,
        wall=_wall_clock_of(world, clock),
        disk=lambda write: _writing_in(world, write),
        robot=robot,
    )


def _wall_clock_of(world: World, clock: Clock) -> WallClock | None:
    """Return the time of day in a world, or None if the world defines none."""
    jumps = [(fault.at_s, fault.by_s) for fault in world.faults if isinstance(fault, ClockJumps)]
    if world.begins is None and not jumps:
        return None
    return SimulatedWallClock(clock, (world.begins or DEFAULT_START).timestamp(), jumps)


def _writing_in(world: World, write: Writer) -> Writer:
    """Return a writer that fails once the world's disk is full."""
    full_s = min((fault.at_s for fault in world.faults if isinstance(fault, DiskFull)), default=None)
    if full_s is None:
        return write

    def until_full(event: Event) -> None:
        if event.t >= full_s:
            raise OutputError(
                "the event log cannot be written: no space left on the disk",
                where=f"{event.t:.0f} s into the mission",
                advice="the robot was stopped where it was; free some space; what was written before is kept",
            )
        write(event)

    return until_full
