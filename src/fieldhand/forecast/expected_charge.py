"""The charge of the battery along a walk: its mean and spread, for conditions that test it."""

from __future__ import annotations

import math

from fieldhand.forecast.recharge_rules import LEAST_GAIN_PERCENT, charge_target, farthest_target
from fieldhand.forecast.resource_limits import reserve_percent, speed_of
from fieldhand.forecast.walk_steps import WalkStep
from fieldhand.robot.model import RobotProfile
from fieldhand.task.frames import Task

#: Number of standard deviations within which a charge counts as possible.
_SPREAD = 2.0


class ExpectedCharge:
    """The charge that a walk has used since the start or since the last time at the charger.

    Args:
        task, robot: Task and robot of the mission.
    """

    def __init__(self, task: Task, robot: RobotProfile) -> None:
        self._task, self._robot = task, robot
        self._full: float | None = None
        self._used = self._variance = 0.0

    def after(self, step: WalkStep) -> None:
        """Account for a step."""
        robot = self._robot
        if step.node.recharge is not None and step.kind == "charge":
            self._charged(step.node.recharge.until_percent)
            return
        self._used += robot.percent(0.0, step.seconds, step.joules)
        if step.drive is not None:
            metre = robot.percent(1.0, 1.0 / speed_of(self._task.constraints, robot))
            self._variance += ((1.0 - robot.leg_cost.alpha) * metre * step.drive.length_m) ** 2

    def likely(self, at_start: float) -> tuple[float, float]:
        """Return the lowest and the highest charge that is likely now, in percent.

        Args:
            at_start: Charge at the start of the mission.
        """
        charge = (at_start if self._full is None else self._full) - self._used
        constraints = self._task.constraints
        lowest = max(reserve_percent(constraints, self._robot), constraints.recharge_below_percent or 0.0)
        if constraints.recharge and charge < lowest + LEAST_GAIN_PERCENT:
            self._charged(None)
            charge = charge_target(constraints, self._robot)
        spread = _SPREAD * math.sqrt(self._variance)
        further = 0.0  # before far places
        if constraints.recharge:
            further = farthest_target(constraints, self._robot) - charge_target(constraints, self._robot)
        return (charge - spread, charge + spread + further)

    def _charged(self, until_percent: float | None) -> None:
        target = charge_target(self._task.constraints, self._robot)
        self._full = target if until_percent is None else until_percent
        self._used = self._variance = 0.0
