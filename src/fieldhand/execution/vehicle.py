"""Vehicles, on which missions are carried out: a driver with its clocks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Literal

from fieldhand.clock import Clock, SimulatedWallClock, WallClock
from fieldhand.errors import OutputError
from fieldhand.execution.drivers.protocol import Driver
from fieldhand.execution.world import ClockJumps, DiskFull, World
from fieldhand.task.results import Event

if TYPE_CHECKING:
    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.model import Site

#: When a mission begins whose world sets the wall clock without saying when it began.
SOME_MORNING = datetime(2026, 1, 1, 6, 0, tzinfo=UTC)

#: What carries messages to a robot.
TransportName = Literal["dds", "rclpy"]

#: Takes each event of a mission.
Writer = Callable[[Event], None]


def _no_limit(write: Writer) -> Writer:
    return write


@dataclass(frozen=True, kw_only=True)
class Connection:
    """Connection to a robot over ROS 2, beside what its profile says.

    Attributes:
        domain: ROS's domain: robots and programs hear each other within one.
        namespace: In place of the profile's: empty, or ``/`` and a name; None for the profile's.
        sim_time: The robot is a simulation whose time stands on ``/clock``, also where its profile does not say so.
    """

    transport: TransportName
    domain: int = 0
    namespace: str | None = None
    sim_time: bool = False

    def __str__(self) -> str:
        at = f" as {self.namespace or '/'}" if self.namespace is not None else ""
        return f"{self.transport}, domain {self.domain}{at}"


@dataclass(frozen=True, kw_only=True)
class Vehicle:
    """A robot that is ready for a mission: real, or the simulation.

    Attributes:
        driver: In no goal.
        clock: What drives the mission's time; the driver's too.
        charge_percent: Of the battery when the mission begins: the guard reckons from it.
        wall: The time of day; None where there is none.
        by: How it is reached; None for the simulation.
        remark: What whoever begins a mission should know of it; empty where there is nothing.
        disk: What its disk makes of what is written on it: that of a simulation may be full.
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
        """True for a simulation. Resuming replays the mission to a new one; a real robot is where it is."""
        return self.by is None


def simulation(site: Site, robot: RobotProfile, world: World, *, seed: int, speed: float | None = None) -> Vehicle:
    """Create the simulated robot at the start of a site.

    Args:
        site, robot: Of the mission.
        world: What the sensors would read, and what goes wrong.
        seed: Of every random thing in it.
        speed: Simulated seconds in a second; None for as fast as it goes.

    Raises:
        WorldError: The world does not fit the site or the robot.
    """
    import numpy as np

    from fieldhand.clock import ScaledClock, SimulatedClock
    from fieldhand.execution.drivers.simulation import SimulatedDriver
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
    return SimulatedWallClock(clock, (world.begins or SOME_MORNING).timestamp(), jumps)


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
