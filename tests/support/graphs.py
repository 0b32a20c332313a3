"""Random graphs for the orienteering tests, and missions driven on them by drawing what each leg costs."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.policy import Policy, State
from fieldhand.orienteering.problem import Limit, Problem


def euclidean(n: int, seed: int, size: float = 1.0) -> NDArray[np.float64]:
    """Distances between ``n`` random points of a square."""
    xy = np.random.default_rng(seed).random((n, 2)) * size
    return np.asarray(np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1)))


def problem(n: int, seed: int, *, budget: float = 2.0, pf: float = 0.1, alpha: float = 0.5) -> Problem:
    """Random points in the unit square with random rewards; start 0, end n - 1."""
    rewards = np.random.default_rng([seed, 1]).random(n)
    limits = (Limit(budget=budget, failure_probability=pf),)
    return Problem(distances=euclidean(n, seed), rewards=rewards, start=0, end=n - 1, limits=limits, alpha=alpha)


@cache
def begun(given: Problem) -> Policy:
    """A policy that has planned and priced a problem: others begin with what it found."""
    policy = Policy(given, 0)
    policy.next(State(vertex=given.start, left=tuple(limit.budget for limit in given.limits)))
    return policy


def mission(given: Problem, seed: int) -> tuple[tuple[int, ...], float]:
    """One mission under the policy: the vertices driven to, and what was left of the first limit at the end."""
    rng, policy = np.random.default_rng([seed, 2]), begun(given).again(seed, begun(given).price)
    path, left = [given.start], given.limits[0].budget
    while path[-1] != given.end or len(path) == 1:
        vertex = policy.next(State(vertex=path[-1], left=(left,), visited=frozenset(path[1:])))
        left -= given.distances[path[-1], vertex] * (given.alpha + rng.exponential(1.0 - given.alpha))
        path.append(vertex)
    return tuple(path), left
