"""Which vertex comes next: after every leg, the order of stops that is worth most to a robot that may skip some.

A failure has a price, the same in the whole mission, at which the chance of one over the whole mission is the one that
is accepted. docs/orienteering.md derives it.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import ProblemError
from fieldhand.orienteering.problem import Limit, Problem, visits
from fieldhand.orienteering.route import Route, Stop, solve

if TYPE_CHECKING:
    from fieldhand.orienteering.adaptive import Depth, Foresight, Lookout, Order
    from fieldhand.orienteering.ground import Ground

__all__ = ["Outlook", "Policy", "Route", "State", "Stop", "compile_ahead", "solve"]

#: The chance at which the first order is priced, of that which is accepted. A mission whose order is made anew after
#: every leg fails more or less often than one whose order is only shortened: measured, by up to a third.
_AIM = 0.8
_PRICINGS = 3
_BISECTIONS = 24


@dataclass(frozen=True, kw_only=True)
class State:
    """Where a mission stands.

    Attributes:
        vertex: Where the robot is.
        left: What is left of each limit, in their order; may be negative.
        visited: Vertices that have been collected.
        given_up: Vertices that may not be visited any more, though nothing was collected there.
    """

    vertex: int
    left: tuple[float, ...]
    visited: frozenset[int] = frozenset()
    given_up: frozenset[int] = frozenset()


@dataclass(frozen=True, kw_only=True)
class Outlook:
    """What a policy expects from a state on.

    Attributes:
        vertices: The order it means to drive, from here to the end; luck decides which of them it skips.
        reward: Still to come, on average, of missions that keep to the limits.
        success: Chance to keep to them.
    """

    vertices: tuple[int, ...]
    reward: float
    success: float


class Policy:
    """Drives one mission through a problem: asked before each leg, it plans anew from where the robot is.

    Args:
        problem: As it stands before the mission.
        seed: The same seed and the same leg costs give the same mission.
        depth: How much to search at a decision.
        daring: What part of the reward that is expected a mission may give up before safety gives way to reward, 0 to
            1. At 0 the most is collected over all missions; near 1 the most over those that succeed, and the whole
            failure probability is used up for it.
        price: What a failure costs beside the reward; None to find it at the first decision.
        collected: Reward that is safe already, where the problem is what is left of a mission.
        warm: Vertices that were planned, in their order, to begin the search with.
        ground: Of the problem, where it is known.

    Raises:
        ProblemError: ``daring`` is not a number from 0 to 1.
    """

    def __init__(
        self,
        problem: Problem,
        seed: int,
        *,
        depth: Depth | None = None,
        daring: float = 0.6,
        price: float | None = None,
        collected: float = 0.0,
        warm: Sequence[int] = (),
        ground: Ground | None = None,
    ) -> None:
        from fieldhand.orienteering.adaptive import Depth
        from fieldhand.orienteering.ground import ground_of

        if not 0.0 <= daring <= 1.0:
            raise ProblemError(f"a policy's daring is {daring:g}", advice="give a number from 0 to 1")
        self._problem, self._ground = problem, ground or ground_of(problem)
        self._depth, self._daring = depth or Depth(), daring
        self._state = np.array([seed], dtype=np.uint64)
        self._free = problem.rewards > 0.0
        self._free[[problem.start, problem.end]] = False
        self._price, self._least_price = price, 0.0
        self._collected, self._warm, self._first, self._begun = collected, tuple(warm), tuple(warm), False
        self._last: tuple[Lookout, Order, float] | None = None
        self._outlook = Outlook(vertices=(), reward=0.0, success=1.0)

    @property
    def outlook(self) -> Outlook:
        """What was expected at the last decision."""
        return self._outlook

    @property
    def price(self) -> float | None:
        """What keeping to the limits counts beside the reward; None until a decision needed it."""
        return self._price

    @property
    def ground(self) -> Ground:
        """The problem as arrays."""
        return self._ground

    @property
    def plan(self) -> tuple[Lookout, Order, float] | None:
        """What the last decision was made by: from where, which order, what keeping to the limits counts.

        None where there is nothing to decide, and where the order is long and driven as planned.
        """
        return self._last

    def lengths(self, vertex: int) -> NDArray[np.float64]:
        """Of the legs from a vertex to every vertex, shape (n,)."""
        return self._ground.row(vertex)

    @property
    def least_price(self) -> float:
        """The least that daring allows."""
        return self._least_price

    def again(
        self, seed: int, price: float | None = None, warm: Sequence[int] = (), depth: Depth | None = None
    ) -> Policy:
        """The policy for another mission through the same problem, at a price of a failure."""
        return Policy(
            self._problem, seed, depth=depth or self._depth, daring=self._daring, price=price, warm=warm or self._first,
            ground=self._ground,
        )  # fmt: skip

    def next(self, state: State, seconds: float | None = None) -> int:
        """The vertex to go to next; the problem's end when nothing more is worth it.

        Args:
            state: Where the mission stands.
            seconds: How long to think; None for the counted depth, which alone gives the same answer on any machine.

        Raises:
            ProblemError: The state is none of this problem: a vertex that does not exist, an amount that is missing or
                not a number.
        """
        from fieldhand.orienteering.adaptive import LONG, Lookout, Order
        from fieldhand.orienteering.annealing import stops_of

        began = time.perf_counter()
        self._check(state)
        self._last = None
        free = self._free.copy()
        free[[*state.visited, *state.given_up]] = False
        most = self._problem.most
        if most is not None:
            most = max(0, most - visits(self._problem, state.visited))
            free &= most > 0
        lookout = Lookout(self._ground, state.vertex, state.left, free, self._depth, self._state, most)
        if min(state.left) <= 0.0:
            return self._settle(state, None)
        if not len(lookout.free):
            return self._settle(state, lookout.order(lookout.free, 0.0, 0))
        certain = self._ground.cumulants[0] <= 0.0
        accepted = min(limit.failure_probability for limit in self._problem.limits)
        safe: tuple[int, ...] = ()
        if certain or len(lookout.free) > LONG:
            # As likely to fail as is accepted, not as likely as not: a long last leg takes its risk all at once, when
            # no stop is left that could be skipped.
            route = lookout.route(accepted, self._warm, self._rounds(lookout))
            while seconds is not None and time.perf_counter() - began < seconds:
                route = lookout.route(accepted, route.tolist(), 16 * self._depth.rounds)
            # Of legs that are certain nothing is to be learnt on the way: the best route is the best policy.
            if certain or len(route) > LONG:
                ahead = Order(stops=route, first=0, worth=self._reward(route.tolist()), success=1.0)
                return self._settle(state, ahead)
            safe = tuple(route.tolist())
            if self._price is None:
                self._warm = safe
        collected = self._collected + self._reward(
            [*(state.visited - {self._problem.start, self._problem.end}), self._problem.end]
        )
        new = False
        if self._price is None:
            new, self._price = True, self._priced(lookout, collected, safe)
        elif not (self._begun or self._warm):
            self._plan(lookout.planned(self._price + collected, (), self._rounds(lookout)))
        self._begun = True
        bonus = self._price + collected
        order = lookout.best(bonus, self._warm)
        if new and order.first == len(order.stops):
            setting_out = self._safe_route(lookout, accepted, safe)
            if setting_out is not None:
                # The price is found anew after that leg, for what is left of this route.
                self._price, self._begun = None, False
                return self._settle(state, setting_out)
        elif safe:
            other = lookout.order(stops_of(safe, lookout.free), bonus, self._depth.insertions)
            order = max(order, other, key=lambda one: one.value(bonus))
        while seconds is not None and time.perf_counter() - began < seconds:
            order = lookout.bettered(order, bonus)
        self._last = (lookout, order, bonus)
        return self._settle(state, order)

    def chances(self) -> dict[int, float]:
        """How likely each vertex of the outlook's order is visited by a mission that only skips some of them.

        Those that a policy plans anew for are not in it; where the order is long and driven as planned, all are 1.
        """
        ahead = self._outlook.vertices[1:-1]
        if self._last is None or not ahead:
            return dict.fromkeys(ahead, 1.0)
        lookout, order, bonus = self._last
        found = lookout.chances(order.stops, bonus)[order.first :]
        return {vertex: min(1.0, float(chance)) for vertex, chance in zip(ahead, found, strict=True)}

    def foresight(self) -> Foresight | None:
        """What was foreseen of the leg to the vertex given last; None where no programme chose it."""
        if self._last is None:
            return None
        lookout, order, bonus = self._last
        return lookout.foresight(order, bonus)

    def _check(self, state: State) -> None:
        size, limits = self._problem.size, len(self._problem.limits)
        for vertex in (state.vertex, *state.visited, *state.given_up):
            if not 0 <= vertex < size:
                raise ProblemError(f"the mission knows vertex {vertex}, which is none of 0 to {size - 1}")
        if len(state.left) != limits or not np.isfinite(state.left).all():
            raise ProblemError(
                f"of the limits is left: {', '.join(f'{x:g}' for x in state.left)}", advice=f"give {limits} numbers"
            )

    def _priced(self, lookout: Lookout, collected: float, safe: Sequence[int]) -> float:
        """The least price at which the best order fails no more often than the limit that binds accepts.

        Args:
            lookout, collected: Where the mission stands; reward that is safe already.
            safe: Stops of a fixed route planned at the accepted chance, where there is one. It can be safer than any
                part of the order worth most at no price: many short legs are less uncertain than one long leg home.
        """
        from fieldhand.orienteering.annealing import stops_of

        accepted = 1.0 - _AIM * min(limit.failure_probability for limit in self._problem.limits)
        planned = lookout.planned(collected, self._warm, self._rounds(lookout))
        price, order = self._at_least_price(lookout, planned, collected, accepted)
        if safe and order.success < accepted and order.first < len(order.stops):
            begun = lookout.order(stops_of(safe, lookout.free), price + collected, 0)
            safer = self._at_least_price(lookout, begun, collected, accepted)
            # An order that shrank to nothing has a price that means nothing.
            if safer[1].success > order.success and safer[1].first < len(safer[1].stops):
                price, order = safer
        self._plan(order)
        return price

    def _at_least_price(self, lookout: Lookout, order: Order, collected: float, accepted: float) -> tuple[float, Order]:
        """The least price at which an order succeeds as often as is accepted, and what the order becomes at it."""
        price = 0.0
        for _ in range(_PRICINGS):
            expected = order.worth / max(order.success, 1e-9) + collected
            self._least_price = -self._daring * expected
            low, high = self._least_price, 50.0 * max(expected, 1e-9)
            for _ in range(_BISECTIONS):
                middle = 0.5 * (low + high)
                if lookout.order(order.stops, middle + collected, 0).success >= accepted:
                    high = middle
                else:
                    low = middle
            price = high
            order = lookout.order(order.stops, price + collected, self._depth.insertions)
            order = lookout.remade(order, price + collected)
        return price, order

    def _safe_route(self, lookout: Lookout, accepted: float, safe: Sequence[int]) -> Order | None:
        """Return the route to set out on where no price leads to a visit; None where no visit is safe enough.

        A long first leg and a long last one take most of the accepted chance before anything is collected. Then no
        price between staying and risking too much may be found; it is, once the first leg is driven.

        Args:
            lookout, accepted: Where the mission stands; the chance of failing.
            safe: Stops of a route that was found already, if any; it is searched for where they are not safe enough.
        """
        from fieldhand.orienteering.adaptive import Order

        route = np.array(safe, dtype=np.int64)
        if not (len(route) and lookout.is_safe(route)):
            route = lookout.route(accepted, (), 100 * self._depth.rounds)
        if not len(route) or not lookout.is_safe(route):
            return None
        return Order(stops=route, first=0, worth=self._reward(route.tolist()), success=1.0)

    def _plan(self, order: Order) -> None:
        """Keep the order that the mission begins with."""
        self._warm = self._first = tuple(order.stops.tolist())

    def _settle(self, state: State, order: Order | None) -> int:
        """Remember what is planned, and give its first vertex."""
        end = self._problem.end
        if order is None:
            self._warm, self._outlook = (), Outlook(vertices=(state.vertex, end), reward=0.0, success=0.0)
            return end
        self._warm = tuple(int(v) for v in order.stops[order.first + 1 :])
        ahead = tuple(int(v) for v in order.stops[order.first :])
        self._outlook = Outlook(vertices=(state.vertex, *ahead, end), reward=order.worth, success=order.success)
        return ahead[0] if ahead else end

    def _rounds(self, lookout: Lookout) -> int:
        """More for the first plan of a mission: all others begin with what is left of the one before."""
        return self._depth.rounds if self._warm or self._begun else 100 * self._depth.rounds + 20 * len(lookout.free)

    def _reward(self, vertices: Sequence[int]) -> float:
        return float(self._problem.rewards[list(vertices)].sum())


def compile_ahead() -> None:
    """Compile the inner loops now and keep them on disk, so that no later process waits for it (some ten seconds).

    Covers fixed routes, policies and their chances, over distances of any kind, for the loops take all,
    and orders of many visits.
    """
    from fieldhand.orienteering.network import Network
    from fieldhand.orienteering.order import COMPILED_FROM, shortest_order

    ways = np.array([[i, i + 1] for i in range(11)], dtype=np.int64)
    chain = Network(nodes=12, ways=ways, lengths=np.full(11, 0.1))
    problem, _ = chain.problem(np.ones(12), 0, 11, (Limit(budget=2.0),), precision="single")
    problem = replace(problem, after=(0.1,))
    solve(problem, 0, Stop(rounds=1))
    policy = Policy(problem, 0)
    for seconds in (None, 0.05):
        policy.next(State(vertex=0, left=(2.0,)), seconds)
    policy.chances()
    places = np.arange(COMPILED_FROM, dtype=np.float64)
    shortest_order(np.abs(places[:, None] - places), 0, None)
