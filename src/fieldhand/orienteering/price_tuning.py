"""Tune the price of a failure by simulating missions at several prices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.policy import Policy, State
from fieldhand.orienteering.problem import Problem
from fieldhand.orienteering.simulated_mission import simulate_mission

#: Target of a tuned policy as a fraction of the accepted probability, and the margin below it in standard errors of the
#: trials.
_AIM, _CARE = 0.97, 1.5
#: Prior of the fit of the failure probability's logit against the logarithm of reward and price: its downward slope,
#: the standard deviation of that slope, and the deviation of the curve from a straight line.
_SLOPE, _FIRM, _BEND = 0.6, 0.25, 0.3
#: Maximum number of prices that are tried, and the largest step between two of them on that logarithmic scale.
_TRIALS, _STEP = 8, 0.5
#: Margin below the accepted probability, in standard errors, at which the lowest price needs no further missions.
_SURE = 3.0

Floats = NDArray[np.float64]


def tune_price(policy: Policy, problem: Problem, seed: int, missions: int) -> Policy:
    """Return the policy with the price of a failure tuned by simulated missions.

    The initial price of a policy is computed for a mission that only skips stops, whereas the policy replans after
    every leg. Therefore missions are simulated at a sequence of prices. Each next price is where a line through the
    earlier results reaches the accepted probability, less a margin for their uncertainty.

    Args:
        policy: The policy before tuning.
        problem: The problem of the policy.
        seed: Seed of the missions.
        missions: Maximum number of missions; a few hundred determine the failure probability to within a few percent of
            its value.
    """
    accepted = _AIM * min(limit.failure_probability for limit in problem.limits)
    policy.next(State(vertex=problem.start, left=tuple(limit.budget for limit in problem.limits)))
    if policy.price is None:
        # The order is so long that the price is only computed near its end.
        return policy.again(seed)
    typical = max(policy.expectation.reward, -1.25 * policy.least_price, 1e-9)

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
    """The failure probability of each simulated mission, at one logarithm of reward and price."""

    at: float
    chances: Floats


def _trial(policy: Policy, problem: Problem, rng: np.random.Generator, at: float, price: float, count: int) -> _Trial:
    chances = np.empty(count)
    for i in range(count):
        again = policy.again(int(rng.integers(2**31)), price)
        chances[i] = simulate_mission(problem, again.next, rng, again.success_after_leg).chance
    return _Trial(at, chances)


def _error(known: list[_Trial]) -> Floats:
    """Return the standard error of each mean chance.

    The variance is pooled over all prices: it hardly depends on the price, and few missions do not determine it.
    """
    counts = np.array([len(trial.chances) for trial in known])
    squares = sum(float(((trial.chances - trial.chances.mean()) ** 2).sum()) for trial in known)
    freedom = int((counts - 1).sum())
    spread = np.sqrt(squares / freedom) if freedom else 1.0
    return np.asarray((spread + 1e-3) / np.sqrt(counts))


def _nearer(known: list[_Trial], accepted: float, care: float) -> float:
    """Return the abscissa where a line through the logits of the probabilities reaches the accepted one.

    Args:
        known: Trials so far.
        accepted: Accepted failure probability.
        care: Safety margin in standard errors of the line.
    """
    at, chance = np.array([trial.at for trial in known]), np.array([trial.chances.mean() for trial in known])
    error = _error(known)
    chance = np.clip(chance, 0.1 * accepted, 1.0 - 0.1 * (1.0 - accepted))
    logit, wanted = np.log(chance / (1.0 - chance)), float(np.log(accepted / (1.0 - accepted)))
    # The curve is straight only near the accepted probability, so the nearest trials count most.
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
