"""One decision of a mission that may skip stops: candidate visiting orders and the value of each.

A mission maximises ``E[(reward + bonus) * success]``, where success means that no limit is exceeded: reward counts only
on success, and success itself counts ``bonus``, the price of a failure. A bonus below 0 trades safety for reward.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.annealing import HOT, WARM, Annealing, stops_of
from fieldhand.orienteering.kernels.insertion import floors_of, grow
from fieldhand.orienteering.kernels.legs import uniform
from fieldhand.orienteering.kernels.order_value import WORK, backward, drive, forward
from fieldhand.orienteering.overrun import overrun_probability, quantile_table
from fieldhand.orienteering.prepared_problem import PreparedProblem

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

#: Orders with more stops than this are driven as planned, without a dynamic programme that decides what to skip.
LONG = 64
#: Overrun probabilities of the fixed routes from which the first order of a mission is grown.
_FIRST = (0.15, 0.4)
#: Orders with more stops than this are remade proportionally less often.
_SHORT = 24
#: Maximum range of the programme for missions with cheap legs, as a multiple of the current amount left.
_WIDEST = 4
#: Vertices up to this multiple of the budget away, at mean leg cost, are considered: cheap legs may bring them within
#: reach.
_LUCK = 1.15


@dataclass(frozen=True, kw_only=True)
class SearchEffort:
    """Search effort per decision, counted in steps so that a problem gives the same mission on any machine.

    Attributes:
        levels: Overrun probabilities at which the initial fixed routes are searched.
        rounds: Annealing rounds per initial route.
        insertions: Maximum number of stops inserted into each initial route.
        skip: Number of stops ahead among which the next one is chosen.
        points: Number of grid points for the amount left.
        remakes: How often part of a mission's initial order is removed and grown again.
    """

    levels: tuple[float, ...] = (0.4,)
    rounds: int = 20
    insertions: int = 4
    skip: int = 6
    points: int = 64
    remakes: int = 40


@dataclass(frozen=True, kw_only=True, eq=False)
class SuccessAfterLeg:
    """The probability of success after a leg, by amount left, as computed before the leg is driven.

    Attributes:
        limit: Index of the limit whose amount left is the state of the programme.
        step: Distance between grid points; the first point is 0.
        success: Probability at each grid point, after the leg and the work at its end.
    """

    limit: int
    step: float
    success: Floats

    def at(self, left: Floats) -> Floats:
        """Return the probability of success for an amount left after the leg; 0 if it is negative."""
        grid = self.step * np.arange(len(self.success))
        return np.asarray(np.interp(left, grid, self.success, left=0.0))


@dataclass(frozen=True, kw_only=True, eq=False)
class VisitOrder:
    """Stops in visiting order; the robot may skip some of them.

    Attributes:
        stops: The stops, without start and end.
        first: Index of the next stop; ``len(stops)`` for the end.
        worth: Expected further reward; missions that exceed a limit count 0.
        success: Probability that no limit is exceeded.
    """

    stops: Ints
    first: int
    worth: float
    success: float

    def value(self, bonus: float) -> float:
        """Return the value of the order if success is worth ``bonus``."""
        return self.worth + bonus * self.success


class DecisionSearch:
    """A search for the best visiting order from one vertex, given the amounts left and the free vertices.

    Args:
        prepared: The problem.
        here: Current vertex.
        left: Amount left of each limit.
        free: True for each vertex that may still be visited, shape (n,).
        effort: Search effort.
        state: State of the random generator.
        max_visits: Maximum number of further stops; None for no limit.
    """

    def __init__(
        self,
        prepared: PreparedProblem,
        here: int,
        left: Sequence[float],
        free: NDArray[np.bool_],
        effort: SearchEffort,
        state: NDArray[np.uint64],
        max_visits: int | None = None,
    ) -> None:
        self._max_visits = prepared.size if max_visits is None else max_visits
        self._prepared, self._here, self._effort, self._state = prepared, here, effort, state
        self._left = np.array(left, dtype=np.float64)
        # The programme runs over the amount left of the tightest limit; the others enter as minimum amounts of it.
        by_budget = np.argsort(self._left, kind="stable")
        self._binding, self._budgets = int(by_budget[0]), self._left[by_budget]
        self._step = max(float(self._budgets[0]), 1e-300) / effort.points
        self._service = np.ascontiguousarray(prepared.service[by_budget])
        self.free = self._reachable(free)
        self._ends: Floats | None = None

    def route(self, level: float, warm: Sequence[int], rounds: int) -> Ints:
        """Return the stops of a fixed route that exceeds no limit with more than probability ``level``."""
        tables = np.tile(cached_quantiles(level), (len(self._budgets), 1))
        stops = stops_of(warm, self.free)
        found = Annealing(
            self._prepared, self._here, self.free, self._left, tables, stops, self._state, self._max_visits
        )
        found.improve(rounds, WARM if len(stops) else HOT)
        return found.best

    def is_safe(self, stops: Ints) -> bool:
        """Return True if a fixed route keeps to each limit's failure probability."""
        prepared, problem = self._prepared, self._prepared.problem
        route = [self._here, *stops.tolist(), problem.end]
        legs = np.array([problem.length(a, b) for a, b in itertools.pairwise(route)])
        first, squares, cubes = (float((legs**k).sum() + prepared.afterwards[k - 1]) for k in (1, 2, 3))
        second, third = prepared.cumulants
        left = self._left - prepared.service[:, [*route[1:-1], prepared.size]].sum(axis=1)
        accepted = [limit.failure_probability for limit in problem.limits]
        return bool(
            (overrun_probability(first, second * squares, third * cubes, left) <= np.array(accepted) * 1.01).all()
        )

    def order(self, stops: Ints, bonus: float, insertions: int) -> VisitOrder:
        """Insert up to ``insertions`` stops into an order and return it with its value."""
        prepared, effort = self._prepared, self._effort
        longest = min(max(len(stops), LONG), self._max_visits)
        grown, figures = np.empty(longest + 2, np.int64), np.empty(3)
        count = grow(
            stops, self._here, self.free, longest, insertions, prepared.lengths, prepared.near, prepared.rewards,
            self._service, self._budgets, self.ends(), bonus, effort.skip, prepared.points, prepared.weights,
            grown, figures,
        )  # fmt: skip
        return VisitOrder(
            stops=grown[:count], first=int(figures[2]), worth=float(figures[0]), success=float(figures[1])
        )

    def chances(self, stops: Ints, bonus: float) -> Floats:
        """Return for each stop of an order the probability of a visit, if the mission only skips stops."""
        prepared, step = self._prepared, self._step
        route, choice, _ = self._programme(stops, bonus)
        mass = np.empty(choice.shape)
        forward(
            route, prepared.lengths, self._service[0], step, self._effort.skip, prepared.points, prepared.weights,
            choice, mass, np.empty((WORK, choice.shape[1])),
        )  # fmt: skip
        return np.asarray(mass[1:-1].sum(axis=1))

    @property
    def binding(self) -> int:
        """Return the index of the limit that the dynamic programme runs over."""
        return self._binding

    def choices(self, stops: Ints, bonus: float, most_left: float) -> tuple[Ints, float]:
        """Return the choices of a mission that only skips stops of an order.

        Args:
            stops, bonus: The order, and the value of success.
            most_left: Largest amount left of the binding limit over all missions.

        Returns:
            For each position (0 for the current vertex) and amount left the next position, ``len(stops) + 1`` for the
            end; and the step between amounts, of which the first is 0.
        """
        size = max(self._effort.points, int(np.ceil(most_left / self._step))) + 1
        return self._programme(stops, bonus, min(size, _WIDEST * self._effort.points))[1], self._step

    def success_after_leg(self, order: VisitOrder, bonus: float) -> SuccessAfterLeg:
        """Return the probability of success after the current leg, by amount left, from the programme."""
        success = self._programme(order.stops, bonus)[2]
        return SuccessAfterLeg(limit=self._binding, step=self._step, success=success[order.first + 1])

    def planned(self, bonus: float, warm: Sequence[int], rounds: int) -> VisitOrder:
        """Return the initial order of a mission: the best of several routes, each improved by :meth:`remade`."""
        orders = [self.order(self.route(level, warm, rounds), bonus, self._effort.insertions) for level in _FIRST]
        if warm:
            orders.append(self.order(stops_of(warm, self.free)[: self._max_visits], bonus, self._effort.insertions))
        return max((self.remade(order, bonus) for order in orders), key=lambda order: order.value(bonus))

    def remade(self, order: VisitOrder, bonus: float) -> VisitOrder:
        """Remove and reinsert stops several times; return the best order found."""
        # Programmes of long orders take long to compute, and they are replanned on the way anyway.
        for _ in range(self._effort.remakes * _SHORT // max(_SHORT, len(order.stops))):
            kept = self._thinned(order.stops)
            other = self.order(kept, bonus, len(order.stops) - len(kept) + 1)
            if other.value(bonus) > order.value(bonus):
                order = other
        return order

    def best(self, bonus: float, warm: Sequence[int]) -> VisitOrder:
        """Return the most valuable order grown from ``warm`` and from fixed routes of several levels."""
        options = [stops_of(warm, self.free)[: self._max_visits]]
        for level in self._effort.levels:
            stops = self.route(level, options[0].tolist(), self._effort.rounds)
            if not any(np.array_equal(stops, option) for option in options):
                options.append(stops)
        orders = [self.order(stops, bonus, self._effort.insertions) for stops in options]
        return max(orders, key=lambda order: order.value(bonus))

    def bettered(self, order: VisitOrder, bonus: float) -> VisitOrder:
        """Search once more from an order at a random level; return the better of the two."""
        level = 0.05 + 0.6 * uniform(self._state)
        stops = self.route(level, order.stops.tolist(), 16 * self._effort.rounds)
        other = self.order(stops, bonus, 2 * self._effort.insertions)
        return other if other.value(bonus) > order.value(bonus) else order

    def ends(self) -> Floats:
        """Return the probability, by amount left at the end, that the legs after it keep to the limit."""
        if self._ends is None:
            self._ends = self._ends_up_to(self._effort.points + 1)
        return self._ends

    def _ends_up_to(self, size: int) -> Floats:
        prepared = self._prepared
        now, then, nothing, unused = np.ones(size), np.empty(size), np.zeros(size), np.empty(size)
        for leg in reversed(prepared.problem.legs_after):
            drive(nothing, now, unused, then, leg, 0.0, self._step, prepared.points, prepared.weights)
            now, then = then, now
        return now

    def _programme(self, stops: Ints, bonus: float, size: int | None = None) -> tuple[Ints, Ints, Floats]:
        """Return the route, and per position and amount left the next position and the probability of success."""
        prepared, effort = self._prepared, self._effort
        ends = self.ends() if size is None else self._ends_up_to(size)
        size = len(ends)
        route = np.array([self._here, *stops, prepared.size], dtype=np.int64)
        worth, success, ahead = (np.empty((len(route), size)) for _ in range(3))
        choice, floors = np.empty((len(route), size), np.int64), np.empty(len(route))
        floors_of(route, self._service, self._budgets, floors)
        backward(
            route, prepared.lengths, prepared.rewards, self._service[0], ends, floors, bonus, self._step,
            effort.skip, prepared.points, prepared.weights, worth, success, ahead, choice,
            np.empty((WORK, size)),
        )  # fmt: skip
        return route, choice, success

    def _thinned(self, stops: Ints) -> Ints:
        """Return the stops with one to three of them removed, either consecutive or near a random free vertex."""
        gone = 1 + int(3.0 * uniform(self._state))
        if uniform(self._state) < 0.5:
            first = int(uniform(self._state) * len(stops))
            return np.delete(stops, np.arange(first, min(first + gone, len(stops))))
        around = int(self.free[int(uniform(self._state) * len(self.free))])
        near = [around, *self._prepared.near[around].tolist()]
        inside = set(stops.tolist())
        out = [v for v in near if v in inside][:gone]
        return stops[~np.isin(stops, out)]

    def _reachable(self, free: NDArray[np.bool_]) -> Ints:
        prepared = self._prepared
        there = prepared.row(self._here) + prepared.row(prepared.problem.end) + prepared.afterwards[0]
        there = there + self._service[0, :-1]
        inside = free & (there <= _LUCK * max(float(self._budgets[0]), 0.0)) & (prepared.rewards[:-1] > 0.0)
        inside[self._here] = False
        inside[prepared.problem.end] = False
        return np.flatnonzero(inside).astype(np.int64)


_TABLES: dict[float, Floats] = {}


def cached_quantiles(level: float) -> Floats:
    """Return the quantile table of a probability, computed once."""
    if level not in _TABLES:
        _TABLES[level] = quantile_table(level)
    return _TABLES[level]
