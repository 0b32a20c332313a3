"""What a robot would collect that knew beforehand what every leg costs.

No policy can collect more on average. Each drawn world is a certain orienteering problem of its own; it is solved by
the same search as fixed routes, so the figure is a bound as far as that search finds the best route.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fieldhand.errors import ProblemError
from fieldhand.orienteering.costs import Deterministic
from fieldhand.orienteering.problem import Problem
from fieldhand.orienteering.route import StoppingCriterion, solve


def with_perfect_information(problem: Problem, seed: int, rounds: int = 2000) -> tuple[float, bool]:
    """Reward in one drawn world, the end's included, and whether its end can be reached within the budget."""
    factors = problem.model.draw(np.random.default_rng(seed), problem.size**2).reshape(problem.size, problem.size)
    factors = np.triu(factors) + np.triu(factors, 1).T
    try:
        world = replace(problem, distances=problem.distances * factors, costs=Deterministic())
        route = solve(world, seed, StoppingCriterion(rounds=rounds))
    except ProblemError:
        return 0.0, False
    return route.reward + float(problem.rewards[problem.end]), True
