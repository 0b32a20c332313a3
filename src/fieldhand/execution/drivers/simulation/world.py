"""World of a simulation: sensor readings and faults (:mod:`.world_file` reads it from YAML).

A world refers to trees by id or by latitude and longitude, independent of how a program numbers them. Whether it fits a
site and a robot is checked where it is used (:mod:`fieldhand.execution.drivers.simulation.ground_truth`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime


@dataclass(frozen=True, kw_only=True)
class TreeRef:
    """Reference to a tree: by id, or as the tree nearest to a position in degrees (WGS 84)."""

    id: str | None = None
    lat: float = 0.0
    lon: float = 0.0

    def __str__(self) -> str:
        return f"tree {self.id}" if self.id is not None else f"lat {self.lat}, lon {self.lon}"


@dataclass(frozen=True, kw_only=True)
class Truth:
    """Exact readings of a sensor, at some trees and elsewhere (None: drawn from the profile)."""

    default: float | None = None
    trees: tuple[tuple[TreeRef, float], ...] = ()


@dataclass(frozen=True, kw_only=True)
class ActionFails:
    """An action fails its first ``times`` attempts (None: always), at one tree or everywhere."""

    action: str
    times: int | None = None
    at: TreeRef | None = None


@dataclass(frozen=True, kw_only=True)
class SensorSilent:
    """A capture succeeds but lacks a quantity."""

    quantity: str
    times: int | None = None
    at: TreeRef | None = None


@dataclass(frozen=True, kw_only=True)
class SensorAbsurd:
    """A sensor reads ``value`` regardless of the true value."""

    quantity: str
    value: float
    times: int | None = None
    at: TreeRef | None = None


@dataclass(frozen=True, kw_only=True)
class DriveFails:
    """A drive to a tree, or any drive, fails half-way for a reason other than an obstacle: a motor, the navigation."""

    times: int | None = None
    at: TreeRef | None = None


@dataclass(frozen=True, kw_only=True)
class RobotStrays:
    """The robot leaves its way by ``by_m`` metres in the middle of a drive to a tree, or of any drive, and comes back.

    It strays to the right, seen in the direction of travel; to the left if negative.
    """

    by_m: float
    times: int | None = None
    at: TreeRef | None = None


@dataclass(frozen=True, kw_only=True)
class Blocked:
    """An obstacle: a leg that passes within ``within_m`` metres of it ends there.

    Attributes:
        at: Tree at which it stands; otherwise ``between``, two trees halfway between which it stands.
        east_m, north_m: Metres from there to it.
        times: Number of legs it ends before it is gone (None: unlimited).
        recovers: The robot's navigation recovers and tries again for ever; a simulation without one notices at once
            that it comes no nearer.
        from_s, until_s: Interval in seconds of the mission (None: to the end).
    """

    at: TreeRef | None = None
    between: tuple[TreeRef, TreeRef] | None = None
    within_m: float = 1.0
    times: int | None = None
    from_s: float = 0.0
    until_s: float | None = None
    recovers: bool = False
    east_m: float = 0.0
    north_m: float = 0.0


@dataclass(frozen=True, kw_only=True)
class GoalClicked:
    """Another client of a simulated robot over ROS 2 sends a goal to its navigation, as a click in RViz does.

    Attributes:
        at: Tree at which the goal lies.
        after_m: Metres that the robot has driven before.
    """

    at: TreeRef
    after_m: float = 0.0


@dataclass(frozen=True, kw_only=True)
class GoalUnexplained:
    """The navigation of a simulated robot over ROS 2 ends a goal, and gives no reason.

    Attributes:
        after_m: Metres that the robot has driven before.
        times: Number of goals that it ends, each as soon as it begins but for the first.
    """

    after_m: float = 0.0
    times: int = 1


@dataclass(frozen=True, kw_only=True)
class NavigatorDies:
    """The navigator of a simulated robot over ROS 2 dies, while its controller follows the last path on.

    Attributes:
        after_m: Metres that the robot has driven before.
        down_s: Seconds until it is there again, inactive (None: never).
        inactive_s: Seconds after that until it is activated (None: only if somebody does so).
    """

    after_m: float = 0.0
    down_s: float | None = 2.0
    inactive_s: float | None = 5.0


@dataclass(frozen=True, kw_only=True)
class LocalisationLost:
    """The robot's position is lost for ``for_s`` seconds (None: for good).

    Attributes:
        at_s: Time in seconds of the mission; otherwise ``at``, a tree, when the robot comes within ``within_m`` metres.
        times: Number of times it happens at a tree.
    """

    at_s: float | None = None
    at: TreeRef | None = None
    within_m: float = 5.0
    for_s: float | None = None
    times: int | None = 1


@dataclass(frozen=True, kw_only=True)
class BatteryDrains:
    """From ``from_s`` seconds on, the battery empties ``factor`` times as fast as the profile says."""

    factor: float
    from_s: float = 0.0


@dataclass(frozen=True, kw_only=True)
class ClockJumps:
    """The wall clock is changed by ``by_s`` seconds, backwards if negative, ``at_s`` seconds into the mission."""

    at_s: float
    by_s: float


@dataclass(frozen=True, kw_only=True)
class DiskFull:
    """From ``at_s`` seconds into the mission on, nothing can be written."""

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
    | RobotStrays
    | Blocked
    | GoalClicked
    | GoalUnexplained
    | NavigatorDies
    | LocalisationLost
    | BatteryDrains
    | ClockJumps
    | DiskFull
    | RobotStops
)


@dataclass(frozen=True, kw_only=True)
class ScriptedEvent:
    """An event of the robot's profile that occurs in the simulation, or whose sensor is silent.

    Attributes:
        event: Name of the event.
        value: Value of a measured event; 1 for one that is true or false.
        silent: The sensor reports nothing.
        from_s, until_s: Interval in seconds of the mission in which it can occur (None: to the end).
        at: Tree within ``within_m`` metres of which the robot must be.
        for_s: Duration in seconds from the first time that the robot is there, or from the beginning of a period; None
            for as long as it is there, or for the whole period.
        chance: Probability that it occurs in each period of ``every_s`` seconds; None for always.
    """

    event: str
    value: float = 1.0
    silent: bool = False
    from_s: float = 0.0
    until_s: float | None = None
    at: TreeRef | None = None
    within_m: float = 5.0
    for_s: float | None = None
    chance: float | None = None
    every_s: float = 60.0


@dataclass(frozen=True, kw_only=True)
class Localisation:
    """Error of the position that the robot knows, by which it steers.

    Attributes:
        drift_m_per_100_m: Metres by which the error grows per 100 m driven.
        toward_deg: Its direction in degrees clockwise from north; None to draw it by the seed.
        noise_m: Standard deviation of each fix in metres, east and north.
        fix_drifts: False if fixes show where the robot is, and only the pose by which it steers drifts.
    """

    drift_m_per_100_m: float = 0.0
    toward_deg: float | None = None
    noise_m: float = 0.0
    fix_drifts: bool = True


@dataclass(frozen=True, kw_only=True)
class World:
    """World of a simulation; what it leaves open is drawn from the profile and the seed.

    Attributes:
        readings: Readings by quantity.
        events: Events that occur; of several for one event that occur at a time, the last counts.
        seed: Random seed, unless the run gives one.
        charge_percent: Battery charge at the start.
        meter_step_percent: Resolution of the battery meter in percent; 0 for the exact charge.
        goal_tolerance_m: Distance from its goal at which a drive ends, by the position that the robot knows.
        localisation: Error of that position; None for a robot that knows where it is.
        begins: Time of day when a mission begins, with its zone; None for a robot without a wall clock.
        source: File name, for messages.
        data: Bytes of the file; None for a world that was not read from a file.
    """

    readings: Mapping[str, Truth] = field(default_factory=dict)
    faults: tuple[WorldFault, ...] = ()
    events: tuple[ScriptedEvent, ...] = ()
    seed: int = 0
    charge_percent: float = 100.0
    meter_step_percent: float = 0.0
    goal_tolerance_m: float = 0.0
    localisation: Localisation | None = None
    begins: datetime | None = None
    source: str = "world"
    data: bytes | None = field(default=None, repr=False, compare=False)
