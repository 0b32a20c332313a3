"""What a policy will come to, before it is driven: many missions at once that skip stops of the order it has planned.

On board the order is planned anew after every leg, so missions collect about as much as is said here, or more.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.policy import Policy, State

if TYPE_CHECKING:
    from fieldhand.orienteering.adaptive import Lookout, Order

Floats = NDArray[np.float64]

#: Stops at the end of a long order that may be skipped; those before are driven as planned.
_LAST = 56


@dataclass(frozen=True, kw_only=True, eq=False)
class Preview:
    """Missions, one a row.

    Attributes:
        vertices: Stops of the order, shape (k,).
        visited: Whether each is visited, shape (missions, k).
        legs: What the legs to them cost in all, shape (missions,).
        last: What the leg from the last of them to the end costs, shape (missions,).
    """

    vertices: NDArray[np.int64]
    visited: NDArray[np.bool_]
    legs: Floats
    last: Floats

    @property
    def visits(self) -> Floats:
        """How many each mission makes, shape (missions,)."""
        return np.asarray(self.visited.sum(axis=1), dtype=np.float64)


def preview(policy: Policy, state: State, rng: np.random.Generator, used: Floats) -> Preview:
    """Drive what a policy plans from a state on.

    Args:
        policy: It has not decided anything there yet.
        state: Where the missions stand on the whole.
        rng: For what the legs cost.
        used: By how much more than that each mission has used already, shape (missions,); negative where it is less.
    """
    policy.next(state)
    stops = np.array(policy.outlook.vertices[1:-1], dtype=np.int64)
    fixed = 0 if policy.plan is not None else max(0, len(stops) - _LAST)
    driven = _Missions(policy, state, used)
    driven.visit(stops[:fixed], rng)
    if fixed:
        # What a mission that is neither lucky nor unlucky has left there, and plans there.
        amounts = tuple(float(np.median(x)) for x in driven.left.T)
        visited = frozenset({*state.visited, *stops[:fixed].tolist()})
        policy = policy.again(int(rng.integers(2**31)), warm=stops[fixed:].tolist())
        policy.next(State(vertex=int(stops[fixed - 1]), left=amounts, visited=visited))
        stops = np.array(policy.outlook.vertices[1:-1], dtype=np.int64)
    if policy.plan is None:
        driven.visit(stops, rng)
    else:
        driven.skip(*policy.plan, rng)
    return driven.made(rng)


class _Missions:
    """Missions under way."""

    def __init__(self, policy: Policy, state: State, used: Floats) -> None:
        self._ground, count = policy.ground, len(used)
        self._at = np.full(count, state.vertex, dtype=np.int64)
        self.left = np.asarray(state.left)[None, :] - used[:, None]
        self._legs = np.zeros(count)
        self._stops: list[NDArray[np.int64]] = []
        self._visited: list[NDArray[np.bool_]] = []

    def visit(self, stops: NDArray[np.int64], rng: np.random.Generator) -> None:
        """Every mission drives to every stop."""
        everyone = np.ones(len(self._at), dtype=bool)
        for stop in stops.tolist():
            self._go(everyone, int(stop), rng)
        self._stops.append(stops)
        self._visited.append(np.ones((len(self._at), len(stops)), dtype=bool))

    def skip(self, lookout: Lookout, order: Order, bonus: float, rng: np.random.Generator) -> None:
        """Each mission skips what it would, with what it has left."""
        choice, step, limit = lookout.choices(order.stops, bonus)
        visited = np.zeros((len(self._at), len(order.stops)), dtype=bool)
        position, last = np.zeros(len(self._at), dtype=np.int64), len(order.stops) + 1
        for i in range(last):
            here = np.flatnonzero(position == i)
            entry = np.clip(np.round(self.left[here, limit] / step), 0, choice.shape[1] - 1).astype(np.int64)
            goes = np.where(self.left[here, limit] <= 0.0, last, choice[i, entry])
            position[here] = goes
            for j in np.unique(goes[goes < last]).tolist():
                some = np.zeros(len(self._at), dtype=bool)
                some[here[goes == j]] = True
                self._go(some, int(order.stops[j - 1]), rng)
                visited[some, j - 1] = True
        self._stops.append(order.stops)
        self._visited.append(visited)

    def made(self, rng: np.random.Generator) -> Preview:
        """What has become of them, with the way to the end."""
        ground = self._ground
        last = self._lengths(ground.size, self._at) * ground.problem.model.draw(rng, len(self._at))
        return Preview(
            vertices=np.concatenate(self._stops),
            visited=np.concatenate(self._visited, axis=1),
            legs=self._legs,
            last=last,
        )

    def _go(self, some: NDArray[np.bool_], stop: int, rng: np.random.Generator) -> None:
        ground = self._ground
        cost = self._lengths(stop, self._at[some]) * ground.problem.model.draw(rng, int(some.sum()))
        self._legs[some] += cost
        self.left[some] -= cost[:, None] + ground.service[:, stop]
        self._at[some] = stop

    def _lengths(self, to: int, vertices: NDArray[np.int64]) -> Floats:
        """Of the legs from some vertices to a node; the way back may be another where there is a table."""
        ground = self._ground
        if len(ground.ways.matrix):
            return np.asarray(ground.ways.matrix[vertices, to])
        return ground.row(ground.problem.end if to == ground.size else to)[vertices]
