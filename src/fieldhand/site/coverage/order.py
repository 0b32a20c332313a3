"""Order of swaths, and the direction of each, with little driving in between.

Every swath is entered at one of its two ends and left at the other. The search starts from orders of whole runs of
neighbouring swaths and improves them by reversing and moving parts (2-opt and Or-opt), with seeded perturbations.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

#: Metres that stand for ends that no path connects.
_UNCONNECTED_M = 1e7

#: Improvements smaller than this, in metres, are rounding errors.
_NOTHING_M = 1e-7

#: Elements of the matrices of all moves that the perturbations may evaluate in total.
_EFFORT = 40_000_000

#: Greatest number of perturbations.
_MOST_ROUNDS = 150

#: Longest part that is moved, in swaths, among few swaths and among many.
_LONG_PART, _SHORT_PART = 30, 3


class SwathOrder:
    """The problem: metres between the ends of swaths.

    The ends of swath k are numbered 2 k and 2 k + 1.

    Args:
        metres: Metres from leaving at one end to entering at another, shape (2 n, 2 n), symmetric.
        start: Metres from the start of the drive to each end, shape (2 n,); None for any start.
        goal: Metres from each end to the end of the drive; None for any end.
    """

    def __init__(self, metres: Floats, start: Floats | None = None, goal: Floats | None = None) -> None:
        ends = len(metres)
        self.count = ends // 2
        padded = np.zeros((ends + 2, ends + 2))
        padded[:ends, :ends] = metres
        if start is not None:
            padded[ends, :ends] = start
        if goal is not None:
            padded[:ends, ends + 1] = goal
        self.metres = np.minimum(padded, _UNCONNECTED_M)

    def length(self, enters: Ints) -> float:
        """Return the metres between swaths of an order, given by the end at which each is entered."""
        before, after = self._sides(enters)
        return float(self.metres[before, after].sum())

    def improved(self, enters: Ints) -> Ints:
        """Return an order that no reversal and no move of a part improves."""
        length = self.length(enters)
        while True:
            found = self._reversal(enters)
            if found is None:
                found = self._moved(enters)
            if found is None:
                return enters
            shorter = self.length(found)
            if shorter >= length - _NOTHING_M / 2.0:  # the differences were rounding errors
                return enters
            enters, length = found, shorter

    def perturbed(self, enters: Ints, rng: np.random.Generator) -> Ints:
        """Return the best of several orders that result from perturbing an order and improving it again."""
        if self.count < 4:
            return enters
        best, length = enters, self.length(enters)
        rounds = int(np.clip(_EFFORT / (self.count**2 * 60), 0, _MOST_ROUNDS))
        for _ in range(rounds):
            a, b, c = np.sort(rng.choice(np.arange(1, self.count), 3, replace=False)).tolist()
            span = min(c, a + 40)
            b = min(b, span)
            shaken = np.concatenate([best[:a], best[b:span], best[a:b], best[span:]])
            other = self.improved(shaken)
            if (metres := self.length(other)) < length - _NOTHING_M:
                best, length = other, metres
        return best

    def _sides(self, enters: Ints) -> tuple[Ints, Ints]:
        """Return the ends left before, and entered after, each gap of an order, shape (n + 1,)."""
        ends = 2 * self.count
        return np.concatenate([[ends], enters ^ 1]), np.concatenate([enters, [ends + 1]])

    def _reversal(self, enters: Ints) -> Ints | None:
        """Return the order with the part reversed that saves most; None if none saves anything."""
        n, m = len(enters), self.metres
        before, after = self._sides(enters)
        gaps = m[before, after]
        change = m[before[:-1, None], enters[None] ^ 1] + m[enters[:, None], after[None, 1:]]
        change -= gaps[:-1, None] + gaps[None, 1:]
        change[np.tril_indices(n, -1)] = np.inf
        i, j = divmod(int(np.argmin(change)), n)
        if change[i, j] >= -_NOTHING_M:
            return None
        return np.concatenate([enters[:i], enters[i : j + 1][::-1] ^ 1, enters[j + 1 :]])

    def _moved(self, enters: Ints) -> Ints | None:
        """Return the order with a part moved, and perhaps reversed, for the first length of part that saves."""
        n, m = len(enters), self.metres
        before, after = self._sides(enters)
        gaps = m[before, after]
        places = np.arange(n + 1)
        for size in range(1, min(n, (_LONG_PART if n <= 120 else _SHORT_PART) + 1)):
            first = np.arange(n - size + 1)
            saved = gaps[first] + gaps[first + size] - m[before[first], after[first + size]]
            head, tail = enters[first], enters[first + size - 1] ^ 1
            same = m[before[None], head[:, None]] + m[tail[:, None], after[None]]
            turned = m[before[None], tail[:, None]] + m[head[:, None], after[None]]
            change = np.minimum(same, turned) - gaps[None] - saved[:, None]
            change[(places[None] >= first[:, None]) & (places[None] <= first[:, None] + size)] = np.inf
            k, place = divmod(int(np.argmin(change)), n + 1)
            if change[k, place] < -_NOTHING_M:
                part = enters[k : k + size]
                if turned[k, place] < same[k, place]:
                    part = part[::-1] ^ 1
                rest = np.concatenate([enters[:k], enters[k + size :]])
                at = place if place < k else place - size
                return np.concatenate([rest[:at], part, rest[at:]])
        return None


def shortest_swath_order(problem: SwathOrder, runs: Sequence[Sequence[int]], seed: int) -> Ints:
    """Return the end at which each swath is entered, in driving order.

    Args:
        problem: Metres between the ends of swaths.
        runs: Swaths of each run, from one side to the other; even ends of neighbours lie beside each other.
        seed: Seed of the perturbations.
    """
    if not problem.count:
        return np.zeros(0, dtype=np.intp)
    firsts = [_chained(problem, [pattern(list(run)) for run in runs]) for pattern in (_back_and_forth, _snake)]
    improved = [problem.improved(enters) for enters in firsts]
    best = min(improved, key=lambda enters: round(problem.length(enters), 6))
    return problem.perturbed(best, np.random.default_rng(seed))


def _back_and_forth(run: list[int]) -> list[int]:
    """Return the ends at which the swaths of a run are entered, one beside the other."""
    return [2 * swath + k % 2 for k, swath in enumerate(run)]


def _snake(run: list[int]) -> list[int]:
    """Return the ends of every second swath on the way there, and of the others on the way back."""
    return _back_and_forth(run[::2] + run[1::2][::-1])


def _chained(problem: SwathOrder, runs: list[list[int]]) -> Ints:
    """Return the runs in an order in which each is the nearest to the one before it, entered at any of its corners."""
    metres, ends = problem.metres, 2 * problem.count
    at, enters = ends, []
    left = dict(enumerate(runs))
    while left:
        choices = [
            (float(metres[at, way[0]]), k, n, way)
            for k, run in left.items()
            for n, way in enumerate((run, [e ^ 1 for e in run], [e ^ 1 for e in run[::-1]], run[::-1]))
        ]
        _, k, _, way = min(choices, key=lambda choice: (round(choice[0], 6), choice[1], choice[2]))
        enters += way
        at = way[-1] ^ 1
        del left[k]
    return np.array(enters, dtype=np.intp)
