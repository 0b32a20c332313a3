"""Simulate one mission of a policy: the cost of each leg is drawn when it is driven."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.overrun import overrun_probability
from fieldhand.orienteering.policy import State
from fieldhand.orienteering.problem import Problem

if TYPE_CHECKING:
    from fieldhand.orienteering.decision import SuccessAfterLeg

#: Equally likely costs of a leg over which the predicted chance of success is averaged.
_COSTS = 512

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class SimulatedMission:
    """One mission that was driven.

    Attributes:
        path: Vertices in visiting order, including start and end.
        reward: Total reward of the vertices reached before any limit was exceeded, including the end.
        left: Amount left of each limit at the end; negative if exceeded.
        chance: Estimate of the failure probability with reduced variance: the overrun probability before the last leg,
            corrected by a control variate for the random costs of the earlier legs. Its mean over missions is the
            failure probability; a single value may lie outside 0 to 1.
    """

    path: tuple[int, ...]
    reward: float
    left: tuple[float, ...]
    chance: float

    @property
    def kept(self) -> bool:
        """Return True if no limit was exceeded."""
        return min(self.left) >= 0.0


def simulate_mission(
    problem: Problem,
    following: Callable[[State], int],
    rng: np.random.Generator,
    success_after_leg: Callable[[], SuccessAfterLeg | None] | None = None,
) -> SimulatedMission:
    """Simulate one mission.

    Args:
        problem: The problem at the start of the mission.
        following: Function that returns the next vertex.
        rng: Random generator of the leg costs.
        success_after_leg: Success probabilities after the leg to that vertex; called after ``following``.
    """
    path, visited, reward, over, chance, luck = [problem.start], frozenset[int](), 0.0, False, 1.0, 0.0
    left = np.array([limit.budget for limit in problem.limits])
    factors = problem.model.quantile((np.arange(_COSTS) + 0.5) / _COSTS)
    while len(path) == 1 or path[-1] != problem.end:
        vertex = following(State(vertex=path[-1], left=tuple(left.tolist()), visited=visited))
        seen = success_after_leg() if success_after_leg is not None and vertex != problem.end else None
        if vertex == problem.end:
            chance = 1.0 if over else _last_chance(problem, path[-1], left)
        leg, work = problem.length(path[-1], vertex), _work(problem, vertex)
        before = left - work
        left = before - leg * float(problem.model.draw(rng, 1)[0])
        if seen is not None:
            # A control variate with mean 0, high if the legs were cheap.
            luck += float(seen.at(left[seen.limit]) - seen.at(before[seen.limit] - leg * factors).mean())
        if vertex == problem.end:
            for after in problem.legs_after:
                left = left - after * float(problem.model.draw(rng, 1)[0])
        over = over or bool((left < 0.0).any())
        if not over and vertex not in visited:
            reward += float(problem.rewards[vertex])
        visited |= {vertex}
        path.append(vertex)
    return SimulatedMission(path=tuple(path), reward=reward, left=tuple(left.tolist()), chance=chance + luck)


def _work(problem: Problem, vertex: int) -> Floats:
    if vertex == problem.start:
        return np.zeros(len(problem.limits))
    return np.array([0.0 if limit.service is None else float(limit.service[vertex]) for limit in problem.limits])


def _last_chance(problem: Problem, vertex: int, left: Floats) -> float:
    legs = np.array([problem.length(vertex, problem.end), *problem.legs_after])
    second, third = problem.model.cumulants()
    room = left - _work(problem, problem.end)
    return float(overrun_probability(legs.sum(), second * (legs**2).sum(), third * (legs**3).sum(), room).max())
