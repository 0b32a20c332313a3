"""The adaptive orienteering policy, which replans after every leg and may skip stops.

Exceeding a limit costs a price in reward, constant over the mission and chosen so that the failure probability of the
whole mission equals the accepted one. docs/orienteering.md derives it.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import ProblemError
from fieldhand.orienteering.problem import Limit, Problem, count_visits
from fieldhand.orienteering.route import Route, StoppingCriterion, solve

if TYPE_CHECKING:
    from fieldhand.orienteering.decision import DecisionSearch, SearchEffort, SuccessAfterLeg, VisitOrder
    from fieldhand.orienteering.prepared_problem import PreparedProblem

__all__ = ["Expectation", "Policy", "Route", "State", "StoppingCriterion", "compile_ahead", "solve"]

#: Target failure probability of the initial order, as a fraction of the accepted one. A mission that replans after
#: every leg fails up to a third more or less often (measured) than one that only skips stops of its order.
_AIM = 0.8
_PRICINGS = 3
_BISECTIONS = 24


@dataclass(frozen=True, kw_only=True)
class State:
    """The state of a mission in an orienteering problem.

    Attributes:
        vertex: Index of the vertex at which the robot is.
        left: Remaining amount of each limit, in the order and unit of the problem's limits; may be negative.
        visited: Vertices whose reward was collected.
        given_up: Vertices that must not be visited any more although their reward was not collected.
    """

    vertex: int
    left: tuple[float, ...]
    visited: frozenset[int] = frozenset()
    given_up: frozenset[int] = frozenset()


@dataclass(frozen=True, kw_only=True)
class Expectation:
    """The expected outcome of the rest of a mission.

    Attributes:
        vertices: Planned order from the current vertex to the end; which of them are skipped depends on the actual leg
            costs.
        reward: Expected further reward; missions that exceed a limit count 0.
        success: Probability of keeping all limits.
    """

    vertices: tuple[int, ...]
    reward: float
    success: float


class Policy:
    """An adaptive policy for a stochastic orienteering problem (``fh.Policy``).

    Call :meth:`next` before each leg; it replans from the robot's current state. One object serves one mission.

    Example:
        >>> policy = Policy(problem, seed=1)
        >>> policy.next(State(vertex=problem.start, left=(120.0,)))  # 120 of the only limit are left

    Args:
        problem: Problem at the start of the mission: vertices, rewards, leg costs and limits.
        seed: Seed of the random generator; equal seeds and leg costs give equal decisions.
        effort: Search effort per decision.
        risk_tolerance: Weight of reward against safety, 0 to 1: the price of a failure may fall to minus this share of
            the expected reward. At 0 the policy maximises the mean reward over all missions; near 1 that of successful
            missions, using up the whole failure probability.
        price: Price of a failure in units of reward, in addition to the lost reward; None to compute it at the first
            decision.
        collected: Reward already collected, if the problem is the remainder of a mission.
        warm: Initial order of vertices for the search.
        prepared: Result of :func:`prepare_problem` for ``problem``, if the caller already has it.

    Raises:
        ProblemError: ``risk_tolerance`` is not a number from 0 to 1.
    """

    def __init__(
        self,
        problem: Problem,
        seed: int,
        *,
        effort: SearchEffort | None = None,
        risk_tolerance: float = 0.6,
        price: float | None = None,
        collected: float = 0.0,
        warm: Sequence[int] = (),
        prepared: PreparedProblem | None = None,
    ) -> None:
        from fieldhand.orienteering.decision import SearchEffort
        from fieldhand.orienteering.prepared_problem import prepare_problem

        if not 0.0 <= risk_tolerance <= 1.0:
            raise ProblemError(f"a policy's risk tolerance is {risk_tolerance:g}", advice="give a number from 0 to 1")
        self._problem, self._prepared = problem, prepared or prepare_problem(problem)
        self._effort, self._risk_tolerance = effort or SearchEffort(), risk_tolerance
        self._state = np.array([seed], dtype=np.uint64)
        self._free = problem.rewards > 0.0
        self._free[[problem.start, problem.end]] = False
        self._price, self._least_price = price, 0.0
        self._collected, self._warm, self._first, self._begun = collected, tuple(warm), tuple(warm), False
        self._last: tuple[DecisionSearch, VisitOrder, float] | None = None
        self._expectation = Expectation(vertices=(), reward=0.0, success=1.0)

    @property
    def expectation(self) -> Expectation:
        """Return the expected outcome as of the last decision."""
        return self._expectation

    @property
    def price(self) -> float | None:
        """Return the price of a failure in reward; None before a decision needed it."""
        return self._price

    @property
    def prepared(self) -> PreparedProblem:
        """Return the prepared problem."""
        return self._prepared

    @property
    def plan(self) -> tuple[DecisionSearch, VisitOrder, float] | None:
        """Return the search, order and bonus of the last decision.

        None if there was nothing to decide, or if the order is so long that it is driven as planned.
        """
        return self._last

    def lengths(self, vertex: int) -> NDArray[np.float64]:
        """Return the lengths of the legs from a vertex to every vertex, shape (n,)."""
        return self._prepared.row(vertex)

    @property
    def least_price(self) -> float:
        """Return the lowest price that the risk tolerance allows."""
        return self._least_price

    def again(
        self, seed: int, price: float | None = None, warm: Sequence[int] = (), effort: SearchEffort | None = None
    ) -> Policy:
        """Return a policy for another mission through the same problem at a given price of a failure."""
        return Policy(
            self._problem,
            seed,
            effort=effort or self._effort,
            risk_tolerance=self._risk_tolerance,
            price=price,
            warm=warm or self._first,
            prepared=self._prepared,
        )

    def next(self, state: State, seconds: float | None = None) -> int:
        """Return the next vertex to visit, or the problem's end if no visit is worth its risk.

        Args:
            state: State of the mission.
            seconds: Search time in seconds; None to search by the counted effort, which gives reproducible results on
                any machine.

        Raises:
            ProblemError: The state does not fit the problem: a vertex does not exist, or an amount is missing or not a
                number.
        """
        from fieldhand.orienteering.annealing import stops_of
        from fieldhand.orienteering.decision import LONG, DecisionSearch, VisitOrder

        began = time.perf_counter()
        self._check(state)
        self._last = None
        free = self._free.copy()
        free[[*state.visited, *state.given_up]] = False
        max_visits = self._problem.max_visits
        if max_visits is not None:
            max_visits = max(0, max_visits - count_visits(self._problem, state.visited))
            free &= max_visits > 0
        search = DecisionSearch(self._prepared, state.vertex, state.left, free, self._effort, self._state, max_visits)
        if min(state.left) <= 0.0:
            return self._settle(state, None)
        if not len(search.free):
            return self._settle(state, search.order(search.free, 0.0, 0))
        certain = self._prepared.cumulants[0] <= 0.0
        accepted = min(limit.failure_probability for limit in self._problem.limits)
        safe: tuple[int, ...] = ()
        if certain or len(search.free) > LONG:
            # Search at the accepted probability, not at 50 %: a long last leg takes its risk all at once, when no stop
            # is left that could be skipped.
            route = search.route(accepted, self._warm, self._rounds(search))
            while seconds is not None and time.perf_counter() - began < seconds:
                route = search.route(accepted, route.tolist(), 16 * self._effort.rounds)
            # With deterministic legs nothing is learned on the way: the best route is the best policy.
            if certain or len(route) > LONG:
                ahead = VisitOrder(stops=route, first=0, worth=self._reward(route.tolist()), success=1.0)
                return self._settle(state, ahead)
            safe = tuple(route.tolist())
            if self._price is None:
                self._warm = safe
        collected = self._collected + self._reward(
            [*(state.visited - {self._problem.start, self._problem.end}), self._problem.end]
        )
        new = False
        if self._price is None:
            new, self._price = True, self._priced(search, collected, safe)
        elif not (self._begun or self._warm):
            self._plan(search.planned(self._price + collected, (), self._rounds(search)))
        self._begun = True
        bonus = self._price + collected
        order = search.best(bonus, self._warm)
        if new and order.first == len(order.stops):
            setting_out = self._safe_route(search, accepted, safe)
            if setting_out is not None:
                # The price is computed anew after that leg, for the remainder of this route.
                self._price, self._begun = None, False
                return self._settle(state, setting_out)
        elif safe:
            other = search.order(stops_of(safe, search.free), bonus, self._effort.insertions)
            order = max(order, other, key=lambda one: one.value(bonus))
        while seconds is not None and time.perf_counter() - began < seconds:
            order = search.bettered(order, bonus)
        self._last = (search, order, bonus)
        return self._settle(state, order)

    def chances(self) -> dict[int, float]:
        """Return for each vertex of the planned order the probability of a visit, if the mission only skips stops.

        Vertices that only a new plan would add are not included. If the order is long and driven as planned, all are 1.
        """
        ahead = self._expectation.vertices[1:-1]
        if self._last is None or not ahead:
            return dict.fromkeys(ahead, 1.0)
        search, order, bonus = self._last
        found = search.chances(order.stops, bonus)[order.first :]
        return {vertex: min(1.0, float(chance)) for vertex, chance in zip(ahead, found, strict=True)}

    def success_after_leg(self) -> SuccessAfterLeg | None:
        """Return the success probabilities computed for the chosen leg; None if no programme chose it."""
        if self._last is None:
            return None
        search, order, bonus = self._last
        return search.success_after_leg(order, bonus)

    def _check(self, state: State) -> None:
        size, limits = self._problem.size, len(self._problem.limits)
        for vertex in (state.vertex, *state.visited, *state.given_up):
            if not 0 <= vertex < size:
                raise ProblemError(f"the mission knows vertex {vertex}, which is not in 0 to {size - 1}")
        if len(state.left) != limits or not np.isfinite(state.left).all():
            raise ProblemError(
                f"these amounts of the limits are left: {', '.join(f'{x:g}' for x in state.left)}",
                advice=f"give {limits} numbers",
            )

    def _priced(self, search: DecisionSearch, collected: float, safe: Sequence[int]) -> float:
        """Return the lowest price at which the best order keeps to the binding failure probability.

        Args:
            search, collected: The search from the current state; reward already collected.
            safe: Stops of a fixed route planned at the accepted probability, if there is one. It can be safer than any
                part of the order that is best at price 0: many short legs are less uncertain than one long leg home.
        """
        from fieldhand.orienteering.annealing import stops_of

        accepted = 1.0 - _AIM * min(limit.failure_probability for limit in self._problem.limits)
        planned = search.planned(collected, self._warm, self._rounds(search))
        price, order = self._at_least_price(search, planned, collected, accepted)
        if safe and order.success < accepted and order.first < len(order.stops):
            begun = search.order(stops_of(safe, search.free), price + collected, 0)
            safer = self._at_least_price(search, begun, collected, accepted)
            # The price of an order without stops is meaningless.
            if safer[1].success > order.success and safer[1].first < len(safer[1].stops):
                price, order = safer
        self._plan(order)
        return price

    def _at_least_price(
        self, search: DecisionSearch, order: VisitOrder, collected: float, accepted: float
    ) -> tuple[float, VisitOrder]:
        """Return the lowest price at which an order is safe enough, and the order improved at that price."""
        price = 0.0
        for _ in range(_PRICINGS):
            expected = order.worth / max(order.success, 1e-9) + collected
            self._least_price = -self._risk_tolerance * expected
            low, high = self._least_price, 50.0 * max(expected, 1e-9)
            for _ in range(_BISECTIONS):
                middle = 0.5 * (low + high)
                if search.order(order.stops, middle + collected, 0).success >= accepted:
                    high = middle
                else:
                    low = middle
            price = high
            order = search.order(order.stops, price + collected, self._effort.insertions)
            order = search.remade(order, price + collected)
        return price, order

    def _safe_route(self, search: DecisionSearch, accepted: float, safe: Sequence[int]) -> VisitOrder | None:
        """Return the route to start on if no price leads to a visit; None if no visit is safe enough.

        A long first leg and a long last leg can use most of the accepted probability before any reward is collected.
        Then there may be no price between staying and risking too much until the first leg has been driven.

        Args:
            search, accepted: The search from the current state; the accepted failure probability.
            safe: Stops of a route found earlier; empty, or not safe enough, to search for one.
        """
        from fieldhand.orienteering.decision import VisitOrder

        route = np.array(safe, dtype=np.int64)
        if not (len(route) and search.is_safe(route)):
            route = search.route(accepted, (), 100 * self._effort.rounds)
        if not len(route) or not search.is_safe(route):
            return None
        return VisitOrder(stops=route, first=0, worth=self._reward(route.tolist()), success=1.0)

    def _plan(self, order: VisitOrder) -> None:
        """Store the order with which the mission begins."""
        self._warm = self._first = tuple(order.stops.tolist())

    def _settle(self, state: State, order: VisitOrder | None) -> int:
        """Store the planned order and return its first vertex."""
        end = self._problem.end
        if order is None:
            self._warm, self._expectation = (), Expectation(vertices=(state.vertex, end), reward=0.0, success=0.0)
            return end
        self._warm = tuple(int(v) for v in order.stops[order.first + 1 :])
        ahead = tuple(int(v) for v in order.stops[order.first :])
        self._expectation = Expectation(vertices=(state.vertex, *ahead, end), reward=order.worth, success=order.success)
        return ahead[0] if ahead else end

    def _rounds(self, search: DecisionSearch) -> int:
        """Return the number of annealing rounds; the first plan of a mission gets more."""
        return self._effort.rounds if self._warm or self._begun else 100 * self._effort.rounds + 20 * len(search.free)

    def _reward(self, vertices: Sequence[int]) -> float:
        return float(self._problem.rewards[list(vertices)].sum())


def compile_ahead() -> None:
    """Compile the inner loops now (about ten seconds) and cache them on disk, so that no later process has to wait.

    Covers fixed routes, policies and their visit probabilities, for all forms of distances, and orders of many visits.
    """
    from fieldhand.orienteering.network import Network
    from fieldhand.orienteering.shortest_order import COMPILED_FROM, shortest_order

    ways = np.array([[i, i + 1] for i in range(11)], dtype=np.int64)
    chain = Network(nodes=12, edges=ways, lengths=np.full(11, 0.1))
    problem, _ = chain.problem(np.ones(12), 0, 11, (Limit(budget=2.0),), precision="single")
    problem = replace(problem, legs_after=(0.1,))
    solve(problem, 0, StoppingCriterion(rounds=1))
    policy = Policy(problem, 0)
    for seconds in (None, 0.05):
        policy.next(State(vertex=0, left=(2.0,)), seconds)
    policy.chances()
    places = np.arange(COMPILED_FROM, dtype=np.float64)
    shortest_order(np.abs(places[:, None] - places), 0, None)
