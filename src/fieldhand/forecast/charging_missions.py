"""Many sampled missions at once, each with its own battery charge and resources used."""

from __future__ import annotations

import copy
import math

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast.mission_state import Work
from fieldhand.forecast.recharge_rules import RechargeRules, charge_target
from fieldhand.forecast.resource_limits import speed_of
from fieldhand.forecast.sampled_costs import SampledCharging, SampledUse
from fieldhand.task.frames import Task
from fieldhand.task.plan import Recharge

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
#: The missions of a step: their indices, or all.
Missions = Ints | slice

ALL = slice(None)


class ChargingMissions:
    """Sampled missions that charge their batteries.

    Args:
        rules: Rules of recharging.
        task: The Task.
        draws: Number of missions.
        charge_percent: Charge at the start.

    Attributes:
        level: Charge of each in percent.
        away_m: Metres from their places to the charger; infinite if there is no way.
        metres: Cost of the legs of each in metres.
        seconds, joules: Time and energy of actions and charging of each, without driving and idle power.
        charges: Number of charges of each; ``ordered`` of them interrupted the plan.
        charged_to: Highest charge in percent up to which the plan was interrupted to charge; 0 if it was not.
        stranding: Probability of each of having fallen to the stop level on a way to the charger or home; exact for
            the cost of that way, so that it can be far below one in the number of missions.
    """

    def __init__(self, rules: RechargeRules, task: Task, draws: int, charge_percent: float) -> None:
        charging = rules.robot.energy.charging
        assert charging is not None  # noqa: S101  rules exist only for a robot that charges
        self._robot, self._charging, self._rules = rules.robot, charging, rules
        self._until = charge_target(task.constraints, rules.robot)
        self._speed, self._at_start = speed_of(task.constraints, rules.robot), charge_percent
        self.level = np.full(draws, charge_percent)
        self.away_m: Floats = np.full(draws, np.inf)
        self.metres, self.seconds, self.joules = np.zeros(draws), np.zeros(draws), np.zeros(draws)
        self.charges, self.ordered = np.zeros(draws), np.zeros(draws)
        self.charged_to = np.zeros(draws)
        self._docked_s, self._lowest = np.zeros(draws), self.level.copy()
        self.stranding, self._runs = np.zeros(draws), np.ones(draws, dtype=bool)

    def copy(self) -> ChargingMissions:
        """Return missions that go on from here independently."""
        made = copy.copy(self)
        for name, kept in vars(self).items():
            if isinstance(kept, np.ndarray):
                setattr(made, name, kept.copy())
        return made

    @property
    def used(self) -> SampledUse:
        """Return the resources used so far."""
        return SampledUse(
            metres=self.metres,
            seconds=self.seconds,
            joules=self.joules,
            charging=SampledCharging(
                charges=self.charges,
                docked_s=self._docked_s,
                left=self.level,
                lowest=np.minimum(self._lowest, self.level),
                stranding=self.stranding,
                charged_to=self.charged_to,
            ),
        )

    def spent_seconds(self, of: Missions = ALL) -> Floats:
        """Return the time since the start."""
        return np.asarray(self.metres[of] / self._speed + self.seconds[of])

    def spent_percent(self, of: Missions = ALL) -> Floats:
        """Return what the batteries have supplied, in percent."""
        robot = self._robot
        return np.asarray(
            robot.percent(1.0, 0.0) * self.metres[of]
            + robot.percent(0.0, 1.0) * (self.spent_seconds(of) - self._docked_s[of])
            + robot.percent(0.0, 0.0, 1.0) * self.joules[of]
        )

    def charged_percent(self, of: Missions = ALL) -> Floats:
        """Return what the batteries were charged with, in percent."""
        return np.asarray(self.level[of] + self.spent_percent(of) - self._at_start)

    def drive(self, metres: Floats | float, of: Missions = ALL, slower_s_per_m: float = 0.0) -> None:
        """Drive legs of these costs in metres, slower than the mission by some seconds per metre."""
        self.metres[of] += metres
        self.level[of] -= self._robot.percent(1.0, 1.0 / self._speed) * metres
        if slower_s_per_m:
            self.seconds[of] += metres * slower_s_per_m
            self.level[of] -= self._robot.percent(0.0, slower_s_per_m) * metres
        self._runs[of] &= self.level[of] > self._rules.stop_percent

    def interrupt(
        self, of: Ints, away_m: Floats, costs: Floats, *, rest: float = math.inf, far: float = math.inf
    ) -> None:
        """Interrupt the plan: drive to the charger, dock and charge as far as the rules say.

        Args:
            of: The missions.
            away_m: Metres to the charger, shape (of,).
            costs: Metres driven for each of them.
            rest, far: Charges that decide how far, as in :meth:`RechargeRules.target`.
        """
        self.set_out(away_m, of)
        self.drive(away_m * costs, of)
        self.ordered[of] += 1.0
        until = self._rules.target(rest, self.level[of], far)
        self.charged_to[of] = np.maximum(self.charged_to[of], until)
        self.dock(of, until)

    def set_out(self, metres: Floats, of: Missions = ALL) -> None:
        """Add the probability that a leg of these lengths, to the charger or home, takes each to the stop level."""
        chance = self._rules.stop_chance(self.level[of], [metres, metres**2, metres**3])
        self.stranding[of] += np.where(self._runs[of], chance, 0.0)

    def act(self, work: Work, of: Missions = ALL) -> None:
        """Do work, without the metres driven in it."""
        self.seconds[of] += work.seconds
        self.joules[of] += work.joules
        self.level[of] -= self._robot.percent(0.0, work.seconds, work.joules)

    def charge_as_planned(self, node: Recharge) -> None:
        """Charge all missions at their place, as the plan says."""
        until = self._until if node.until_percent is None else node.until_percent
        if node.duration_s is not None and node.until_percent is None:
            until = 100.0
        self.dock(np.arange(len(self.level)), until, node.duration_s)

    def dock(self, of: Ints, until: Floats | float, most_s: float | None = None) -> None:
        """Dock at the charger, charge and leave it.

        Args:
            of: The missions.
            until: Charge at which charging ends, in percent.
            most_s: Maximum time of charging in seconds; None for as long as it takes.
        """
        charging, capacity_j = self._charging, self._robot.energy.capacity_j
        self._lowest[of] = np.minimum(self._lowest[of], self.level[of])
        self.act(Work(seconds=charging.dock.duration_s, joules=charging.dock.energy_j), of)
        before = self.level[of]
        full_s = charging.seconds(before, until, capacity_j)
        seconds = full_s if most_s is None else np.minimum(most_s, full_s)
        self.level[of] = charging.percent_after(before, seconds, capacity_j)
        self.seconds[of] += seconds
        self._docked_s[of] += seconds
        self.charges[of] += 1.0
        if charging.undock is not None:
            self.act(Work(seconds=charging.undock.duration_s, joules=charging.undock.energy_j), of)
