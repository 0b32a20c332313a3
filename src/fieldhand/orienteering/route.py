"""The best fixed route within the failure probability of each limit."""

from __future__ import annotations

import itertools
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldhand.errors import ProblemError
from fieldhand.orienteering.overrun import overrun_probability
from fieldhand.orienteering.problem import Problem

if TYPE_CHECKING:
    from fieldhand.orienteering.annealing import Annealing

_BATCH_S = 0.05


@dataclass(frozen=True, kw_only=True)
class Route:
    """A way from start to end.

    Attributes:
        vertices: In their order, start and end included.
        reward: Total reward of the vertices between them.
        length: Expected cost of the legs, those after the end included.
        chances: For each limit the chance of exceeding it.
    """

    vertices: tuple[int, ...]
    reward: float
    length: float
    chances: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class StoppingCriterion:
    """A stopping criterion of a search: a number of rounds or a time, whichever comes first.

    Attributes:
        rounds: Rounds of the search; counted alone, the same seed gives the same route on any machine.
        seconds: Time; None for as long as the rounds take.
    """

    rounds: int = 20_000
    seconds: float | None = None

    def __post_init__(self) -> None:
        if self.rounds < 1 or (self.seconds is not None and not self.seconds > 0.0):
            raise ProblemError("a search needs at least one round and some time")


def solve(problem: Problem, seed: int, stop: StoppingCriterion | None = None) -> Route:
    """Search for the best fixed route.

    Args:
        problem: The problem.
        seed: The same seed and the same rounds give the same route.
        stop: When to end the search; without it, after :class:`StoppingCriterion`'s rounds.

    Returns:
        A route whose chances are within the limits' failure probabilities.

    Raises:
        ProblemError: No route was found that is safe enough, not even one that only goes to the end.
    """
    from fieldhand.orienteering.annealing import Annealing
    from fieldhand.orienteering.prepared_problem import prepare_problem

    prepared = prepare_problem(problem)
    free = problem.rewards > 0.0
    free[[problem.start, problem.end]] = False
    free &= np.isfinite(prepared.row(problem.start)) & np.isfinite(prepared.row(problem.end))
    budgets = np.array([limit.budget for limit in problem.limits])
    state = np.array([seed], dtype=np.uint64)
    nothing = np.zeros(0, dtype=np.int64)
    vertices = np.flatnonzero(free).astype(np.int64)
    search = Annealing(prepared, problem.start, vertices, budgets, prepared.tables, nothing, state, problem.max_visits)
    _anneal(search, stop or StoppingCriterion())
    route = route_over(problem, search.best.tolist())
    if search.reward < 0.0:
        raise ProblemError(
            f"even the safest way to the end exceeds a budget with a chance of {max(route.chances):.0%}",
            advice="raise the budget or accept a higher failure probability",
        )
    return route


def route_over(problem: Problem, stops: Sequence[int]) -> Route:
    """Return the route over ``stops`` with its reward, length and overrun probabilities."""
    vertices = (problem.start, *(int(v) for v in stops), problem.end)
    legs = np.array([*(problem.length(a, b) for a, b in itertools.pairwise(vertices)), *problem.legs_after])
    second, third = problem.model.cumulants()
    sums = (legs.sum(), second * (legs**2).sum(), third * (legs**3).sum())
    worked = list(vertices[1:] if problem.start != problem.end else vertices[1:-1])
    left = [x.budget - (0.0 if x.service is None else float(x.service[worked].sum())) for x in problem.limits]
    return Route(
        vertices=vertices,
        reward=float(problem.rewards[list(vertices[1:-1])].sum()),
        length=float(legs.sum()),
        chances=tuple(float(c) for c in overrun_probability(*sums, left)),
    )


def _anneal(search: Annealing, stop: StoppingCriterion) -> None:
    if stop.seconds is None:
        search.improve(stop.rounds)
        return
    began = time.perf_counter()
    done, part, batch = 0, 0.0, 50
    while done < stop.rounds and part < 1.0:
        count = min(batch, stop.rounds - done)
        search.improve(count, done=part, then=part)
        done += count
        spent = time.perf_counter() - began
        part = max(spent / stop.seconds, done / stop.rounds)
        batch = max(10, min(2 * batch, int(done / spent * _BATCH_S)))
