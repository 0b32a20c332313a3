"""Battery levels and budget limits whose crossing has consequences during a mission."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from fieldhand.forecast.resource_limits import reserve_percent
from fieldhand.robot.model import RobotProfile
from fieldhand.task.exceeded import is_exceeded
from fieldhand.task.frames import Constraints
from fieldhand.task.results import Crossable, Crossing

#: Highest plausible drain as a multiple of the battery model.
FASTEST = 16.0

Consequence = Literal["go_on", "return", "end", "stop"]


@dataclass(frozen=True, kw_only=True)
class LimitLevel:
    """A threshold and the consequence of crossing it."""

    quantity: Crossable
    level: Crossing
    threshold: float
    then: Consequence

    def is_crossed(self, value: float) -> bool:
        """Return True if a value lies beyond the threshold."""
        match self.level:
            case "limit":
                return is_exceeded(self.quantity, value, self.threshold) if self.quantity != "charge_percent" else False
            case "reserve":
                return is_exceeded("reserve", value, self.threshold)
            case _:
                return value <= self.threshold


def levels_of(constraints: Constraints, robot: RobotProfile) -> tuple[LimitLevel, ...]:
    """Return the limit levels of a Task on a robot."""
    reserve = reserve_percent(constraints, robot)
    battery = robot.energy.levels(max(reserve, constraints.return_percent or 0.0))
    stop = robot.energy.levels(reserve).stop
    charges: tuple[tuple[Crossing, float, Consequence], ...] = (
        ("warn", battery.warn, "go_on"),
        ("return", battery.home, "return"),
        ("reserve", reserve, "go_on"),
        ("stop", stop, "stop"),
    )
    return (
        # A level of 0 is never crossed: the battery is empty then.
        *(
            LimitLevel(quantity="charge_percent", level=level, threshold=at, then=then)
            for level, at, then in charges
            if at > 0.0
        ),
        *(LimitLevel(quantity=b.kind, level="limit", threshold=b.limit, then="return") for b in constraints.budgets),
    )


def charge_levels(constraints: Constraints, robot: RobotProfile, full: float) -> tuple[float, ...]:
    """Return the charges in percent at which a level is crossed, for a mission that begins with ``full`` percent."""
    levels = levels_of(constraints, robot)
    return (
        *(level.threshold for level in levels if level.quantity == "charge_percent"),
        *(full - level.threshold for level in levels if level.quantity == "energy_percent"),
    )


def fastest_charge(robot: RobotProfile) -> float:
    """Return the highest plausible rise of the charge at the charger in percent per second: twice the profile's."""
    charging = robot.energy.charging
    watts = 0.0 if charging is None else max(power for _, power in charging.curve)
    return 2.0 * 100.0 * watts / robot.energy.capacity_j


def fastest_drain(robot: RobotProfile) -> float:
    """Return the highest plausible drain in percent per second: :data:`FASTEST` times the battery model."""
    action = max((a.energy_j / a.duration_s for a in robot.actions), default=0.0)
    return FASTEST * robot.percent(robot.speed_m_s, 1.0, action)
