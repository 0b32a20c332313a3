"""An upper bound on the mean reward: that of a robot which knows every leg's cost in advance.

No policy collects more on average. Each sampled world is a deterministic orienteering problem. It is solved by the
same search as fixed routes, so the result is a bound only as far as that search finds the best route.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fieldhand.errors import ProblemError
from fieldhand.orienteering.costs import Deterministic
from fieldhand.orienteering.problem import Problem
from fieldhand.orienteering.route import StoppingCriterion, solve


def with_perfect_information(problem: Problem, seed: int, rounds: int = 2000) -> tuple[float, bool]:
    """Return the reward in one sampled world, the end's included, and True if the end is within the budget."""
    factors = problem.model.draw(np.random.default_rng(seed), problem.size**2).reshape(problem.size, problem.size)
    factors = np.triu(factors) + np.triu(factors, 1).T
    try:
        world = replace(problem, distances=problem.distances * factors, costs=Deterministic())
        route = solve(world, seed, StoppingCriterion(rounds=rounds))
    except ProblemError:
        return 0.0, False
    return route.reward + float(problem.rewards[problem.end]), True
