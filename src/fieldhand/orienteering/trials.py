"""Missions driven on paper: legs cost what is drawn; and the price of a failure that such missions teach."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.policy import Policy, State
from fieldhand.orienteering.problem import Problem
from fieldhand.orienteering.tail import exceeding

if TYPE_CHECKING:
    from fieldhand.orienteering.adaptive import Foresight

#: What a policy that is set by trials aims at, of the chance that is accepted, and by how many standard errors of
#: what it learnt it stays below that.
_AIM, _CARE = 0.97, 1.5
#: How fast the logit of the chance of failing falls with the logarithm of reward and price, how far it may be from
#: that, and how far its curve from a straight line.
_SLOPE, _FIRM, _BEND = 0.6, 0.25, 0.3
#: Prices that are tried, and the farthest step between two of them, in that logarithm.
_TRIALS, _STEP = 8, 0.5
#: Standard errors below the accepted chance at which the least price needs no more missions.
_SURE = 3.0
#: Equally likely costs of a leg over which what was foreseen is averaged.
_COSTS = 512

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Mission:
    """One mission that was driven.

    Attributes:
        path: Vertices in their order, start and end included.
        reward: Of every vertex arrived at, the end's included, as long as no limit was exceeded.
        left: Of each limit at the end; negative where it was exceeded.
        chance: Of exceeding a limit, as it stood before the last leg; without the luck of the legs before, as far as
            it was foreseen what that would mean. Its mean over missions is the chance of failing; of a single one it
            may lie outside 0 to 1.
    """

    path: tuple[int, ...]
    reward: float
    left: tuple[float, ...]
    chance: float

    @property
    def kept(self) -> bool:
        """Whether no limit was exceeded."""
        return min(self.left) >= 0.0


def drive(
    problem: Problem,
    following: Callable[[State], int],
    rng: np.random.Generator,
    foresight: Callable[[], Foresight | None] | None = None,
) -> Mission:
    """Drive one mission.

    Args:
        problem: As it stands before the mission.
        following: The vertex to go to next.
        rng: For what the legs cost.
        foresight: What was foreseen of the leg to that vertex; asked after ``following``.
    """
    path, visited, reward, over, chance, luck = [problem.start], frozenset[int](), 0.0, False, 1.0, 0.0
    left = np.array([limit.budget for limit in problem.limits])
    factors = problem.model.quantile((np.arange(_COSTS) + 0.5) / _COSTS)
    while len(path) == 1 or path[-1] != problem.end:
        vertex = following(State(vertex=path[-1], left=tuple(left.tolist()), visited=visited))
        seen = foresight() if foresight is not None and vertex != problem.end else None
        if vertex == problem.end:
            chance = 1.0 if over else _last_chance(problem, path[-1], left)
        leg, work = problem.length(path[-1], vertex), _work(problem, vertex)
        before = left - work
        left = before - leg * float(problem.model.draw(rng, 1)[0])
        if seen is not None:
            # A control variate: its mean is 0, and it is high where the legs were cheap.
            luck += float(seen.at(left[seen.limit]) - seen.at(before[seen.limit] - leg * factors).mean())
        if vertex == problem.end:
            for after in problem.after:
                left = left - after * float(problem.model.draw(rng, 1)[0])
        over = over or bool((left < 0.0).any())
        if not over and vertex not in visited:
            reward += float(problem.rewards[vertex])
        visited |= {vertex}
        path.append(vertex)
    return Mission(path=tuple(path), reward=reward, left=tuple(left.tolist()), chance=chance + luck)


def tried(policy: Policy, problem: Problem, seed: int, missions: int) -> Policy:
    """The policy with the price of a failure that missions of its own teach.

    The price a policy begins with is right for a mission that only shortens its order; this one makes it anew after
    every leg. So missions are driven at one price after another, each where a line through what the ones before told
    comes down to the accepted chance, less what is still uncertain.

    Args:
        policy: As it is.
        problem: What it is a policy for.
        seed: Of the missions.
        missions: At most so many; a few hundred bring the chance within some hundredths of itself.
    """
    accepted = _AIM * min(limit.failure_probability for limit in problem.limits)
    policy.next(State(vertex=problem.start, left=tuple(limit.budget for limit in problem.limits)))
    if policy.price is None:
        # The way is so long that its price is only found near its end.
        return policy.again(seed)
    typical = max(policy.outlook.reward, -1.25 * policy.least_price, 1e-9)

    def price_of(x: float) -> float:
        return max(policy.least_price, typical * (float(np.exp(x)) - 1.0))

    at, least = (float(np.log1p(p / typical)) for p in (policy.price, policy.least_price))
    rng = np.random.default_rng(seed)
    known: list[_Trial] = []
    for count in np.diff(np.linspace(0, missions, _TRIALS + 1).astype(int)):
        if count:
            known.append(_trial(policy, problem, rng, at, price_of(at), int(count)))
            if at <= least and known[-1].chances.mean() + _SURE * _error(known)[-1] < accepted:
                return policy.again(seed, policy.least_price)
            at = max(least, _nearer(known, accepted, 0.0))
    return policy.again(seed, price_of(_nearer(known, accepted, _CARE) if known else at))


@dataclass(frozen=True, eq=False)
class _Trial:
    """At a logarithm of reward and price: the chance of failing in each mission."""

    at: float
    chances: Floats


def _trial(policy: Policy, problem: Problem, rng: np.random.Generator, at: float, price: float, count: int) -> _Trial:
    chances = np.empty(count)
    for i in range(count):
        again = policy.again(int(rng.integers(2**31)), price)
        chances[i] = drive(problem, again.next, rng, again.foresight).chance
    return _Trial(at, chances)


def _error(known: list[_Trial]) -> Floats:
    """The standard error of each mean chance. Missions spread alike at all prices; few of them rarely show how far."""
    counts = np.array([len(trial.chances) for trial in known])
    squares = sum(float(((trial.chances - trial.chances.mean()) ** 2).sum()) for trial in known)
    freedom = int((counts - 1).sum())
    spread = np.sqrt(squares / freedom) if freedom else 1.0
    return np.asarray((spread + 1e-3) / np.sqrt(counts))


def _nearer(known: list[_Trial], accepted: float, care: float) -> float:
    """Where a straight line through the logits of the chances comes down to the accepted one.

    Args:
        known: What was tried.
        accepted: The chance.
        care: How many standard errors of the line to stay on the safe side.
    """
    at, chance = np.array([trial.at for trial in known]), np.array([trial.chances.mean() for trial in known])
    error = _error(known)
    chance = np.clip(chance, 0.1 * accepted, 1.0 - 0.1 * (1.0 - accepted))
    logit, wanted = np.log(chance / (1.0 - chance)), float(np.log(accepted / (1.0 - accepted)))
    # The line is only straight near the accepted chance, so what lies nearest counts most.
    around = at - at[np.argmin(np.abs(logit - wanted))]
    weight = 1.0 / ((error / (chance * (1.0 - chance))) ** 2 + (_BEND * around) ** 2)
    gradient = np.array([(weight * logit).sum(), (weight * logit * around).sum() - _SLOPE / _FIRM**2])
    curvature = np.array([[weight.sum(), (weight * around).sum()], [0.0, (weight * around**2).sum() + _FIRM**-2]])
    curvature[1, 0] = curvature[0, 1]
    spread = np.linalg.inv(curvature)
    level, slope = spread @ gradient
    slope = min(float(slope), -0.3)
    move = (wanted - level) / slope
    move -= care * float(np.sqrt(np.array([1.0, move]) @ spread @ np.array([1.0, move]))) / slope
    return float(at[-1] - around[-1] + np.clip(move, around.min() - _STEP, around.max() + _STEP))


def _work(problem: Problem, vertex: int) -> Floats:
    if vertex == problem.start:
        return np.zeros(len(problem.limits))
    return np.array([0.0 if limit.service is None else float(limit.service[vertex]) for limit in problem.limits])


def _last_chance(problem: Problem, vertex: int, left: Floats) -> float:
    legs = np.array([problem.length(vertex, problem.end), *problem.after])
    second, third = problem.model.cumulants()
    room = left - _work(problem, problem.end)
    return float(exceeding(legs.sum(), second * (legs**2).sum(), third * (legs**3).sum(), room).max())
