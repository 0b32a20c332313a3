"""Optional visits of sampled missions that charge in between, by the decisions that the guard takes on board.

Before each visit a mission decides from its own charge and time whether it charges first
(:mod:`fieldhand.forecast.recharge_rules`). Once there is no time to charge, it makes only the visits for which its
charge suffices.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import DriveFault
from fieldhand.forecast.charging_missions import ChargingMissions
from fieldhand.forecast.mission_state import Visit, Work
from fieldhand.forecast.recharge_rules import ANY_NUMBER, RechargeRules
from fieldhand.forecast.remaining_work import RemainingWork
from fieldhand.forecast.resource_limits import ResourceLimit
from fieldhand.forecast.route_cost import cost_model
from fieldhand.forecast.turning_back import turn_back
from fieldhand.site.model import Place

if TYPE_CHECKING:
    from fieldhand.orienteering.policy import Policy
    from fieldhand.orienteering.preview import Departures

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

#: Number of the charger, where others are numbers of visits.
_CHARGER = -1


@dataclass(frozen=True, kw_only=True)
class _Spot:
    """The charger and home as seen from the place where a visit ends.

    Attributes:
        away_m: Metres to the charger; infinite if there is no way.
        home_m: Metres to the exit for a low budget; infinite if there is no way.
    """

    away_m: float
    home_m: float


@dataclass(frozen=True, kw_only=True)
class FromCharger:
    """An optional visit as seen from the charger.

    Attributes:
        leg_m: Metres to it; infinite if there is no way.
        needed: Charge in percent that suffices.
        far: Up to what percent to charge for it (:meth:`RechargeRules.far`).
    """

    leg_m: float
    needed: float
    far: float

    def is_within(self, rules: RechargeRules) -> bool:
        """Return True if a charged battery suffices."""
        return self.needed <= rules.most_percent


def from_charger(rules: RechargeRules, visit: Visit, length: Callable[[Place, Place], float]) -> FromCharger:
    """Return an optional visit as seen from the charger.

    Args:
        rules: Rules of recharging.
        visit: The visit.
        length: Returns the metres between two places.
    """
    there_m, back_m = _metres(length, rules.charger, visit.place), _metres(length, visit.end, rules.charger)
    if not math.isfinite(there_m + back_m):
        return FromCharger(leg_m=there_m, needed=math.inf, far=math.inf)
    sums, work = _there_and_back(np.array(there_m), back_m), _docked(rules, visit)
    return FromCharger(
        leg_m=there_m,
        needed=float(rules.optional(sums, work)),
        far=rules.far(float(rules.certain(sums, work))),
    )


class ChargedVisits:
    """Sampled missions on their optional visits (:class:`fieldhand.orienteering.preview.Detours`).

    Args:
        missions: The missions when they reach the visits; they go on here.
        rules: Rules of recharging.
        here: Place where the visits begin, vertex 0.
        visits: Candidates, vertices 1 and up.
        rest: Mandatory work that follows.
        limits: Limits of the whole mission, as when they were reached.
        budgets: Budgets of the Task, with which a charge must be kept.
        length: Returns the metres between two places.
        home: Returns the exit for a low budget from a place.
        slower_s_per_m: Seconds per metre that the drives to visits take beyond those of the mission's speed.
    """

    def __init__(
        self,
        missions: ChargingMissions,
        rules: RechargeRules,
        *,
        here: Place,
        visits: Sequence[Visit],
        rest: RemainingWork,
        limits: Sequence[ResourceLimit],
        budgets: Sequence[ResourceLimit],
        length: Callable[[Place, Place], float],
        home: Callable[[Place], Place],
        slower_s_per_m: float = 0.0,
    ) -> None:
        self.missions, self._rules, self._rest = missions, rules, rest
        self._here, self._visits, self._slower = here, visits, slower_s_per_m
        self._limits, self._budgets, self._length, self._home = limits, budgets, length, home
        #: Policy from the charger, if missions plan anew there.
        self.policy: Policy | None = None
        draws = len(missions.level)
        self._at: Ints = np.zeros(draws, dtype=np.int64)
        self._dry: Flags = np.zeros(draws, dtype=bool)
        # The drive that each mission is about to make: its length, and from its begin to the charger.
        self._leg_m, self._begin_m = np.zeros(draws), np.zeros(draws)
        self._rng = np.random.default_rng(0)
        self._spots: dict[int, _Spot] = {}
        self._first: dict[int, FromCharger] = {}

    @property
    def charger(self) -> Place:
        """Return the charger."""
        return self._rules.charger

    def left(self, some: Ints) -> Floats:
        """Return what is left of each limit in metres of driving, shape (missions, limits)."""
        missions, rules = self.missions, self._rules
        percent, charged = missions.spent_percent(some), missions.charged_percent(some)
        used = {
            "distance_m": missions.metres[some],
            "duration_s": missions.spent_seconds(some),
            "energy_percent": percent,
            "reserve": percent,
        }
        found = np.empty((len(some), len(self._limits)))
        for number, limit in enumerate(self._limits):
            amount = limit.limit + limit.per_percent * (charged - percent) - used[limit.kind]
            if limit.kind == "reserve":
                counted = rules.at_most + rules.planned < ANY_NUMBER
                amount = amount + charged - counted * rules.usable_percent * missions.charges[some]
            found[:, number] = amount / limit.per_metre - limit.metres_of(self._rest.work, rules.robot)
        return found

    def length(self, stop: int) -> float:
        """Return the metres from the charger to a stop, or to the work that follows."""
        if stop > len(self._visits):
            return 0.0 if self._rest.first is None else self._metres(self._rules.charger, self._rest.first)
        return self._from_charger(stop).leg_m

    def set_out(self, some: Ints, stop: int, legs: Floats, rng: np.random.Generator) -> Departures:
        """Decide on the visit to a stop, and charge first where it is needed.

        Args:
            some: The missions.
            stop: Vertex of the visit.
            legs: Metres from the place of each to the stop.
            rng: Random generator of the leg costs.
        """
        from fieldhand.orienteering.preview import Departures

        rules, missions, visit = self._rules, self.missions, self._visits[stop - 1]
        level, away = missions.level[some], self._away(some)
        start = self._from_charger(stop)
        begin_m, possible = start.leg_m, start.is_within(rules)
        needed = rules.needed(_there_and_back(legs, self._spot(stop).away_m), _docked(rules, visit))
        must = rules.must_charge(level, needed)
        wants = must & rules.gains(level) & (missions.ordered[some] < rules.at_most) & np.isfinite(away)
        wants &= possible & (self._at[some] != _CHARGER)
        charges = wants & ~self._dry[some]
        if charges.any():
            charges &= self._fits(some, visit, stop, away, start)
        self._dry[some] |= wants & ~charges
        if charges.any():
            going = some[charges]
            costs = cost_model(rules.robot).draw(rng, len(going))
            missions.interrupt(going, away[charges], costs, far=start.far)
            self._at[going] = _CHARGER
        self._rng = rng
        self._leg_m[some] = np.where(charges, begin_m, legs)
        self._begin_m[some] = np.where(charges, 0.0, away)
        makes = possible & ~(must & self._dry[some])
        waits = charges & (self.policy is not None)
        return Departures(makes=makes & ~waits, waits=waits, legs=np.where(charges, begin_m, legs))

    def arrive(self, some: Ints, stop: int, costs: Floats) -> None:
        """Drive to a stop at these costs in metres, and make the visit."""
        visit, leg_m = self._visits[stop - 1], self._leg_m[some]
        costs = turn_back(
            self.missions,
            self._rules,
            some,
            leg_m=leg_m,
            costs=np.divide(costs, leg_m, out=np.ones_like(costs), where=leg_m > 0.0),
            begin_m=self._begin_m[some],
            from_charger_m=self._from_charger(stop).leg_m,
            after_m=self._spot(stop).away_m,
            draw=self._draw,
            slower_s_per_m=self._slower,
        )
        self.missions.drive(costs + visit.inside_m, some, self._slower)
        self.missions.act(visit.work, some)
        self._at[some] = stop

    def _draw(self, some: Ints, _number: int) -> Floats:
        return cost_model(self._rules.robot).draw(self._rng, len(some))

    def ended(self) -> ChargingMissions:
        """Return the missions after their visits, to go on from there independently."""
        missions = self.missions.copy()
        missions.away_m = self._away(np.arange(len(self._at)))
        return missions

    @property
    def onward_m(self) -> Floats:
        """Return the metres from the last visit of each mission to the work that follows."""
        to = self._rest.first
        found = np.zeros(len(self._at))
        if to is not None:
            for vertex in np.unique(self._at).tolist():
                found[self._at == vertex] = self._metres(self._end(vertex), to)
        return found

    def _fits(self, some: Ints, visit: Visit, stop: int, away: Floats, start: FromCharger) -> Flags:
        """Return True where charging, the visit and the way home keep the budgets."""
        rules, missions, begin_m = self._rules, self.missions, start.leg_m
        charging, robot = rules.robot.energy.charging, rules.robot
        assert charging is not None  # noqa: S101  rules exist only for a robot that charges
        home_m = self._spot(stop).home_m
        fits = np.full(len(some), math.isfinite(begin_m + home_m))
        if not fits.any():
            return fits
        level = missions.level[some]
        full_s = charging.seconds(level, rules.target(math.inf, level, start.far), robot.energy.capacity_j)
        legs = [away**n + begin_m**n + home_m**n for n in (1, 2, 3)]
        used = {
            "distance_m": missions.metres[some],
            "duration_s": missions.spent_seconds(some),
            "energy_percent": missions.spent_percent(some),
        }
        around = Work(seconds=charging.around_s, joules=charging.around_j)
        slower = Work(seconds=begin_m * self._slower)
        for budget in self._budgets:
            work = budget.of_work(robot, around + visit.work + slower)
            at_charger = full_s if budget.kind == "duration_s" else 0.0  # it supplies the robot
            left = budget.limit - used[budget.kind] - work - at_charger
            fits &= rules.longest(legs, budget.failure_probability) * budget.per_metre <= left
        return fits

    def _from_charger(self, stop: int) -> FromCharger:
        """Return a stop as seen from the charger."""
        found = self._first.get(stop)
        if found is None:
            found = self._first[stop] = from_charger(self._rules, self._visits[stop - 1], self._length)
        return found

    def _away(self, some: Ints) -> Floats:
        """Return the metres of missions to the charger."""
        at = self._at[some]
        found = np.empty(len(some))
        for vertex in np.unique(at).tolist():
            found[at == vertex] = self._spot(vertex).away_m
        return found

    def _spot(self, vertex: int) -> _Spot:
        found = self._spots.get(vertex)
        if found is None:
            end = self._end(vertex)
            found = self._spots[vertex] = _Spot(
                away_m=self._metres(end, self._rules.charger), home_m=self._metres(end, self._home(end))
            )
        return found

    def _end(self, vertex: int) -> Place:
        if vertex == _CHARGER:
            return self._rules.charger
        return self._here if vertex == 0 else self._visits[vertex - 1].end

    def _metres(self, a: Place, b: Place) -> float:
        return _metres(self._length, a, b)


def _metres(length: Callable[[Place, Place], float], a: Place, b: Place) -> float:
    try:
        return length(a, b)
    except DriveFault:
        return math.inf


def _docked(rules: RechargeRules, visit: Visit) -> float:
    """Return the charge in percent that a visit takes, and docking."""
    work = visit.work
    return rules.robot.percent(0.0, work.seconds, work.joules) + work.metres * rules.per_metre + rules.dock_percent


def _there_and_back(there: Floats, back_m: float) -> list[Floats]:
    """Return the sums of the lengths of two legs, of their squares and of their cubes."""
    return [there**n + back_m**n for n in (1, 2, 3)]
