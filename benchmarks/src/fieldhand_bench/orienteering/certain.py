"""Compare the search for fixed routes with PyVRP on deterministic costs, with the same graph and time."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from fieldhand.errors import ProblemError
from fieldhand.orienteering.costs import Deterministic
from fieldhand.orienteering.problem import Problem
from fieldhand.orienteering.route import StoppingCriterion, solve

#: PyVRP uses integers: units of length in the budget, and units of prize in the total reward. Its objective also counts
#: length, which this scale makes negligible beside the prizes.
_LENGTHS, _PRIZES = 1_000_000, 1_000_000_000


@dataclass(frozen=True, kw_only=True)
class RouteResult:
    """A solver's route where every leg costs its length.

    Attributes:
        solver: Name of the solver.
        reward: Total reward of the stops, without the end's.
        length: Length of the route, in the unit of the graph.
        seconds: Time taken, seconds.
    """

    solver: str
    reward: float
    length: float
    seconds: float


def compare(problem: Problem, seed: int, seconds: float) -> tuple[RouteResult, RouteResult]:
    """Solve a problem with this library and with PyVRP, in the same time each.

    Args:
        problem: Problem with distances, one limit and no service; its cost model is ignored.
        seed: Random seed of both solvers.
        seconds: Time limit of each solver, seconds.

    Raises:
        ProblemError: PyVRP is not installed, or the problem has another form.
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
    ours = RouteResult(
        solver="fieldhand", reward=route.reward, length=route.length, seconds=time.perf_counter() - began
    )  # fmt: skip
    return ours, _pyvrp(certain, seed, seconds)


def _pyvrp(problem: Problem, seed: int, seconds: float) -> RouteResult:
    try:
        from pyvrp import Model
        from pyvrp.stop import MaxRuntime
    except ImportError as error:
        raise ProblemError("PyVRP is not installed", advice="install it with: pip install pyvrp") from error
    budget = problem.limits[0].budget
    # Rounded up, so that no route keeps to the budget merely because of rounding.
    lengths = np.ceil(problem.distances / budget * _LENGTHS).astype(np.int64)
    prizes = np.round(problem.rewards / max(problem.rewards.sum(), 1e-300) * _PRIZES).astype(np.int64)
    model: Any = Model()  # its types differ between releases
    inner = [v for v in range(problem.size) if v not in (problem.start, problem.end)]
    ends = dict.fromkeys((problem.start, problem.end))
    # The distance of every leg is given, so the coordinates are not used.
    if hasattr(model, "add_location"):
        places = [model.add_location(x=v, y=0) for v in range(problem.size)]
        depots = {v: model.add_depot(places[v]) for v in ends}
        for v in inner:
            model.add_client(places[v], prize=int(prizes[v]), required=False)
    else:  # before PyVRP 0.14 (Python 3.10 has 0.11) depots and clients are locations themselves
        depots = {v: model.add_depot(x=v, y=0) for v in ends}
        clients = {v: model.add_client(x=v, y=0, prize=int(prizes[v]), required=False) for v in inner}
        places = [(depots | clients)[v] for v in range(problem.size)]
    model.add_vehicle_type(start_depot=depots[problem.start], end_depot=depots[problem.end], max_distance=_LENGTHS)
    for a in range(problem.size):
        for b in range(problem.size):
            model.add_edge(places[a], places[b], distance=0 if a == b else int(lengths[a, b]))
    began = time.perf_counter()
    result = model.solve(stop=MaxRuntime(seconds), seed=seed, display=False)
    took = time.perf_counter() - began
    routes = result.best.routes() if result.is_feasible() else []
    stops: list[int] = []
    for activity in (activity for route in routes for activity in route):
        if isinstance(activity, int):  # before PyVRP 0.14: a location, of which the depots are the first
            stops.append(inner[activity - len(depots)])
        elif activity.is_client():
            stops.append(inner[activity.idx])
    way = [problem.start, *stops, problem.end]
    return RouteResult(
        solver="PyVRP",
        reward=float(problem.rewards[stops].sum()),
        length=float(sum(problem.distances[a, b] for a, b in pairwise(way))),
        seconds=took,
    )
