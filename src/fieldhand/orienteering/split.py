"""One chance for a whole mission: how it is split over what the next leg may cost.

A mission may exceed a limit with chance Pf. Allowing every decision Pf anew would break that, since unlucky legs (after
which even the way home is risky) come on top; holding every decision to what the first plan left gives reward up in
unlucky states and hoards it in lucky ones. So before each leg its decision's chance is split over the leg's costs: the
mean over them of what is allowed afterwards is what is allowed now, and by induction the chance over the whole mission
is that of the first decision. Where it goes is settled by a price on the chance: at every cost that continuation is
taken which is worth most after paying for its chance, with the one price at which the mean comes out right.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.tail import chance_over, leg_costs

Floats = NDArray[np.float64]

_SLICES = 96
_NEGLIGIBLE = 1e-9
_STEPS = 40


@dataclass(frozen=True, kw_only=True)
class Option:
    """A way in which a mission could go on after the next leg.

    Attributes:
        length, squares: Sums of its legs' lengths and of their squares.
        service: For each limit, what the work along it takes.
        reward: What it collects.
    """

    length: float
    squares: float
    service: tuple[float, ...]
    reward: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Split:
    """What the decision after a leg is allowed, by what is left then.

    Attributes:
        options: The first one is the direct way to the end.
        alpha: The certain part of a leg's cost.
        prices: For each limit, what a chance of 1 to exceed it is worth; infinite where nothing can be spared.
        floors: For each limit, what is allowed in any case.
    """

    options: tuple[Option, ...]
    alpha: float
    prices: tuple[float, ...]
    floors: tuple[float, ...]

    def levels(self, left: Sequence[float]) -> Floats:
        """The chance that the next decision may take, for each limit.

        Args:
            left: What is left of each limit after the leg and the work at its end.
        """
        found = []
        for limit, (price, floor) in enumerate(zip(self.prices, self.floors, strict=True)):
            chances, rewards = _chances(self.options, limit, np.array([left[limit]]), self.alpha)
            found.append(max(floor, float(_taken(chances, rewards, price)[0])))
        return np.array(found)


def split(levels: Floats, leg: float, alpha: float, left: Sequence[float], options: Sequence[Option]) -> Split:
    """Split what this decision is allowed.

    Args:
        levels: For each limit, the chance that this decision may take.
        leg: Length of the leg that is about to be driven.
        alpha: The certain part of a leg's cost.
        left: What is left of each limit, the work at the leg's end already taken from it, the leg not yet.
        options: How the mission could go on after the leg; the first one is the direct way to the end.
    """
    costs = leg_costs(leg, alpha, _SLICES) if alpha < 1.0 and leg > 0.0 else np.array([leg])
    prices, floors = [], []
    for limit, level in enumerate(levels):
        chances, rewards = _chances(options, limit, left[limit] - costs, alpha)
        price = _price(chances, rewards, float(level))
        prices.append(price)
        floors.append(_floor(_taken(chances, rewards, price), float(level)))
    return Split(options=tuple(options), alpha=alpha, prices=tuple(prices), floors=tuple(floors))


def _chances(options: Sequence[Option], limit: int, left: Floats, alpha: float) -> tuple[Floats, Floats]:
    """Chance and worth of each option at each of some amounts left, shape (options, amounts).

    An option that takes more than is left even on average is worth nothing, unless it is the direct way.
    """
    length = np.array([o.length for o in options])[:, None]
    squares = np.array([o.squares for o in options])[:, None]
    room = left[None, :] - np.array([o.service[limit] for o in options])[:, None]
    possible = length <= np.maximum(room, options[0].length) * (1 + 1e-9)
    rewards = np.where(possible, np.array([o.reward for o in options])[:, None], -np.inf)
    return chance_over(length, squares, room, alpha), rewards


def _taken(chances: Floats, rewards: Floats, price: float) -> Floats:
    """The chance of the option that is taken at each amount."""
    if np.isinf(price):
        return np.asarray(np.where(np.isinf(rewards), 1.0, chances).min(axis=0))
    best = (rewards - price * chances).argmax(axis=0)
    return np.asarray(np.take_along_axis(chances, best[None, :], axis=0)[0])


def _price(chances: Floats, rewards: Floats, level: float) -> float:
    """The least price at which the options taken have a mean chance of at most ``level``."""
    if chances.max() < _NEGLIGIBLE or float(_taken(chances, rewards, 0.0).mean()) <= level:
        return 0.0
    if float(_taken(chances, rewards, np.inf).mean()) > level:
        return np.inf
    top = max(float(rewards[np.isfinite(rewards)].max()), 1e-9)
    low, high = np.log(top * 1e-4), np.log(top * 1e8)
    for _ in range(_STEPS):
        middle = 0.5 * (low + high)
        if float(_taken(chances, rewards, float(np.exp(middle))).mean()) <= level:
            high = middle
        else:
            low = middle
    return float(np.exp(high))


def _floor(taken: Floats, level: float) -> float:
    """The number q for which the mean of ``max(q, taken)`` is ``level``; 0 where ``taken`` alone has more."""
    ascending = np.sort(taken)
    above = np.append(np.cumsum(ascending[::-1])[::-1], 0.0)
    # With q between the k-th and the next, k of them are lifted to q and the rest stays.
    for count in range(len(ascending), 0, -1):
        q = (level * len(ascending) - above[count]) / count
        if q >= ascending[count - 1]:
            return float(q)
    return 0.0
