"""Missions driven on paper: legs cost what is drawn; and the price of a failure that such missions teach."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.policy import Policy, State
from fieldhand.orienteering.problem import Problem
from fieldhand.orienteering.tail import exceeding

#: What a policy that is set by trials aims at, of the chance that is accepted: trials are few.
_AIM = 0.9
#: How the logit of the chance of failing falls with the logarithm of reward and price, and how firmly that is held.
_SLOPE, _FIRM = -1.0, 2.0

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Mission:
    """One mission that was driven.

    Attributes:
        path: Vertices in their order, start and end included.
        reward: Of every vertex arrived at, the end's included, as long as no limit was exceeded.
        left: Of each limit at the end; negative where it was exceeded.
        chance: Of exceeding a limit, as it stood before the last leg.
    """

    path: tuple[int, ...]
    reward: float
    left: tuple[float, ...]
    chance: float

    @property
    def kept(self) -> bool:
        """Whether no limit was exceeded."""
        return min(self.left) >= 0.0


def drive(problem: Problem, following: Callable[[State], int], rng: np.random.Generator) -> Mission:
    """Drive one mission.

    Args:
        problem: As it stands before the mission.
        following: The vertex to go to next.
        rng: For what the legs cost.
    """
    path, visited, reward, over, chance = [problem.start], frozenset[int](), 0.0, False, 1.0
    left = np.array([limit.budget for limit in problem.limits])
    while len(path) == 1 or path[-1] != problem.end:
        vertex = following(State(vertex=path[-1], left=tuple(left.tolist()), visited=visited))
        if vertex == problem.end:
            chance = 1.0 if over else _last_chance(problem, path[-1], left)
        left = left - problem.length(path[-1], vertex) * float(problem.model.draw(rng, 1)[0]) - _work(problem, vertex)
        if vertex == problem.end:
            for leg in problem.after:
                left = left - leg * float(problem.model.draw(rng, 1)[0])
        over = over or bool((left < 0.0).any())
        if not over and vertex not in visited:
            reward += float(problem.rewards[vertex])
        visited |= {vertex}
        path.append(vertex)
    return Mission(path=tuple(path), reward=reward, left=tuple(left.tolist()), chance=chance)


def tried(policy: Policy, problem: Problem, seed: int, missions: int) -> Policy:
    """The policy with the price of a failure that missions of its own teach.

    The price a policy begins with is right for a mission that only shortens its order; this one makes it anew after
    every leg. So missions are driven at several prices, and a logistic curve through their chances of failing says at
    which price it is the accepted one.

    Args:
        policy: As it is.
        problem: What it is a policy for.
        seed: Of the missions.
        missions: How many; a few hundred bring the chance within a percent or two.
    """
    accepted = _AIM * min(limit.failure_probability for limit in problem.limits)
    policy.next(State(vertex=problem.start, left=tuple(limit.budget for limit in problem.limits)))
    if policy.price is None:
        # The way is so long that its price is only found near its end.
        return policy.again(seed)
    typical = max(policy.outlook.reward, -1.25 * policy.least_price, 1e-9)

    def price_of(x: float) -> float:
        return max(policy.least_price, typical * (float(np.exp(x)) - 1.0))

    middle, least = (float(np.log1p(p / typical)) for p in (policy.price, policy.least_price))
    rng = np.random.default_rng(seed)
    at, chances = np.zeros(0), np.zeros(0)
    for count, width in ((missions // 3, 0.7), (missions - missions // 3, 0.4)):
        for x in np.maximum(least, middle + width * (2.0 * (np.arange(count) + 0.5) / max(count, 1) - 1.0)):
            made = drive(problem, policy.again(int(rng.integers(2**31)), price_of(x)).next, rng)
            at, chances = np.append(at, x), np.append(chances, made.chance)
        if len(at):
            middle = max(least, _crossing(at, chances, accepted))
    return policy.again(seed, price_of(middle))


def _crossing(at: Floats, chances: Floats, accepted: float) -> float:
    """Where the logistic curve through the chances comes down to the accepted one.

    Few missions say little about the slope: it is held near ``_SLOPE``, which is what most problems have.
    """
    around = at - at.mean()
    level, slope = float(np.log(accepted / (1.0 - accepted))), _SLOPE
    for _ in range(30):
        curve = 1.0 / (1.0 + np.exp(-(level + slope * around)))
        weight = np.maximum(curve * (1.0 - curve), 1e-6)
        gradient = np.array([(chances - curve).sum(), ((chances - curve) * around).sum() - _FIRM * (slope - _SLOPE)])
        curvature = np.array([[weight.sum(), (weight * around).sum()], [(weight * around).sum(), 0.0]])
        curvature[1, 1] = (weight * around**2).sum() + _FIRM
        move = np.clip(np.linalg.solve(curvature, gradient), -0.5, 0.5)
        level, slope = level + float(move[0]), min(-0.2, slope + float(move[1]))
    wanted = float(np.log(accepted / (1.0 - accepted)))
    return float(at.mean()) + float(np.clip((wanted - level) / slope, -1.5, 1.5))


def _work(problem: Problem, vertex: int) -> Floats:
    if vertex == problem.start:
        return np.zeros(len(problem.limits))
    return np.array([0.0 if limit.service is None else float(limit.service[vertex]) for limit in problem.limits])


def _last_chance(problem: Problem, vertex: int, left: Floats) -> float:
    legs = np.array([problem.length(vertex, problem.end), *problem.after])
    second, third = problem.model.cumulants()
    room = left - _work(problem, problem.end)
    return float(exceeding(legs.sum(), second * (legs**2).sum(), third * (legs**3).sum(), room).max())
