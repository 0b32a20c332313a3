"""What a robot can do, as data. Read from a profile by :mod:`fieldhand.robot.loader`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Literal

from fieldhand.robot.bindings import Ros2Bindings
from fieldhand.short_repr import short_repr

Direction = Literal["below", "above"]

#: What is done about a capture that was in the air when the power was cut: nobody knows whether it was made.
InDoubtPolicy = Literal["repeat", "skip"]


@dataclass(frozen=True, kw_only=True)
class LevelThreshold:
    """A word for a reading: "low" is ``below`` 33."""

    direction: Direction
    value: float


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """Something that the robot measures.

    Attributes:
        name: ``canopy_temperature``; names are lower case with underscores.
        unit: ``degC``, ``ppm``, ``percent``, or another unit, as readings are reported.
        words: How people say it ("temperature", "canopy temperature").
        levels: Words such as "low" and "high", each with its threshold.
        labels: Its name with its article in other languages, by their codes.
        minimum, maximum: Range of a believable reading.
        typical, spread: Mean and standard deviation that the simulation draws from where a world file says nothing.
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
    """A parameter of an action: a number within bounds, or one of some choices."""

    name: str
    kind: Literal["number", "choice"]
    default: float | str
    minimum: float | None = None
    maximum: float | None = None
    unit: str = ""
    choices: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Action:
    """Something that the robot does at a place.

    Attributes:
        words: Nouns that people use for what it yields ("thermal picture", "picture"), the most specific first.
        verbs: Verbs that by themselves mean this action ("photograph"); take, measure and read need no entry.
        measures: Names of the quantities that one capture yields.
        duration_s, energy_j: Of one capture.
        retries: How often it is tried again when it fails; None for as often as the robot's ``retries`` say.
        retry_wait_s: Seconds between two tries; None for the robot's.
        labels: What is done, once, in other languages, by their codes ("tomar una fotografía").
        in_doubt: Whether a capture that the power cut off is made again: not where twice does harm, as a cut leaf.
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


@dataclass(frozen=True, kw_only=True)
class Patience:
    """How long a robot waits when something is wrong that may come right by itself.

    Attributes:
        retry_wait_s: Before a failed drive or action is tried again.
        blocked_wait_s: For what stands in the only way to a place.
        lost_wait_s: To know again where it is.
    """

    retry_wait_s: float = 0.0
    blocked_wait_s: float = 60.0
    lost_wait_s: float = 60.0


@dataclass(frozen=True, kw_only=True)
class LegCost:
    """Random cost of a leg of ``d`` metres: ``d * (alpha + Exp(1 - alpha))``, whose mean is ``d``.

    Source: the published stochastic orienteering experiments (UC Merced); alpha 1 is deterministic.
    """

    alpha: float


#: Percent of charge between the return level and the warning level where a profile does not say the latter.
WARN_ABOVE = 10.0


@dataclass(frozen=True, kw_only=True)
class BatteryLevels:
    """Charge in percent at which a mission says that it is low (``warn``), turns ``home``, and stops (``stop``)."""

    warn: float
    home: float
    stop: float


#: Seconds for which a surprising charge has to be read before it counts, unless the profile says otherwise.
HOLD_S = 3.0


@dataclass(frozen=True, kw_only=True)
class Energy:
    """Energy store and what empties it.

    Attributes:
        capacity_j: A full battery.
        drive_j_per_m: For each metre driven.
        idle_w: All the time.
        reserve_percent: Charge that must be left at the end of a mission unless the Task says otherwise.
        warn_percent, return_percent, stop_percent: Levels of the charge; None for those that follow from the reserve
            (:meth:`levels`).
        hold_s: Seconds for which a charge that surprises has to be read before it counts.
    """

    capacity_j: float
    drive_j_per_m: float
    idle_w: float
    reserve_percent: float
    warn_percent: float | None = None
    return_percent: float | None = None
    stop_percent: float | None = None
    hold_s: float = HOLD_S

    def levels(self, reserve_percent: float) -> BatteryLevels:
        """Return the levels of a mission that has to leave so much charge.

        The robot turns home at the reserve at the latest. Where the profile does not say otherwise, it warns
        :data:`WARN_ABOVE` percent above its return level and stops at half the reserve.
        """
        home = max(reserve_percent, self.return_percent or 0.0)
        warn = min(100.0, home + WARN_ABOVE) if self.warn_percent is None else max(home, self.warn_percent)
        stop = reserve_percent / 2.0 if self.stop_percent is None else self.stop_percent
        return BatteryLevels(warn=warn, home=home, stop=stop)


@dataclass(frozen=True, kw_only=True, repr=False)
class RobotProfile:
    """A robot: what it can do and what that costs.

    Attributes:
        speed_m_s: Of driving.
        width_m: Over all; it keeps half of it from tree lines, keep-outs and the boundary.
        standoff_m: From a trunk to the middle of the robot when it works on that tree from the aisle; in a narrower
            aisle it stands in the middle.
        retries: Of a failed action or drive.
        patience: How long it waits when something is wrong.
        ros2: How it is reached over ROS 2; None for a robot that is only simulated.
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

    __repr__ = short_repr

    @classmethod
    def load(cls, name_or_path: str | Path) -> RobotProfile:
        """Load a robot: a built-in one by its name, such as ``husky``, or the profile in a YAML file.

        Raises:
            ProfileError: There is no such robot, or its profile cannot be used; says where, and what to do.
        """
        from fieldhand.robot.loader import load_robot

        return load_robot(str(name_or_path))

    @cached_property
    def action(self) -> Mapping[str, Action]:
        """Actions by name."""
        return {a.name: a for a in self.actions}

    @cached_property
    def quantity(self) -> Mapping[str, Quantity]:
        """Quantities by name."""
        return {q.name: q for q in self.quantities}

    def percent(self, metres: float, seconds: float, action_j: float = 0.0) -> float:
        """Energy of driving, time and actions, in percent of a full battery."""
        joules = metres * self.energy.drive_j_per_m + seconds * self.energy.idle_w + action_j
        return 100.0 * joules / self.energy.capacity_j
