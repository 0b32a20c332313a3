"""Decide before a visit whether the battery is charged first (:mod:`fieldhand.forecast.recharge_rules`)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from fieldhand.errors import DriveFault
from fieldhand.evaluation.mission_budget import MissionBudget
from fieldhand.forecast.mission_state import MissionState, Visit, Work
from fieldhand.forecast.recharge_rules import RechargeRules
from fieldhand.forecast.resource_limits import resource_limits
from fieldhand.forecast.route_cost import RouteCost, overrun_chances, route_cost
from fieldhand.language import Number, message
from fieldhand.language.words import say_number, say_place
from fieldhand.site.model import Place

#: ``go``: make the visit. ``charge``: charge first. ``never``: not even a charged battery suffices.
Decision = Literal["go", "charge", "never"]


@dataclass(frozen=True, kw_only=True)
class RechargeDecision:
    """The decision about a visit, with the reason in words (empty for ``go``), and up to what percent to charge."""

    decision: Decision
    why: str = ""
    charge_to: float = 0.0


class RechargeDecider:
    """Decides about recharging during one mission.

    Args:
        budget: Budget of the mission.
    """

    def __init__(self, budget: MissionBudget) -> None:
        self._budget = budget

    def decide(
        self, state: MissionState, visit: Visit, after: RouteCost | None, *, permitted: bool = False
    ) -> RechargeDecision:
        """Decide about a visit.

        Args:
            state: State of the mission.
            visit: The visit in question.
            after: Cost of the visit's work and of everything that follows up to the end; None if it is unknown.
            permitted: True if the visit was permitted before: only an unexpectedly low charge revokes that.
        """
        rules = self._budget.recharge
        if rules is None or state.frames[-1].node.recharge is not None:
            return RechargeDecision(decision="go")
        here, charge = state.context.here, state.charge_percent
        needed = self._needed(rules, here, visit, after, charged=permitted)
        if permitted and charge >= needed:
            return RechargeDecision(decision="go")
        if not rules.must_charge(charge, needed, ends=visit.ends) or self._is_safer_to_finish(state, visit, after):
            return RechargeDecision(decision="go")
        first = self._needed(rules, rules.charger, visit, after, charged=True)
        able = state.charges < rules.at_most and bool(rules.gains(charge)) and first <= rules.most_percent
        if able and math.isfinite(self._metres(here, rules.charger)):
            until = self._target(rules, visit, after, charge)
            return RechargeDecision(decision="charge", why=_why(rules, charge, needed), charge_to=until)
        if permitted or charge >= self._needed(rules, here, visit, after, charged=True):
            return RechargeDecision(decision="go")  # charging would be safer, or was only wished for
        why = message(
            "{place} takes {needed} % of the battery with the way to the charger, and {charge} % is left",
            context="log",
            place=say_place(visit.place.kind, visit.place.id),
            needed=Number(say_number(needed, 3)),
            charge=Number(say_number(charge, 3)),
        )
        return RechargeDecision(decision="never", why=why)

    def fits_in_time(self, state: MissionState, visit: Visit) -> bool:
        """Return True if charging before an optional visit, the visit and the way home keep the budgets."""
        budget, rules = self._budget, self._budget.recharge
        charging = None if rules is None else rules.robot.energy.charging
        if rules is None or charging is None:
            return True
        here, robot = state.context.here, rules.robot
        until = self._target(rules, visit, None, state.charge_percent)
        full_s = float(charging.seconds(state.charge_percent, until, robot.energy.capacity_j))
        work = Work(seconds=charging.around_s + full_s, joules=charging.around_j - full_s * robot.energy.idle_w)
        legs = (
            self._metres(here, rules.charger),
            self._metres(rules.charger, visit.place),
            self._metres(visit.end, budget.home(visit.end)),
        )
        if not all(map(math.isfinite, legs)):
            return False
        limits = resource_limits(budget.task.constraints, robot)[:-1]
        work = work + visit.work + budget.slower(visit, legs[1], rules.charger)
        chances = overrun_chances(route_cost(legs, work), limits, robot, state.spent)
        return all(chance <= limit.failure_probability for chance, limit in zip(chances, limits, strict=True))

    def is_within_charge(self, state: MissionState, visit: Visit) -> bool:
        """Return True if a visit is possible without charging first."""
        rules = self._budget.recharge
        if rules is None:
            return True
        return not rules.must_charge(state.charge_percent, self._needed(rules, state.context.here, visit, None))

    def is_possible(self, visit: Visit) -> bool:
        """Return True if a visit is possible with a charged battery."""
        rules = self._budget.recharge
        if rules is None:
            return True
        way = self._there_and_back(rules, visit)
        return way is not None and rules.optional_for(way) <= rules.most_percent

    def _is_safer_to_finish(self, state: MissionState, visit: Visit, after: RouteCost | None) -> bool:
        """Return True if the way to the charger is likelier to stop the robot than everything that is left."""
        rules, here = self._budget.recharge, state.context.here
        if rules is None or after is None:
            return False
        away, there = self._metres(here, rules.charger), self._metres(here, visit.place)
        if not math.isfinite(away + there):
            return False
        whole = route_cost([there], self._budget.slower(visit, there, here)) + after
        work = rules.robot.percent(0.0, whole.work.seconds, whole.work.joules) + whole.work.metres * rules.per_metre
        return bool(rules.is_way_to_charger_worse(state.charge_percent, away, whole.sums, work))

    def _needed(
        self, rules: RechargeRules, here: Place, visit: Visit, after: RouteCost | None, *, charged: bool = False
    ) -> float:
        """Return the charge that suffices for a visit and the way to the charger, or for all that is left."""
        there, back = self._metres(here, visit.place), self._metres(visit.end, rules.charger)
        needed = math.inf
        if math.isfinite(there + back):
            way = route_cost([there, back], visit.work + self._budget.slower(visit, there, here))
            needed = rules.needed_for(way, charged=charged, docks=True, ends=visit.ends)
        if after is not None and math.isfinite(there):
            way = route_cost([there], self._budget.slower(visit, there, here)) + after
            needed = min(needed, rules.needed_for(way, charged=charged, ends=visit.ends))
        return needed

    def _target(self, rules: RechargeRules, visit: Visit, after: RouteCost | None, charge: float) -> float:
        """Return up to what percent to charge before a visit."""
        there, rest, certain = self._metres(rules.charger, visit.place), math.inf, math.inf
        if after is not None and math.isfinite(there):
            whole = route_cost([there], self._budget.slower(visit, there, rules.charger)) + after
            rest, certain = rules.needed_for(whole), rules.certain_for(whole)
        way = self._there_and_back(rules, visit)
        far = math.inf if way is None else rules.certain_for(way, docks=True)
        return float(rules.target(rest, charge, rules.far(far, certain)))

    def _there_and_back(self, rules: RechargeRules, visit: Visit) -> RouteCost | None:
        """Return a visit and the ways from the charger to it and back; None if there are none."""
        there, back = self._metres(rules.charger, visit.place), self._metres(visit.end, rules.charger)
        if not math.isfinite(there + back):
            return None
        return route_cost([there, back], visit.work + self._budget.slower(visit, there, rules.charger))

    def _metres(self, a: Place, b: Place) -> float:
        try:
            return self._budget.length(a, b)
        except DriveFault:
            return math.inf


def _why(rules: RechargeRules, charge: float, needed: float) -> str:
    amounts = {"charge": Number(say_number(charge, 3))}
    if charge >= needed:
        below = Number(say_number(rules.below_percent))
        return message("{charge} % charge is left, less than {below} %", context="log", below=below, **amounts)
    wanted = Number(say_number(needed, 3))
    return message(
        "{charge} % charge is left, but {needed} % is needed up to the charger", context="log", needed=wanted, **amounts
    )
