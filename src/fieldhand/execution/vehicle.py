"""Vehicles on which missions run: a driver with its clocks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from fieldhand.clock import Clock, WallClock
from fieldhand.execution.drivers.protocol import Driver
from fieldhand.robot.model import RobotProfile
from fieldhand.task.results import Event

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
        robot: Profile with which it was connected; None if unknown. Missions for another robot are refused.
    """

    driver: Driver
    clock: Clock
    charge_percent: float
    wall: WallClock | None = None
    by: Connection | None = None
    remark: str = ""
    disk: Callable[[Writer], Writer] = _no_limit
    robot: RobotProfile | None = None

    @property
    def simulated(self) -> bool:
        """True for a simulation: resuming replays the mission to a new one, while a real robot stays where it is."""
        return self.by is None
