"""Orienteering problems: vertices with rewards, random leg costs, and limits with failure probabilities."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import ProblemError
from fieldhand.orienteering.costs import CostModel, Deterministic, ShiftedExponential
from fieldhand.orienteering.table import Table

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Limit:
    """A resource limit in units of leg cost, to be exceeded only with a small probability.

    Resources other than distance (seconds, percent of a battery) are converted to these units by dividing by the amount
    that one unit of leg cost uses; so all resources depend on the same random leg costs.

    Attributes:
        budget: Amount that may be used.
        failure_probability: Accepted probability of exceeding the budget (Pf), above 0 and below 1.
        service: Amount used by the work at each vertex, shape (n,); that of the start does not count. None if visits
            use nothing.
    """

    budget: float
    failure_probability: float = 0.1
    service: Floats | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class Problem:
    """A stochastic orienteering problem: collect reward on the way from ``start`` to ``end`` within resource limits.

    No limit may be exceeded with more than its failure probability. A leg of length ``d`` costs ``d`` times a random
    factor with mean 1, known only once it has been driven. By default the cost is ``d * (alpha + X)``, with X
    exponential of mean ``1 - alpha``.

    Attributes:
        distances: Lengths of the legs, symmetric, shape (n, n), in any unit; ``inf`` where there is no leg. Empty if
            given by ``coordinates`` or ``table`` instead.
        rewards: Reward of each vertex, shape (n,); those of start and end do not count.
        limits: Resource limits, at least one.
        alpha: Deterministic fraction of a leg's cost, 0 to 1; 1 is a deterministic problem.
        costs: Cost model that replaces the default one; ``alpha`` is then ignored.
        coordinates: Coordinates of the vertices, shape (n, 2), instead of ``distances``: legs are straight lines, so
            thousands of vertices need no distance matrix.
        table: Distances of a sparse network (:meth:`fieldhand.orienteering.network.Network.problem`).
        max_visits: Largest number of vertices with a reward that may be visited, start and end not counted; None for
            as many as fit.
        legs_after: Lengths of legs that are driven after the end on every route; they count for every limit.
        under_way: True for the remainder of a mission that has begun. The numbers are then not checked: they were
            before, and the remaining budget may be too small for the way home.

    Raises:
        ProblemError: Numbers that are negative, NaN or of the wrong shape; a vertex that does not exist; an end that
            cannot be reached; a budget below the direct way from start to end.
    """

    rewards: Floats
    start: int
    end: int
    limits: tuple[Limit, ...]
    distances: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    alpha: float = 0.5
    legs_after: tuple[float, ...] = field(default=())
    costs: CostModel | None = None
    coordinates: Floats | None = None
    table: Table | None = None
    max_visits: int | None = None
    under_way: bool = False

    def __post_init__(self) -> None:
        if self.under_way:
            return
        _check_graph(self)
        for limit in self.limits:
            _check_limit(limit, self.size)
        _check_direct(self)

    @property
    def size(self) -> int:
        """Return the number of vertices."""
        return len(self.rewards)

    @property
    def model(self) -> CostModel:
        """Return the cost model."""
        if self.costs is not None:
            return self.costs
        return Deterministic() if self.alpha >= 1.0 else ShiftedExponential(self.alpha)

    def length(self, u: int, v: int) -> float:
        """Return the length of the leg between two vertices."""
        if self.table is not None:
            return float(self.table.distances[u, v])
        if self.coordinates is not None:
            return float(np.hypot(*(self.coordinates[u] - self.coordinates[v])))
        return float(self.distances[u, v])


def count_visits(problem: Problem, vertices: Iterable[int]) -> int:
    """Return how many of the given vertices count towards :attr:`Problem.max_visits`."""
    return sum(problem.rewards[v] > 0.0 for v in set(vertices) - {problem.start, problem.end})


def remaining_problem(
    problem: Problem, vertex: int, left: tuple[float, ...], collected: tuple[int, ...] = ()
) -> Problem:
    """Return the problem that remains at ``vertex``; collected vertices have no reward."""
    rewards = problem.rewards.copy()
    max_visits = None if problem.max_visits is None else max(0, problem.max_visits - count_visits(problem, collected))
    rewards[list(collected)] = 0.0
    limits = tuple(replace(limit, budget=budget) for limit, budget in zip(problem.limits, left, strict=True))
    return replace(problem, rewards=rewards, start=vertex, limits=limits, max_visits=max_visits, under_way=True)


def _check_graph(problem: Problem) -> None:
    d, rewards = problem.distances, problem.rewards
    n = len(rewards)
    if n < 2:
        raise ProblemError(f"{n} vertices are not a problem", advice="give a start and an end at least")
    if (len(d) > 0) + (problem.coordinates is not None) + (problem.table is not None) > 1:
        raise ProblemError("lengths are given in more than one way", advice="give distances, coordinates or a table")
    if problem.coordinates is not None:
        _check_plane(problem.coordinates, n)
    elif problem.table is not None:
        if problem.table.size != n:
            raise ProblemError(f"a table of {problem.table.size} vertices does not fit {n} rewards")
    elif d.shape != (n, n):
        raise ProblemError(f"distances of shape {d.shape} do not fit {n} rewards", advice=f"give {n} by {n} distances")
    if np.isnan(d).any() or (d < 0).any():
        row, column = np.argwhere(np.isnan(d) | (d < 0))[0]
        raise ProblemError(f"a distance is {d[row, column]:g}", where=f"vertices {row} and {column}")
    if not np.allclose(d, d.T, rtol=1e-6, atol=1e-9):
        row, column = np.argwhere(~np.isclose(d, d.T, rtol=1e-6, atol=1e-9))[0]
        there, back = d[row, column], d[column, row]
        raise ProblemError(
            f"the way there is {there:g} and the way back {back:g}",
            where=f"vertices {row} and {column}",
            advice="distances must be symmetric",
        )
    if not np.isfinite(rewards).all() or (rewards < 0).any():
        vertex = int(np.argwhere(~np.isfinite(rewards) | (rewards < 0))[0, 0])
        raise ProblemError(f"its reward is {rewards[vertex]:g}", where=f"vertex {vertex}", advice="give 0 or more")
    for name, vertex in (("start", problem.start), ("end", problem.end)):
        if not 0 <= vertex < n:
            raise ProblemError(f"the {name} is vertex {vertex}, which is not in 0 to {n - 1}")
    if not 0.0 <= problem.alpha <= 1.0:
        raise ProblemError(f"alpha is {problem.alpha:g}", advice="give a number from 0 to 1")
    max_visits = problem.max_visits
    if max_visits is not None and not (max_visits >= 0 and max_visits % 1 == 0):
        raise ProblemError(f"at most {max_visits} visits are allowed", advice="give a whole number, 0 or more")
    if not problem.limits:
        raise ProblemError("there is no limit", advice="give a budget")
    if not all(np.isfinite(leg) and leg >= 0 for leg in problem.legs_after):
        raise ProblemError("a leg after the end is negative or not a number")


def _check_plane(coordinates: Floats, n: int) -> None:
    if coordinates.shape != (n, 2):
        raise ProblemError(f"coordinates of shape {coordinates.shape} do not fit {n} rewards", advice=f"give {n} pairs")
    if not np.isfinite(coordinates).all():
        vertex = int(np.argwhere(~np.isfinite(coordinates))[0, 0])
        raise ProblemError("a coordinate is not a number", where=f"vertex {vertex}")


def _check_limit(limit: Limit, n: int) -> None:
    if not np.isfinite(limit.budget) or limit.budget < 0:
        raise ProblemError(f"a budget is {limit.budget:g}", advice="give 0 or more")
    if not 0.0 < limit.failure_probability < 1.0:
        raise ProblemError(
            f"a failure probability is {limit.failure_probability:g}", advice="give a number above 0 and below 1"
        )
    if limit.service is None:
        return
    if limit.service.shape != (n,):
        raise ProblemError(f"service of shape {limit.service.shape} does not fit {n} vertices")
    if not np.isfinite(limit.service).all() or (limit.service < 0).any():
        vertex = int(np.argwhere(~np.isfinite(limit.service) | (limit.service < 0))[0, 0])
        raise ProblemError(f"its service cost is {limit.service[vertex]:g}", where=f"vertex {vertex}")


def _check_direct(problem: Problem) -> None:
    direct = problem.length(problem.start, problem.end)
    if problem.start != problem.end and not np.isfinite(direct):
        raise ProblemError("there is no way from the start to the end", where=f"vertex {problem.end}")
    way = (0.0 if problem.start == problem.end else direct) + sum(problem.legs_after)
    for limit in problem.limits:
        need = way + (0.0 if limit.service is None or problem.start == problem.end else limit.service[problem.end])
        if need > limit.budget * (1 + 1e-9):
            raise ProblemError(
                f"the direct way to the end takes {need:g} and the budget is {limit.budget:g}",
                advice="raise the budget",
            )
