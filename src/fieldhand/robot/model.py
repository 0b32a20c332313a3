"""The robot profile: capabilities, costs and limits of a robot, read by :mod:`fieldhand.robot.loader`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

from fieldhand.robot.bindings import Ros2Bindings
from fieldhand.robot.camera import Camera
from fieldhand.robot.charging import Charging
from fieldhand.robot.events import MonitoredEvent
from fieldhand.robot.implement import Implement
from fieldhand.short_repr import short_repr

Direction = Literal["below", "above"]

#: Handling of a capture that a power cut interrupted, of which nobody knows if it was made.
InDoubtPolicy = Literal["repeat", "skip"]


@dataclass(frozen=True, kw_only=True)
class LevelThreshold:
    """The threshold of a level word: "low" means ``below`` 33."""

    direction: Direction
    value: float


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """A quantity that the robot measures.

    Attributes:
        name: Identifier in lower case with underscores: ``canopy_temperature``.
        unit: Unit of the readings: ``degC``, ``ppm``, ``percent`` or another.
        words: Names that people use ("temperature", "canopy temperature").
        levels: Thresholds by level word, such as "low" and "high".
        minimum, maximum: Range of plausible readings.
        typical, spread: Mean and standard deviation of simulated readings where a world file gives none.
        labels: Names with article in other languages, by language code.
    """

    name: str
    unit: str
    words: tuple[str, ...]
    levels: Mapping[str, LevelThreshold]
    minimum: float
    maximum: float
    typical: float
    spread: float
    labels: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """A parameter of an action: a number within bounds, or one of several choices.

    Attributes:
        name: Identifier in lower case with underscores.
        kind: ``number`` or ``choice``.
        default: Value if a Task gives none.
        minimum, maximum: Bounds of a number; None if unbounded.
        unit: Unit of a number; empty for none.
        choices: Allowed values of a choice.
    """

    name: str
    kind: Literal["number", "choice"]
    default: float | str
    minimum: float | None = None
    maximum: float | None = None
    unit: str = ""
    choices: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Action:
    """An action that the robot performs at a place. One execution is a capture.

    Attributes:
        name: Identifier in lower case with underscores: ``take_thermal_picture``.
        words: Nouns for its result ("thermal picture", "picture"), the most specific first.
        verbs: Verbs that mean this action by themselves ("photograph"); "take", "measure" and "read" need no entry.
        measures: Names of the quantities that one capture measures.
        duration_s, energy_j: Duration in seconds and energy in joules of one capture.
        parameters: Parameters that a Task may set.
        description: One sentence for people and language models.
        labels: Descriptions of one capture in other languages, by language code ("tomar una fotografía").
        retries: Number of retries after a failure; None for the robot's :attr:`RobotProfile.retries`.
        retry_wait_s: Seconds between two attempts; None for :attr:`Patience.retry_wait_s`.
        in_doubt: Handling of a capture interrupted by a power cut: ``repeat``, or ``skip`` if doing it twice does harm,
            as cutting a leaf.
        implement: Properties of an action that is on while the robot drives; None for one that is done at a place.
        camera: Camera for which the robot must face the plant; None if it may stand in any direction.
    """

    name: str
    words: tuple[str, ...]
    verbs: tuple[str, ...]
    measures: tuple[str, ...]
    duration_s: float
    energy_j: float
    parameters: tuple[Parameter, ...] = ()
    description: str = ""
    labels: Mapping[str, str] = field(default_factory=dict)
    retries: int | None = None
    retry_wait_s: float | None = None
    in_doubt: InDoubtPolicy = "repeat"
    implement: Implement | None = None
    camera: Camera | None = None


@dataclass(frozen=True, kw_only=True)
class Patience:
    """Waiting times for faults that may clear by themselves.

    Attributes:
        retry_wait_s: Seconds before a failed drive or action is retried.
        blocked_wait_s: Seconds to wait for an obstacle in the only way to a place.
        lost_wait_s: Seconds to wait for the position to return.
        navigation_wait_s: Seconds to wait for a navigation that was restarted to be active again.
        taken_wait_s: Seconds to leave the robot to another client of its navigation.
        event_wait_s: Seconds to wait for an event to be over where the Task sets no maximum.
    """

    retry_wait_s: float = 0.0
    blocked_wait_s: float = 60.0
    lost_wait_s: float = 60.0
    navigation_wait_s: float = 60.0
    taken_wait_s: float = 300.0
    event_wait_s: float = 3600.0


@dataclass(frozen=True, kw_only=True)
class LegCost:
    """The random cost of a leg of ``d`` metres: ``d * (alpha + Exp(1 - alpha))``, whose mean is ``d``.

    Source: the published stochastic orienteering experiments (UC Merced).

    Attributes:
        alpha: Deterministic fraction of the cost, 0 to 1.
    """

    alpha: float


#: Default distance of the warning level above the return level, in percent of charge.
WARN_ABOVE = 10.0


@dataclass(frozen=True, kw_only=True)
class BatteryLevels:
    """The charge levels of a mission in percent, at which the robot warns, returns ``home`` and stops."""

    warn: float
    home: float
    stop: float


#: Default number of seconds for which an implausible charge must persist before it counts.
HOLD_S = 3.0


@dataclass(frozen=True, kw_only=True)
class Energy:
    """Battery capacity, energy consumption and charge levels.

    Attributes:
        capacity_j: Energy of a full battery in joules.
        drive_j_per_m: Energy per driven metre in joules.
        idle_w: Constant consumption in watts.
        reserve_percent: Charge that must remain at the end of a mission, unless the Task sets another reserve.
        warn_percent, return_percent, stop_percent: Charge levels in percent; None to derive them from the reserve
            (:meth:`levels`).
        hold_s: Seconds for which an implausible charge must persist before it counts.
        charging: How it recharges; None if it cannot.
    """

    capacity_j: float
    drive_j_per_m: float
    idle_w: float
    reserve_percent: float
    warn_percent: float | None = None
    return_percent: float | None = None
    stop_percent: float | None = None
    hold_s: float = HOLD_S
    charging: Charging | None = None

    def levels(self, reserve_percent: float) -> BatteryLevels:
        """Return the charge levels of a mission with a given reserve.

        The robot returns at the reserve at the latest. If the profile sets no levels, it warns :data:`WARN_ABOVE`
        percent above the return level and stops at half the reserve.

        Args:
            reserve_percent: Charge that must remain at the end of the mission, in percent.
        """
        home = max(reserve_percent, self.return_percent or 0.0)
        warn = min(100.0, home + WARN_ABOVE) if self.warn_percent is None else max(home, self.warn_percent)
        stop = reserve_percent / 2.0 if self.stop_percent is None else self.stop_percent
        return BatteryLevels(warn=warn, home=home, stop=stop)


@dataclass(frozen=True, kw_only=True, repr=False)
class RobotProfile:
    """A robot: its actions, measured quantities, dimensions, and costs of driving and working (``fh.Robot``).

    Example:
        >>> robot = RobotProfile.load("husky")
        >>> robot.action["take_thermal_picture"].measures
        ('canopy_temperature',)

    Attributes:
        name: Identifier in lower case.
        description: One sentence for people and language models.
        actions: Actions that the robot can perform at a place.
        quantities: Quantities that its actions measure.
        speed_m_s: Driving speed in metres per second.
        width_m: Overall width in metres; half of it is kept clear of tree lines, keep-outs and the boundary.
        standoff_m: Distance in metres from a trunk to the robot's centre when it works on the tree from the aisle; in
            a narrower aisle it stops in the middle.
        energy: Battery and consumption.
        leg_cost: Distribution of the cost of a leg.
        retries: Number of retries of a failed action or drive.
        sha256: SHA-256 of the profile's YAML in hexadecimal; an approved mission is valid for this profile only.
        source: Name or path from which the profile was loaded.
        patience: Waiting times for faults.
        ros2: ROS 2 interfaces; None for a robot that is only simulated.
        slow_m_s: Driving speed that "slowly" means in a request, in metres per second; None to ask.
        events: Events that it detects all the time.
        corridor_m: Greatest distance in metres from the way of a drive, beyond which the robot is stopped; None for
            any.
        turn_deg_s: Speed of turning on the spot in degrees per second; None for a robot that turns only while it
            drives.
    """

    name: str
    description: str
    actions: tuple[Action, ...]
    quantities: tuple[Quantity, ...]
    speed_m_s: float
    width_m: float
    standoff_m: float
    energy: Energy
    leg_cost: LegCost
    retries: int
    sha256: str
    source: str = ""
    patience: Patience = Patience()
    ros2: Ros2Bindings | None = None
    slow_m_s: float | None = None
    events: tuple[MonitoredEvent, ...] = ()
    corridor_m: float | None = None
    turn_deg_s: float | None = None

    __repr__ = short_repr

    @classmethod
    def load(cls, name_or_path: str | Path, *, changes: Mapping[str, Any] | None = None) -> RobotProfile:
        """Load an installed robot by name, such as ``husky``, or a profile from a YAML file.

        Args:
            name_or_path: Name of an installed robot, or path of a YAML file; names take precedence.
            changes: Keys of the YAML file to set before it is checked, mappings within mappings, such as
                ``{"energy": {"battery_wh": 500}}``; a key set to None is removed. The profile gets a SHA-256 of its
                own, so a mission approved for the original is not valid for it.

        Raises:
            ProfileError: There is no such robot, or its profile is invalid; the message names the key and a remedy.
        """
        from fieldhand.robot.loader import load_changed, load_robot

        return load_robot(str(name_or_path)) if changes is None else load_changed(str(name_or_path), changes)

    @cached_property
    def action(self) -> Mapping[str, Action]:
        """Return the actions by name."""
        return {a.name: a for a in self.actions}

    @cached_property
    def implements(self) -> Mapping[str, Action]:
        """Return the actions that are on while the robot drives, by name."""
        return {a.name: a for a in self.actions if a.implement is not None}

    @cached_property
    def doable(self) -> Mapping[str, Action]:
        """Return everything that its driver can be told to do in one place: the actions, and those of docking."""
        charging = self.energy.charging
        return {**self.action, **({} if charging is None else {a.name: a for a in charging.maneuvers})}

    @cached_property
    def quantity(self) -> Mapping[str, Quantity]:
        """Return the quantities by name."""
        return {q.name: q for q in self.quantities}

    @cached_property
    def event(self) -> Mapping[str, MonitoredEvent]:
        """Return the events by name."""
        return {e.name: e for e in self.events}

    @property
    def slowly_m_s(self) -> float:
        """Return the speed of slow driving in m/s: ``slow_m_s``, or half of the driving speed without it."""
        return 0.5 * self.speed_m_s if self.slow_m_s is None else self.slow_m_s

    def percent(self, metres: float, seconds: float, action_j: float = 0.0) -> float:
        """Return the energy of driving, idling and actions in percent of a full battery.

        Args:
            metres: Driven distance in metres.
            seconds: Duration in seconds.
            action_j: Energy of the actions in joules.
        """
        joules = metres * self.energy.drive_j_per_m + seconds * self.energy.idle_w + action_j
        return 100.0 * joules / self.energy.capacity_j
