"""When a robot that may recharge breaks a drive off because it costs far more than its length. Shared by forecast and
failsafe.

The charge was enough when the drive began, but a leg can take several times its mean. Once it has taken more than
expected, going on might leave too little for the way from its end to the charger, although from here that way is still
short or the charge still high. Then the robot turns to the charger while it can, and makes the drive again from there.

The rest of the leg is projected at the pace so far (metres driven per metre of the way); the way to the charger is a
leg of its own, whose cost exceeds what is left with a probability that both sides compute in the same way.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fieldhand.forecast.charging_missions import ChargingMissions
from fieldhand.forecast.recharge_rules import STOP_CHANCE, RechargeRules
from fieldhand.forecast.route_cost import cost_model
from fieldhand.orienteering.overrun import overrun_probability
from fieldhand.robot.model import RobotProfile

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

#: A leg is unexpectedly costly if it costs more than all but this fraction; squared if the robot has just turned back
#: once, cubed after twice, so that it does not go to and fro for ever.
UNEXPECTED = 0.2

#: Number of drives in a row that are broken off for this reason, with nothing done in between.
MOST_TURNS = 3

#: Turning back must lower the probability of being stopped at least to this fraction.
_SAFER = 0.2

#: Metres driven at the mean pace that the pace so far is averaged with, as the first metres say little.
_SETTLES_M = 5.0

#: Probability of the costliest leg for which the pace is looked at in short steps.
_COSTLIEST = 1e-4

#: Fractions of a way after which the pace of a sampled mission is looked at.
_PARTS = np.linspace(0.0, 1.0, 21)[1:-1]

#: Metres of driving between two looks at the pace.
LOOK_M = 5.0


@dataclass(frozen=True)
class TurningRule:
    """The rule of one robot."""

    robot: RobotProfile

    def turns(
        self,
        left_m: ArrayLike,
        driven_m: ArrayLike,
        done_m: ArrayLike,
        on_m: ArrayLike,
        after_m: ArrayLike,
        back_m: ArrayLike,
        before: ArrayLike = 0,
    ) -> NDArray[np.bool_]:
        """Return True where the robot turns to the charger, elementwise.

        Args:
            left_m: Metres that can be driven on average with the charge above the stop level.
            driven_m, done_m: Metres driven on this leg, and metres of its way that are done.
            on_m: Metres of its way that are left.
            after_m: Metres from its end to the charger.
            back_m: Metres from here to the charger.
            before: Number of drives just broken off.
        """
        pace = self.pace(driven_m, done_m)
        unexpected = pace > self.usual_pace(np.asarray(before))
        on = self.stop_chance(np.asarray(left_m) - pace * np.asarray(on_m), after_m)
        back = self.stop_chance(left_m, back_m)
        return np.asarray(unexpected & (on > STOP_CHANCE) & (back < _SAFER * on))

    def turns_at(
        self, left_m: Floats, leg_m: Floats, costs: Floats, begin_m: Floats, after_m: float, before: int
    ) -> Floats:
        """Return the metres of the way after which sampled missions turn; infinite for those that do not.

        Args:
            left_m: As in :meth:`turns`, when they begin the drive.
            leg_m: Lengths of the way.
            costs: Metres driven for each metre of the way.
            begin_m, after_m: Metres to the charger from its begin and from its end.
            before: Number of drives just broken off.
        """
        found = np.full(len(leg_m), np.inf)
        likely = costs > float(self.usual_pace(before))
        likely &= self.stop_chance(left_m - costs * leg_m, after_m) > STOP_CHANCE
        some = np.flatnonzero(likely)
        if not len(some):
            return found
        leg, left, cost, begin = (a[some][:, None] for a in (leg_m, left_m, costs, begin_m))
        done = leg * _PARTS
        on = leg - done
        turns = self.turns(
            left - cost * done, cost * done, done, on, after_m, np.minimum(done + begin, on + after_m), before
        )
        first = turns.argmax(axis=1)
        found[some] = np.where(turns.any(axis=1), done[np.arange(len(some)), first], np.inf)
        return found

    def pace(self, driven_m: ArrayLike, done_m: ArrayLike) -> Floats:
        """Return the metres driven per metre of the way so far; 1 at the beginning."""
        return np.asarray((np.asarray(driven_m) + _SETTLES_M) / (np.asarray(done_m) + _SETTLES_M))

    def usual_pace(self, before: ArrayLike = 0) -> Floats:
        """Return the pace from which a leg is unexpectedly costly, after so many drives just broken off."""
        chance = np.where(np.asarray(before) < MOST_TURNS, UNEXPECTED ** (1.0 + np.asarray(before)), 0.0)
        return np.where(chance > 0.0, cost_model(self.robot).quantile(1.0 - np.maximum(chance, 1e-9)), np.inf)

    def stop_chance(self, left_m: ArrayLike, leg_m: ArrayLike) -> Floats:
        """Return the probability that a leg takes the battery to the stop level, elementwise."""
        second, third = self._cumulants
        leg = np.asarray(leg_m, dtype=np.float64)
        return overrun_probability(leg, second * leg**2, third * leg**3, left_m)

    def can_turn(self, left_m: float, on_m: float, after_m: float) -> bool:
        """Return True if the costliest leg would make the robot turn, so that the pace must be looked at."""
        pace = float(cost_model(self.robot).quantile(np.array(1.0 - _COSTLIEST)))
        return bool(self.stop_chance(left_m - pace * on_m, after_m) > STOP_CHANCE)

    @cached_property
    def _cumulants(self) -> tuple[float, float]:
        return cost_model(self.robot).cumulants()


def turn_back(
    missions: ChargingMissions,
    rules: RechargeRules,
    some: Ints,
    *,
    leg_m: Floats,
    costs: Floats,
    begin_m: Floats,
    from_charger_m: float,
    after_m: float,
    draw: Callable[[Ints, int], Floats],
    slower_s_per_m: float = 0.0,
) -> Floats:
    """Let sampled missions turn to the charger on a drive; return the metres that each drives on the last try.

    Args:
        missions, rules: The missions, which have not driven yet, and their rules.
        some: The missions that make the drive.
        leg_m: Length of its way, shape (some,), as the next two.
        costs: Metres driven for each metre of it.
        begin_m: Metres from its begin to the charger.
        from_charger_m, after_m: Metres from the charger to its end, and from there to the charger.
        draw: Returns the costs of a further leg of 1 m for missions; the second argument numbers these legs.
        slower_s_per_m: Seconds per metre that the drive takes beyond those of the mission's speed.
    """
    rule, way = TurningRule(rules.robot), leg_m * costs
    at = np.arange(len(some))
    leg_m, costs, begin_m = leg_m.copy(), costs.copy(), begin_m.copy()
    for turn in range(MOST_TURNS):
        at = at[np.isfinite(begin_m[at] + after_m) & (missions.ordered[some[at]] < rules.at_most)]
        left_m = (missions.level[some[at]] - rules.stop_percent) / rules.per_metre
        done_m = rule.turns_at(left_m, leg_m[at], costs[at], begin_m[at], after_m, turn)
        turned = np.isfinite(done_m)
        at, done_m = at[turned], done_m[turned]
        if not len(at):
            break
        those = some[at]
        missions.drive(done_m * costs[at], those, slower_s_per_m)
        back_m = np.minimum(done_m + begin_m[at], leg_m[at] - done_m + after_m)
        missions.interrupt(those, back_m, draw(those, 2 * turn))
        begin_m[at], leg_m[at], costs[at] = 0.0, from_charger_m, draw(those, 2 * turn + 1)
        way[at] = from_charger_m * costs[at]
    return way
