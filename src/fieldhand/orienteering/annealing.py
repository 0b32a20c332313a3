"""Simulated annealing of a fixed route."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.kernels.anneal import anneal, begin, excess
from fieldhand.orienteering.prepared_problem import PreparedProblem

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

#: Initial and final temperature in rewards of a typical vertex, and the penalty for using the whole budget as a
#: fraction of the total reward; tuned on 100 to 1,000 random vertices.
HOT = 3.0
WARM = 0.5
_COLD = 0.1
_WORTH = 0.3


class Annealing:
    """Simulated annealing of the route from one vertex over some of ``free`` to the end.

    Args:
        prepared: The problem.
        here: First vertex of the route.
        free: Vertices that may be visited.
        budgets: Amount left of each limit.
        tables: For each limit the standardised cost quantiles at its failure probability (:func:`quantile_table`).
        stops: Initial route; if it exceeds a limit, its least valuable stops are removed.
        state: State of the random generator, one word.
        max_visits: Maximum number of stops; None for no limit.
    """

    def __init__(
        self,
        prepared: PreparedProblem,
        here: int,
        free: Ints,
        budgets: Floats,
        tables: Floats,
        stops: Ints,
        state: NDArray[np.uint64],
        max_visits: int | None = None,
    ) -> None:
        nodes, limits = prepared.size + 1, len(budgets)
        self._free = free
        self._after, self._before = np.empty(nodes, np.int64), np.empty(nodes, np.int64)
        self._sums, self._used = np.empty(5), np.empty(limits)
        self._best = np.empty(nodes, np.int64)
        self._record = np.array([-1.0, np.inf, 0.0])
        self._lengths = prepared.lengths
        self._priced = (prepared.rewards, prepared.service)
        self._limits = (budgets, prepared.cumulants, tables)
        self._max_visits = prepared.size if max_visits is None else min(max_visits, prepared.size)
        self._prepared, self._here, self._state = prepared, here, state
        begin(
            here, stops, prepared.afterwards, self._after, self._before, self._sums, self._used,
            self._lengths, *self._priced, *self._limits, self._max_visits,
        )  # fmt: skip
        self.feasible = bool(excess(self._sums, self._used, *self._limits) <= 0.0)
        if self.feasible:
            found = self._route()
            self._best[: len(found)] = found
            self._record[:] = (self._sums[3], self._sums[0], len(found))
        worth = prepared.rewards[free]
        self._typical = float(worth.mean()) if len(free) else 0.0

    @property
    def best(self) -> Ints:
        """Return the stops of the best route so far, or of the initial route if none keeps to the limits."""
        if self._record[0] < 0.0:
            return self._route()
        return self._best[: int(self._record[2])].copy()

    @property
    def reward(self) -> float:
        """Return the reward of the best route so far; negative if none keeps to the limits."""
        return float(self._record[0])

    def improve(self, rounds: int, heat: float = HOT, done: float = 0.0, then: float = 1.0) -> None:
        """Run a number of rounds of annealing.

        Args:
            rounds: Number of rounds.
            heat: Initial temperature over all rounds, in rewards of a typical vertex.
            done, then: Fraction of all rounds completed before and after this call.
        """
        if not len(self._free) or rounds < 0:
            return
        hot, cold = heat * self._typical, min(heat, _COLD) * self._typical
        worth = _WORTH / max(float(self._limits[0].max()), 1e-300)
        anneal(
            self._here, self._free, self._after, self._before, self._sums, self._used,
            self._lengths, self._prepared.near, *self._priced, *self._limits, self._max_visits,
            worth, hot * (cold / hot) ** done, hot * (cold / hot) ** then, rounds, self._state,
            self._best, self._record,
        )  # fmt: skip

    def _route(self) -> Ints:
        found: list[int] = []
        at = int(self._after[self._here])
        while at != self._prepared.size:
            found.append(at)
            at = int(self._after[at])
        return np.array(found, dtype=np.int64)


def stops_of(stops: Sequence[int], free: Ints) -> Ints:
    """Return the stops that are free, in the given order."""
    inside = set(free.tolist())
    return np.array([v for v in stops if v in inside], dtype=np.int64)
