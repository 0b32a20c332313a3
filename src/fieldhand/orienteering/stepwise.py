"""Plan anew after every leg a route within a chance that is split over what the leg may cost (:mod:`.split`).

The guard decides by this one. :mod:`fieldhand.orienteering.policy` collects more: it prices a failure instead.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fieldhand.orienteering.order import Floats, Ints
from fieldhand.orienteering.problem import Problem, under_way, visits
from fieldhand.orienteering.route import Route
from fieldhand.orienteering.search import Search
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
    most = None if problem.most is None else max(0, problem.most - visits(problem, collected))
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
        costs=problem.costs,
        plane=problem.plane,
        labels=problem.labels,
        most=most,
    )


def _usable(problem: Problem, warm: tuple[int, ...]) -> Ints | None:
    """A remembered route as far as it still makes sense: from here to the end, over what is still to be collected."""
    if len(warm) < 2 or warm[0] != problem.start or warm[-1] != problem.end:
        return None
    stops = [v for v in warm[1:-1] if problem.rewards[v] > 0.0]
    return np.array([problem.start, *stops, problem.end], dtype=np.intp)


def _least(search: Search, ways: list[Ints]) -> Floats:
    """For each limit the least chance of exceeding it that one of these ways has."""
    return np.asarray(np.min([search.chances(search.figures(way)) for way in ways], axis=0))
