"""Greedy selection by reward per distance: the strategy that language models state for this problem."""

from __future__ import annotations

import numpy as np

from fieldhand.orienteering.overrun import overrun_probability
from fieldhand.orienteering.policy import State
from fieldhand.orienteering.problem import Problem, count_visits


class Greedy:
    """A policy that drives to the vertex with the most reward per distance from which the end can be reached safely."""

    def __init__(self, problem: Problem) -> None:
        self._problem = problem

    def next(self, state: State) -> int:
        """Return the vertex to drive to next."""
        problem, here, end = self._problem, state.vertex, self._problem.end
        there = np.array([problem.length(here, v) for v in range(problem.size)])
        home = np.array([problem.length(v, end) for v in range(problem.size)])
        after = np.array(problem.legs_after)
        second, third = problem.model.cumulants()
        free = problem.rewards > 0.0
        free[[*state.visited, here, problem.start, end]] = False
        for limit, left in zip(problem.limits, state.left, strict=True):
            work = np.zeros(problem.size) if limit.service is None else limit.service + limit.service[end]
            sums = [there**k + home**k + (after**k).sum() for k in (1, 2, 3)]
            chance = overrun_probability(sums[0], second * sums[1], third * sums[2], left - work)
            free &= chance <= limit.failure_probability
        full = problem.max_visits is not None and count_visits(problem, state.visited) >= problem.max_visits
        if full or not free.any():
            return end
        return int(np.where(free, problem.rewards / (there + 1e-12), -1.0).argmax())
