"""Without chance: the search for fixed routes against PyVRP's prize collecting, in the same time on the same graph."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from fieldhand.errors import ProblemError
from fieldhand.orienteering.costs import Deterministic
from fieldhand.orienteering.problem import Problem
from fieldhand.orienteering.route import StoppingCriterion, solve

#: PyVRP counts in whole numbers: a budget is so many units of length, all reward so many units of prize. One unit of
#: length is worth next to nothing beside the prizes.
_LENGTHS, _PRIZES = 1_000_000, 1_000_000_000


@dataclass(frozen=True, kw_only=True)
class Certain:
    """What a solver collected where every leg costs its length.

    Attributes:
        solver: Its name.
        reward: Of the stops, the end's not counted.
        length: Of the route.
        seconds: What it took.
    """

    solver: str
    reward: float
    length: float
    seconds: float


def compare(problem: Problem, seed: int, seconds: float) -> tuple[Certain, Certain]:
    """This library and PyVRP, each given the same time.

    Args:
        problem: With distances and one limit, and no service; its cost model is left out.
        seed: Of both.
        seconds: Time for each.

    Raises:
        ProblemError: PyVRP is not installed, or the problem is of another kind.
    """
    if (
        len(problem.limits) != 1
        or not len(problem.distances)
        or problem.limits[0].service is not None
        or problem.legs_after
    ):
        raise ProblemError("the comparison takes problems with distances, one limit and no service only")
    certain = replace(problem, costs=Deterministic())
    began = time.perf_counter()
    route = solve(certain, seed, StoppingCriterion(rounds=10**9, seconds=seconds))
    ours = Certain(
        solver="fieldhand", reward=route.reward, length=route.length, seconds=time.perf_counter() - began
    )  # fmt: skip
    return ours, _pyvrp(certain, seed, seconds)


def _pyvrp(problem: Problem, seed: int, seconds: float) -> Certain:
    try:
        from pyvrp import Model
        from pyvrp.stop import MaxRuntime
    except ImportError as error:
        raise ProblemError("PyVRP is not installed", advice="install it with: pip install pyvrp") from error
    budget = problem.limits[0].budget
    # Rounded up: no route is taken for one that fits because of the rounding.
    lengths = np.ceil(problem.distances / budget * _LENGTHS).astype(np.int64)
    prizes = np.round(problem.rewards / max(problem.rewards.sum(), 1e-300) * _PRIZES).astype(np.int64)
    model = Model()
    inner = [v for v in range(problem.size) if v not in (problem.start, problem.end)]
    # Every leg is given, so the coordinates say nothing.
    places = [model.add_location(x=v, y=0) for v in range(problem.size)]
    depots = {v: model.add_depot(places[v]) for v in dict.fromkeys((problem.start, problem.end))}
    for v in inner:
        model.add_client(places[v], prize=int(prizes[v]), required=False)
    model.add_vehicle_type(start_depot=depots[problem.start], end_depot=depots[problem.end], max_distance=_LENGTHS)
    for a in range(problem.size):
        for b in range(problem.size):
            model.add_edge(places[a], places[b], distance=0 if a == b else int(lengths[a, b]))
    began = time.perf_counter()
    result = model.solve(stop=MaxRuntime(seconds), seed=seed, display=False)
    took = time.perf_counter() - began
    routes = result.best.routes() if result.is_feasible() else []
    stops = [inner[activity.idx] for route in routes for activity in route if activity.is_client()]
    way = [problem.start, *stops, problem.end]
    return Certain(
        solver="PyVRP",
        reward=float(problem.rewards[stops].sum()),
        length=float(sum(problem.distances[a, b] for a, b in pairwise(way))),
        seconds=took,
    )
