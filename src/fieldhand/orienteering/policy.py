"""Which vertex comes next: plan anew after every leg, within one chance for the whole mission (:mod:`.split`)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fieldhand.errors import ProblemError
from fieldhand.orienteering.order import Floats, Ints
from fieldhand.orienteering.problem import Problem, under_way
from fieldhand.orienteering.search import Route, Search
from fieldhand.orienteering.split import Split, split


@dataclass(frozen=True, kw_only=True)
class Effort:
    """How long to search, counted so that the same problem gives the same route on any machine."""

    restarts: int = 4
    rounds: int = 40


SOLVE = Effort()
RESOLVE = Effort(restarts=1, rounds=6)


@dataclass(frozen=True, kw_only=True)
class Decision:
    """Where to go next.

    Attributes:
        vertex: The next one; the end where nothing more fits.
        route: The whole way that is planned from here.
        split: What the decision after this one is allowed; None where the mission is over by then.
    """

    vertex: int
    route: Route
    split: Split | None


@dataclass(frozen=True, kw_only=True)
class State:
    """Where a mission stands.

    Attributes:
        vertex: Where the robot is.
        left: What is left of each limit, in their order; may be negative.
        visited: Vertices that have been collected.
    """

    vertex: int
    left: tuple[float, ...]
    visited: frozenset[int] = frozenset()


def solve(problem: Problem, seed: int, effort: Effort = SOLVE) -> Route:
    """The best fixed route found.

    Args:
        problem: What to solve.
        seed: The same seed gives the same route.
        effort: How long to search.

    Returns:
        A route whose chances are within the limits' failure probabilities.

    Raises:
        ProblemError: No route was found that is safe enough, not even one that only goes to the end.
    """
    levels = np.array([limit.failure_probability for limit in problem.limits])
    search = Search(problem, levels)
    route = search.best(np.random.default_rng(seed), None, effort.restarts, effort.rounds)
    if not search.feasible(route):
        chance = max(search.describe(route).chances)
        raise ProblemError(
            f"even the safest way to the end exceeds a budget with a chance of {chance:.0%}",
            advice="raise the budget or accept a higher failure probability",
        )
    return search.describe(route)


def decide(
    problem: Problem,
    levels: tuple[float, ...],
    rng: np.random.Generator,
    warm: tuple[int, ...] = (),
    effort: Effort = RESOLVE,
) -> Decision:
    """The next vertex of a mission that stands at ``problem.start``.

    Args:
        problem: What is left: rewards not yet collected, budgets not yet used.
        levels: For each limit the chance that this decision may take (at first its failure probability).
        rng: For the search.
        warm: Rest of the route that was planned before, start and end included.
        effort: How long to search.
    """
    asked = np.array(levels)
    cautious = Search(problem, asked)
    old = _usable(problem, warm)
    least = _least(cautious, [cautious.safest(), cautious.direct, *([] if old is None else [old])])
    allowed = np.maximum(asked, least)
    search = cautious if (allowed <= asked).all() else Search(problem, allowed)
    route = search.best(rng, old, effort.restarts, effort.rounds)
    if not search.feasible(route):
        route = search.safest()
    found = search.describe(route)
    return Decision(vertex=found.vertices[1], route=found, split=_split(problem, route, allowed))


def _split(problem: Problem, route: Ints, levels: Floats) -> Split | None:
    """What is allowed after the first leg of ``route``; None where that leg leads to the end."""
    if len(route) < 3:
        return None
    there = int(route[1])
    left = [x.budget - (0.0 if x.service is None else float(x.service[there])) for x in problem.limits]
    search = Search(left_of(problem, there, tuple(left), (there,)), levels)
    options = [search.option(way) for way in (search.direct, *search.ladder(route[1:]), search.safest())]
    return split(levels, float(problem.distances[route[0], there]), problem.alpha, left, options)


def left_of(problem: Problem, vertex: int, left: tuple[float, ...], collected: tuple[int, ...] = ()) -> Problem:
    """The problem that is left at ``vertex`` with these budgets; what was collected is worth nothing any more."""
    rewards = problem.rewards.copy()
    rewards[list(collected)] = 0.0
    limits = tuple(replace(limit, budget=budget) for limit, budget in zip(problem.limits, left, strict=True))
    return under_way(
        distances=problem.distances,
        rewards=rewards,
        start=vertex,
        end=problem.end,
        limits=limits,
        alpha=problem.alpha,
        after=problem.after,
    )


class Policy:
    """Drives one mission through a problem: asked before each leg, it plans anew from where the robot is.

    Args:
        problem: As it stands before the mission.
        seed: The same seed and the same leg costs give the same mission.
        effort: How long to search at each decision after the first.
    """

    def __init__(self, problem: Problem, seed: int, effort: Effort = RESOLVE) -> None:
        self._problem = problem
        self._effort = effort
        self._rng = np.random.default_rng(seed)
        self._split: Split | None = None
        self._route: tuple[int, ...] = ()

    @property
    def route(self) -> tuple[int, ...]:
        """The way that was planned at the last decision."""
        return self._route

    def next(self, state: State) -> int:
        """The vertex to go to next; the problem's end when nothing more fits."""
        rest = left_of(
            self._problem, state.vertex, state.left, tuple({*state.visited, state.vertex, self._problem.start})
        )
        if state.vertex == self._problem.end and self._route:
            return self._problem.end
        warm = self._route[1:] if len(self._route) > 1 and self._route[1] == state.vertex else ()
        effort = self._effort if self._route else SOLVE
        decision = decide(rest, self._levels(state), self._rng, warm, effort)
        self._split = decision.split
        self._route = decision.route.vertices
        return decision.vertex

    def _levels(self, state: State) -> tuple[float, ...]:
        if self._split is None:
            return tuple(limit.failure_probability for limit in self._problem.limits)
        return tuple(float(x) for x in self._split.levels(state.left))


def _usable(problem: Problem, warm: tuple[int, ...]) -> Ints | None:
    """A remembered route as far as it still makes sense: from here to the end, over what is still to be collected."""
    if len(warm) < 2 or warm[0] != problem.start or warm[-1] != problem.end:
        return None
    stops = [v for v in warm[1:-1] if problem.rewards[v] > 0.0]
    return np.array([problem.start, *stops, problem.end], dtype=np.intp)


def _least(search: Search, ways: list[Ints]) -> Floats:
    """For each limit the least chance of exceeding it that one of these ways has."""
    return np.asarray(np.min([search.chances(search.figures(way)) for way in ways], axis=0))
