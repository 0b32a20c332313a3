"""When a robot that may recharge goes to its charger. Forecast and guard follow the same rules.

Before each visit the charge must suffice, with a small accepted probability of falling below the reserve, for the visit
and the way from there to the charger, or for everything that is left. Otherwise the robot charges first, if from a
charged battery the visit is possible. So it never leaves for a place from which the charger would be out of reach, and
every charge makes at least one visit possible.

A leg can take several times its mean. The charge must therefore also suffice, almost certainly, to stay above the level
at which the robot stops: far from the charger it leaves earlier than the reserve alone would ask for. Before visits for
which the usual target is not certain enough it charges further than that, unless the Task gives the target.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fieldhand.errors import DriveFault
from fieldhand.forecast.resource_limits import ResourceLimit, reserve_percent, resource_limits, speed_of
from fieldhand.forecast.route_cost import RouteCost, cost_model
from fieldhand.forecast.visit_order import start_place
from fieldhand.orienteering.overrun import overrun_probability, quantile_table
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task.frames import Constraints, Task
from fieldhand.task.recharging import planned_charges, recharges

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

Floats = NDArray[np.float64]

#: Fraction of the accepted probability of falling below the reserve that one stretch between two charges may use.
STRETCH_SHARE = 0.1

#: Accepted probability of falling to the stop level on one stretch between two charges.
STOP_CHANCE = 5e-5

#: Fraction of the charge that the reserve leaves for visits; keeping off the stop level takes no more of it than that.
STOP_SHARE = 0.5

#: Charge in percent that charging must gain at least; below that, the robot does not go to the charger.
LEAST_GAIN_PERCENT = 5.0

#: Charge in percent beyond what surely suffices for a visit, if the robot charges further than usual for it: so much is
#: left for more visits nearby.
FAR_ROOM_PERCENT = 10.0

#: Charge in percent beyond what the rest of the mission takes, if the robot charges no further than that.
MARGIN_PERCENT = 2.0

#: Number of charges that stands for any number.
ANY_NUMBER = 1000.0

_SKEWNESS = np.arange(-4.0, 8.0 + 1e-9, 1.0 / 16.0)


@lru_cache(maxsize=64)
def _quantiles(chance: float) -> Floats:
    return quantile_table(chance)


def charge_target(constraints: Constraints, robot: RobotProfile) -> float:
    """Return the charge in percent up to which a mission charges: the Task's, else the profile's, else 100."""
    if constraints.recharge_until_percent is not None:
        return constraints.recharge_until_percent
    return 100.0 if robot.energy.charging is None else robot.energy.charging.until_percent


def farthest_target(constraints: Constraints, robot: RobotProfile) -> float:
    """Return the charge in percent up to which a mission charges before far places: the Task's, else the highest."""
    if constraints.recharge_until_percent is not None:
        return constraints.recharge_until_percent
    return 100.0 if robot.energy.charging is None else robot.energy.charging.most_percent


def charger_of(site: Site, robot: RobotProfile) -> Place | None:
    """Return the charger of a site if the robot can recharge."""
    return None if robot.energy.charging is None else site.markers.get("charger")


@dataclass(frozen=True, kw_only=True)
class RechargeRules:
    """The rules of one mission.

    Attributes:
        robot: Profile with the battery model.
        charger: Place of the charger.
        reserve_percent: Charge that must be left on arrival at the charger and at the end.
        stop_percent: Charge at which the robot stops wherever it is.
        below_percent: Charge below which the robot charges although the next visit would still fit; 0 for none.
        until_percent: Charge up to which it charges usually.
        most_percent: Charge up to which it charges before far places.
        as_needed: True to end charging earlier if the charge suffices for everything that is left.
        at_most: Maximum number of charges that interrupt the plan; infinite for any number.
        planned: Number of charges that are steps of the plan.
        accepted: Accepted probability of falling below the reserve on one stretch, if charging first can avoid it.
        tolerated: Accepted probability of falling below the reserve on one stretch from a charged battery.
        stranding: Accepted probability that a mission falls to the stop level on the way to its charger or home.
        per_metre: Charge in percent that a metre of driving takes on average.
        dock_percent: Charge in percent that docking takes.
    """

    robot: RobotProfile
    charger: Place
    reserve_percent: float
    stop_percent: float
    below_percent: float
    until_percent: float
    most_percent: float
    as_needed: bool
    at_most: float
    planned: float
    accepted: float
    tolerated: float
    stranding: float
    per_metre: float
    dock_percent: float

    @property
    def usable_percent(self) -> float:
        """Return the charge that one charging adds at most."""
        return max(LEAST_GAIN_PERCENT, self.until_percent - self.reserve_percent)

    def needed(
        self,
        sums: Sequence[ArrayLike],
        work_percent: ArrayLike,
        *,
        charged: bool = False,
        ends: ArrayLike = False,
    ) -> Floats:
        """Return the charge in percent that suffices for a route with the accepted probability, elementwise.

        It keeps the reserve, and keeps the battery almost certainly above the stop level. For the latter it rises at
        most by :data:`STOP_SHARE` of the way to a charged battery, so that far places remain worth the way.

        Args:
            sums: Sums of the leg lengths in metres, of their squares and of their cubes.
            work_percent: Charge that the work along the route takes.
            charged: True to allow the probability that is tolerated from a charged battery, and keep the reserve only.
            ends: True where the route is the way home, before which only the reserve counts.
        """
        work = np.asarray(work_percent, dtype=np.float64)
        metres = self.longest(sums, self.tolerated if charged else self.accepted)
        found: Floats = self.reserve_percent + metres * self.per_metre + work
        if charged:
            return found
        most = found + STOP_SHARE * np.maximum(0.0, self.most_percent - found)
        surely = np.minimum(self.certain(sums, work), most)
        return np.where(np.asarray(ends), found, np.maximum(found, surely))

    def certain(self, sums: Sequence[ArrayLike], work_percent: ArrayLike, chance: float = STOP_CHANCE) -> Floats:
        """Return the charge in percent that keeps off the stop level but for a small probability, elementwise.

        Args:
            sums, work_percent: As in :meth:`needed`.
            chance: The probability.
        """
        found: Floats = self.stop_percent + self.longest(sums, chance) * self.per_metre + np.asarray(work_percent)
        return found

    def optional(self, sums: Sequence[ArrayLike], work_percent: ArrayLike) -> Floats:
        """Return the charge in percent that a charged battery needs for an optional visit, elementwise.

        It may use no more than :data:`STRETCH_SHARE` of the accepted probability of being stranded.

        Args:
            sums, work_percent: As in :meth:`needed`, with the way back to the charger.
        """
        certain = self.certain(sums, work_percent, STRETCH_SHARE * self.stranding)
        return np.maximum(self.needed(sums, work_percent, charged=True), certain)

    def stop_chance(
        self, charge_percent: ArrayLike, sums: Sequence[ArrayLike], work_percent: ArrayLike = 0.0
    ) -> Floats:
        """Return the probability that a route takes the battery from a charge to the stop level, elementwise.

        Args:
            charge_percent: Charge at its begin.
            sums, work_percent: As in :meth:`needed`.
        """
        first, squares, cubes = (np.asarray(s, dtype=np.float64) for s in sums)
        second, third = cost_model(self.robot).cumulants()
        left = (np.asarray(charge_percent) - self.stop_percent - np.asarray(work_percent)) / self.per_metre
        return overrun_probability(first, second * squares, third * cubes, left)

    def is_way_to_charger_worse(
        self, charge_percent: ArrayLike, away_m: ArrayLike, sums: Sequence[ArrayLike], work_percent: ArrayLike
    ) -> NDArray[np.bool_]:
        """Return True where the way to the charger is likelier to stop the robot than everything that is left.

        Args:
            charge_percent: Charge now.
            away_m: Metres to the charger.
            sums, work_percent: Everything that is left, up to the end, as in :meth:`needed`.
        """
        away = np.asarray(away_m, dtype=np.float64)
        there = self.stop_chance(charge_percent, [away**n for n in (1, 2, 3)])
        return np.asarray((there > STOP_CHANCE) & (self.stop_chance(charge_percent, sums, work_percent) < there))

    def longest(self, sums: Sequence[ArrayLike], chance: float) -> Floats:
        """Return the metres that the cost of a route exceeds with a given probability, elementwise.

        Args:
            sums: Sums of the leg lengths in metres, of their squares and of their cubes.
            chance: The probability.
        """
        first, squares, cubes = (np.asarray(s, dtype=np.float64) for s in sums)
        second, third = cost_model(self.robot).cumulants()
        variance = second * squares
        scale = variance**1.5
        skewness = np.divide(third * cubes, scale, out=np.zeros_like(variance), where=np.asarray(scale > 0.0))
        found: Floats = first + np.sqrt(variance) * np.interp(skewness, _SKEWNESS, _quantiles(chance))
        return found

    def needed_for(self, way: RouteCost, *, charged: bool = False, docks: bool = False, ends: bool = False) -> float:
        """Return the charge in percent that suffices for one route, as :meth:`needed`; with docking at its end."""
        return float(self.needed(way.sums, self._work_in(way, docks=docks), charged=charged, ends=ends))

    def certain_for(self, way: RouteCost, *, docks: bool = False) -> float:
        """Return the charge in percent that keeps one route off the stop level, as :meth:`certain`."""
        return float(self.certain(way.sums, self._work_in(way, docks=docks)))

    def optional_for(self, way: RouteCost) -> float:
        """Return the charge in percent that a charged battery needs for one optional visit, as :meth:`optional`."""
        return float(self.optional(way.sums, self._work_in(way, docks=True)))

    def _work_in(self, way: RouteCost, *, docks: bool) -> float:
        work = self.robot.percent(0.0, way.work.seconds, way.work.joules) + way.work.metres * self.per_metre
        return work + docks * self.dock_percent

    def must_charge(
        self, charge_percent: ArrayLike, enough_percent: ArrayLike, *, ends: bool = False
    ) -> NDArray[np.bool_]:
        """Return True where the battery must be charged before a visit, if it can be.

        Args:
            charge_percent: Charge now.
            enough_percent: Charge that suffices, by :meth:`needed`.
            ends: True before the way home, for which it is not charged unless needed.
        """
        charge = np.asarray(charge_percent)
        wished = -math.inf if ends else self.below_percent
        return (charge < np.asarray(enough_percent) - 1e-9) | (charge < wished)

    def target(self, rest_percent: float, charge_percent: ArrayLike, far_percent: float) -> Floats:
        """Return up to what percent to charge: the wanted charge or, if the Task leaves it open, what the rest takes.

        If the usual charge is not certain enough for the next visit, it charges further. The target is well above the
        charge now and that below which the robot charges, so that no charge follows another.

        Args:
            rest_percent: Charge that suffices for everything that is left; infinite if it is unknown.
            charge_percent: Charge now.
            far_percent: Result of :meth:`far` for the next visit, from the charger.
        """
        charge = np.asarray(charge_percent, dtype=np.float64)
        if not self.as_needed:
            return np.full_like(charge, self.until_percent)
        least = max(self.reserve_percent, self.below_percent) + LEAST_GAIN_PERCENT
        usual = min(self.until_percent, max(rest_percent + MARGIN_PERCENT, least))
        return np.asarray(
            np.minimum(self.most_percent, np.maximum(charge + LEAST_GAIN_PERCENT, max(usual, far_percent)))
        )

    def far(self, there_and_back: float, everything: float = math.inf) -> float:
        """Return up to what percent the next visit asks to charge, given what keeps it off the stop level.

        Args:
            there_and_back: Result of :meth:`certain` for the visit and the way to the charger.
            everything: That for everything that is left; infinite if it is unknown.
        """
        return min(there_and_back + FAR_ROOM_PERCENT, everything + MARGIN_PERCENT)

    def gains(self, charge_percent: ArrayLike) -> NDArray[np.bool_]:
        """Return True where charging would raise the charge noticeably."""
        return np.asarray(charge_percent) <= self.most_percent - LEAST_GAIN_PERCENT


def recharge_rules(task: Task, site: Site, robot: RobotProfile) -> RechargeRules | None:
    """Return the rules of a Task; None if it does not recharge, or cannot."""
    charger, charging, constraints = charger_of(site, robot), robot.energy.charging, task.constraints
    if charger is None or charging is None or not recharges(task):
        return None
    reserve = resource_limits(constraints, robot)[-1]
    most = float("inf") if constraints.recharge_at_most is None else constraints.recharge_at_most
    return RechargeRules(
        robot=robot,
        charger=charger,
        reserve_percent=reserve_percent(constraints, robot),
        stop_percent=robot.energy.levels(reserve_percent(constraints, robot)).stop,
        below_percent=(constraints.recharge_below_percent or 0.0) if constraints.recharge else 0.0,
        until_percent=charge_target(constraints, robot),
        most_percent=farthest_target(constraints, robot),
        as_needed=constraints.recharge_until_percent is None,
        at_most=float(most) if constraints.recharge else 0.0,
        planned=planned_charges(task.composition.plan),
        accepted=STRETCH_SHARE * reserve.failure_probability,
        tolerated=reserve.failure_probability,
        stranding=charging.stranding_probability,
        per_metre=reserve.per_metre,
        dock_percent=_dock_percent(robot),
    )


def _dock_percent(robot: RobotProfile) -> float:
    charging = robot.energy.charging
    return 0.0 if charging is None else robot.percent(0.0, charging.dock.duration_s, charging.dock.energy_j)


def mission_limits(
    task: Task,
    site: Site,
    robot: RobotProfile,
    drives: Drives,
    charge_percent: float = 100.0,
    *,
    charges: int = 0,
    planned: int = 0,
    pace_m_s: float = math.inf,
) -> tuple[ResourceLimit, ...]:
    """Return the limits of a whole mission, for decisions on how much work fits into it.

    Without recharging they are those of :func:`~fieldhand.forecast.resource_limits.resource_limits`. With it, the
    charge covers the charges that may still follow, and each budget is given a second time, as it remains if every
    charge that the work needs beyond the present one is charged at the charger: with the time for it, and with the way
    there and back.

    Args:
        task, site, robot, drives: Task, site, robot and drives of the mission.
        charge_percent: Charge at the start, and what was charged since, in percent.
        charges, planned: Number of charges so far that interrupted the plan, and of those that the plan contains.
        pace_m_s: Speed limit of the part of the plan in which all driving is assumed to take place.
    """
    limits = resource_limits(task.constraints, robot, charge_percent, pace_m_s=pace_m_s)
    rules = recharge_rules(task, site, robot)
    if rules is None:
        return limits
    left = min(ANY_NUMBER, max(0.0, rules.at_most - charges) + max(0.0, rules.planned - planned))
    *budgets, reserve = limits
    cycle = charge_cycle(rules, task, drives)
    extra, floor = _per_charged_percent(cycle), cycle.floor_percent - rules.reserve_percent
    again = [
        ResourceLimit(
            kind=b.kind,
            limit=b.limit + extra[b.kind] * (reserve.limit - floor),
            failure_probability=b.failure_probability,
            per_metre=b.per_metre + extra[b.kind] * reserve.per_metre,
            per_percent=extra[b.kind],
        )
        for b in budgets
    ]
    whole = ResourceLimit(
        kind="reserve",
        limit=reserve.limit + left * rules.usable_percent,
        failure_probability=reserve.failure_probability,
        per_metre=reserve.per_metre,
    )
    return (*budgets, *again, whole)


@dataclass(frozen=True, kw_only=True)
class ChargeCycle:
    """A usual charge between two visits: from an ordinary place of the site to the charger and back.

    Attributes:
        detour_m: Metres to the charger and back.
        around_s: Seconds of driving there and back and of docking.
        charge_s: Seconds of charging.
        percent: Charge that the detour takes.
        net_percent: Charge gained in all.
        floor_percent: Charge at which the robot goes to the charger.
    """

    detour_m: float
    around_s: float
    charge_s: float
    percent: float
    net_percent: float
    floor_percent: float


def charge_cycle(rules: RechargeRules, task: Task, drives: Drives) -> ChargeCycle:
    """Return the usual charge of a mission."""
    charging, robot = rules.robot.energy.charging, rules.robot
    assert charging is not None  # noqa: S101  rules exist only for a robot that charges
    detour_m = _usual_detour(rules, drives)
    around_s = detour_m / speed_of(task.constraints, robot) + charging.around_s
    percent = robot.percent(detour_m, around_s, charging.around_j)
    half_m = detour_m / 2.0
    floor = float(rules.needed([half_m, half_m**2, half_m**3], percent / 2.0, ends=True))
    return ChargeCycle(
        detour_m=detour_m,
        around_s=around_s,
        charge_s=float(charging.seconds(rules.reserve_percent, rules.until_percent, robot.energy.capacity_j)),
        percent=percent,
        net_percent=max(LEAST_GAIN_PERCENT, rules.until_percent - floor),
        floor_percent=floor,
    )


def _per_charged_percent(cycle: ChargeCycle) -> dict[str, float]:
    """Return what one percent of charge costs at the charger, by kind of budget: with the way there and docking."""
    return {
        "distance_m": cycle.detour_m / cycle.net_percent,
        "duration_s": (cycle.around_s + cycle.charge_s) / cycle.net_percent,
        "energy_percent": cycle.percent / cycle.net_percent,
    }


def _usual_detour(rules: RechargeRules, drives: Drives) -> float:
    """Return the metres of a drive to the charger and back from an ordinary place of the site."""
    key = "recharge_detour", rules.charger.xy
    known = drives.site.cache.get(key)
    if not isinstance(known, float):
        trees = drives.site.trees[:: max(1, len(drives.site.trees) // 24)]
        lengths = [m for tree in trees if (m := charger_distance(drives, tree.place, rules.charger)) is not None]
        known = drives.site.cache[key] = 2.0 * float(np.mean(lengths)) if lengths else 0.0
    return known


def charger_distance(drives: Drives, at: Place, charger: Place) -> float | None:
    """Return the metres from a place to the charger; None if there is no way."""
    if at.xy == charger.xy:
        return 0.0
    try:
        return drives.between(at, charger).length_m
    except DriveFault:
        return None


def is_charger_reachable(site: Site, robot: RobotProfile, drives: Drives) -> bool:
    """Return True if the robot can drive to the charger from the start."""
    charger = charger_of(site, robot)
    return charger is not None and charger_distance(drives, start_place(drives), charger) is not None
