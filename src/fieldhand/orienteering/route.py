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
    """A fixed route from start to end.

    Attributes:
        vertices: Vertices in visiting order, including start and end.
        reward: Total reward of the vertices between start and end.
        length: Expected cost of the legs in the unit of the problem's distances, including :attr:`Problem.legs_after`;
            service is not included.
        chances: For each limit the probability that legs and service exceed its budget, 0 to 1.
    """

    vertices: tuple[int, ...]
    reward: float
    length: float
    chances: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class StoppingCriterion:
    """A stopping criterion of a search: a number of rounds or a time, whichever comes first.

    Attributes:
        rounds: Maximum number of rounds. If only rounds are limited, the same seed gives the same route on any machine.
        seconds: Maximum time in seconds; None for no time limit.
    """

    rounds: int = 20_000
    seconds: float | None = None

    def __post_init__(self) -> None:
        if self.rounds < 1 or (self.seconds is not None and not self.seconds > 0.0):
            raise ProblemError("a search needs at least one round and some time")


def solve(problem: Problem, seed: int, stop: StoppingCriterion | None = None) -> Route:
    """Search for the fixed route of highest reward within the failure probability of every limit.

    Simulated annealing with slack induction by string removals (Christiaens and Vanden Berghe 2020). Overrun
    probabilities are computed by a Pearson III approximation (:mod:`fieldhand.orienteering.overrun`).

    Args:
        problem: Vertices, rewards, leg costs and limits.
        seed: Seed of the search; the same seed and number of rounds give the same route.
        stop: When to end the search; by default after the rounds of :class:`StoppingCriterion`.

    Returns:
        A route whose overrun probabilities are within the limits' failure probabilities.

    Raises:
        ProblemError: No route is safe enough, not even the direct one from start to end.
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
