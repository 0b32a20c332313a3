"""The world of a simulation: what sensors would read, and what goes wrong (:mod:`.world_file` reads it from YAML).

A world names trees by id or by latitude and longitude, so that it does not depend on how a program numbers them.
Whether it fits a site and a robot is checked where it is used (:mod:`fieldhand.execution.drivers.groundtruth`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime


@dataclass(frozen=True, kw_only=True)
class Spot:
    """A tree, by its id or else as the one nearest to a position in degrees (WGS 84)."""

    id: str | None = None
    lat: float = 0.0
    lon: float = 0.0

    def __str__(self) -> str:
        return f"tree {self.id}" if self.id is not None else f"lat {self.lat}, lon {self.lon}"


@dataclass(frozen=True, kw_only=True)
class Truth:
    """Exact readings of a sensor, at some trees and everywhere else (None: drawn from the profile)."""

    default: float | None = None
    trees: tuple[tuple[Spot, float], ...] = ()


@dataclass(frozen=True, kw_only=True)
class ActionFails:
    """An action fails its first ``times`` attempts (None: always), at one tree or wherever it is tried."""

    action: str
    times: int | None = None
    at: Spot | None = None


@dataclass(frozen=True, kw_only=True)
class SensorSilent:
    """A capture succeeds but lacks a quantity."""

    quantity: str
    times: int | None = None
    at: Spot | None = None


@dataclass(frozen=True, kw_only=True)
class SensorAbsurd:
    """A sensor reads ``value``, whatever is there."""

    quantity: str
    value: float
    times: int | None = None
    at: Spot | None = None


@dataclass(frozen=True, kw_only=True)
class DriveFails:
    """A drive to a tree, or any drive, fails half-way for a reason that is not on the way: a motor, the navigation."""

    times: int | None = None
    at: Spot | None = None


@dataclass(frozen=True, kw_only=True)
class Blocked:
    """Something stands in the way: a leg that passes within ``within_m`` metres of it ends there.

    Attributes:
        at: The tree that it stands at; or else the two trees halfway between which it stands, ``between``.
        times: How many legs it ends before it is gone (None: any number).
        from_s, until_s: When it stands there, in seconds of the mission (None: to the end).
    """

    at: Spot | None = None
    between: tuple[Spot, Spot] | None = None
    within_m: float = 1.0
    times: int | None = None
    from_s: float = 0.0
    until_s: float | None = None


@dataclass(frozen=True, kw_only=True)
class LocalisationLost:
    """The robot does not know where it is for ``for_s`` seconds (None: never again).

    Attributes:
        at_s: When, in seconds of the mission; or else ``at`` which tree it comes within ``within_m`` metres of.
        times: At a tree: how often it happens there.
    """

    at_s: float | None = None
    at: Spot | None = None
    within_m: float = 5.0
    for_s: float | None = None
    times: int | None = 1


@dataclass(frozen=True, kw_only=True)
class BatteryDrains:
    """From ``from_s`` seconds on the battery empties ``factor`` times as fast as the profile says."""

    factor: float
    from_s: float = 0.0


@dataclass(frozen=True, kw_only=True)
class ClockJumps:
    """``at_s`` seconds into the mission somebody sets the wall clock by ``by_s`` seconds, back if that is negative."""

    at_s: float
    by_s: float


@dataclass(frozen=True, kw_only=True)
class DiskFull:
    """From ``at_s`` seconds into the mission nothing can be written any more."""

    at_s: float


@dataclass(frozen=True, kw_only=True)
class RobotStops:
    """The robot stops for good ``at_s`` seconds into the mission: a power cut, an emergency stop."""

    at_s: float
    why: str = "power cut"


WorldFault = (
    ActionFails
    | SensorSilent
    | SensorAbsurd
    | DriveFails
    | Blocked
    | LocalisationLost
    | BatteryDrains
    | ClockJumps
    | DiskFull
    | RobotStops
)


@dataclass(frozen=True, kw_only=True)
class World:
    """World of a simulation; whatever it leaves open is drawn from the profile and the seed.

    Attributes:
        readings: By quantity.
        seed: Of every random thing in it, where the run names none.
        charge_percent: Of the battery at the start.
        meter_step_percent: The battery's meter shows multiples of it; 0 for one that shows the charge as it is.
        begins: The time of day when a mission begins, with its zone; None for a robot without a wall clock.
        source: File, for messages.
        data: What the file held, byte by byte; None for a world from no file.
    """

    readings: Mapping[str, Truth] = field(default_factory=dict)
    faults: tuple[WorldFault, ...] = ()
    seed: int = 0
    charge_percent: float = 100.0
    meter_step_percent: float = 0.0
    begins: datetime | None = None
    source: str = "world"
    data: bytes | None = field(default=None, repr=False, compare=False)
