"""Vehicles on which missions run: a driver with its clocks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from fieldhand.clock import Clock, SimulatedWallClock, WallClock
from fieldhand.errors import OutputError
from fieldhand.execution.drivers.protocol import Driver
from fieldhand.execution.world import ClockJumps, DiskFull, World
from fieldhand.task.results import Event

if TYPE_CHECKING:
    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.model import Site

#: Start of a mission whose world changes the wall clock without defining when the mission begins.
DEFAULT_START = datetime(2026, 1, 1, 6, 0, tzinfo=UTC)

#: Receives the events of a mission.
Writer = Callable[[Event], None]


def _no_limit(write: Writer) -> Writer:
    return write


@dataclass(frozen=True, kw_only=True)
class Connection:
    """Connection to a robot; overrides its profile.

    Attributes:
        transport: Name of the driver (:mod:`fieldhand.execution.drivers.registry`).
        domain: ROS domain id.
        namespace: Namespace in place of the profile's: empty, or ``/`` and a name; None for the profile's.
        sim_time: True for a simulation that publishes ``/clock``, even if its profile does not say so.
        options: Options of a plugin's driver, by name.
    """

    transport: str
    domain: int = 0
    namespace: str | None = None
    sim_time: bool = False
    options: Mapping[str, str] = field(default_factory=dict)

    def __str__(self) -> str:
        if self.options:
            return f"{self.transport}, {', '.join(f'{name}={value}' for name, value in self.options.items())}"
        at = f" as {self.namespace or '/'}" if self.namespace is not None else ""
        return f"{self.transport}, domain {self.domain}{at}"


@dataclass(frozen=True, kw_only=True)
class Vehicle:
    """A robot that is ready for a mission: real or simulated.

    Attributes:
        driver: Driver without a running goal.
        clock: Clock of the mission and the driver.
        charge_percent: Battery charge at the beginning, on which the guard bases its budget.
        wall: Time of day; None if there is none.
        by: How the robot is reached; None for the simulation.
        remark: Remark for the operator; empty if there is none.
        disk: Wraps the event writer; a simulated disk may be full.
    """

    driver: Driver
    clock: Clock
    charge_percent: float
    wall: WallClock | None = None
    by: Connection | None = None
    remark: str = ""
    disk: Callable[[Writer], Writer] = _no_limit

    @property
    def simulated(self) -> bool:
        """True for a simulation: resuming replays the mission to a new one, while a real robot stays where it is."""
        return self.by is None


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
    import numpy as np

    from fieldhand.clock import ScaledClock, SimulatedClock
    from fieldhand.execution.drivers.simulated_driver import SimulatedDriver
    from fieldhand.execution.mission_clock import MissionClock

    clock = MissionClock(SimulatedClock() if speed is None else ScaledClock(speed))
    return Vehicle(
        driver=SimulatedDriver(site, robot, world, clock, np.random.default_rng(seed)),
        clock=clock,
        charge_percent=world.charge_percent,
        wall=_wall_clock_of(world, clock),
        disk=lambda write: _writing_in(world, write),
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
                advice="the robot was stopped where it was; make room, what was written before is kept",
            )
        write(event)

    return until_full
