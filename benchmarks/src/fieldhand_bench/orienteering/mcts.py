"""Plain Monte Carlo tree search: UCT over the next vertices, with random rollouts from the leaves.

Source: Kocsis and Szepesvári 2006. The tree is open-loop: a node is a sequence of vertices, regardless of its cost.
A move is allowed only if the drive there and directly to the end is safe; a mission over budget has no value.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import ProblemError
from fieldhand.orienteering.kernels.compiled import compiled
from fieldhand.orienteering.kernels.legs import Floats, Ints, Seeds, uniform
from fieldhand.orienteering.overrun import quantile_table
from fieldhand.orienteering.policy import State
from fieldhand.orienteering.problem import Problem


def require_supported(problem: Problem) -> None:
    """Raise a ProblemError for more than one limit, legs after the end, no distances, or a maximum number of visits."""
    if len(problem.limits) != 1 or not len(problem.distances) or problem.legs_after:
        raise ProblemError("the plain tree search takes problems with distances and one limit only")
    if problem.max_visits is not None:
        raise ProblemError("the plain tree search takes no problems with a maximum number of visits")


class TreeSearch:
    """A policy that chooses the next vertex by simulating missions from the current state.

    Args:
        problem: Problem with one limit and distances.
        seed: Random seed of the simulations.
        simulations: Number of simulations per decision.

    Raises:
        ProblemError: The problem has another form (:func:`require_supported`).
    """

    def __init__(self, problem: Problem, seed: int, simulations: int = 2000) -> None:
        require_supported(problem)
        self._problem, self._simulations = problem, simulations
        self._state = np.array([seed], dtype=np.uint64)
        service = problem.limits[0].service
        self._service = np.zeros(problem.size) if service is None else np.asarray(service, dtype=np.float64)
        # Margin for the sum of two legs, per root of their summed squared lengths.
        deviation = math.sqrt(problem.model.cumulants()[0])
        self._spare = deviation * float(np.interp(1.5, *_skewnesses(problem.limits[0].failure_probability)))
        self._factors = problem.model.draw(np.random.default_rng(seed), 20_000)

    def next(self, state: State) -> int:
        """Return the vertex to drive to next."""
        problem = self._problem
        free = (problem.rewards > 0.0).copy()
        free[[*state.visited, state.vertex, problem.start, problem.end]] = False
        near = problem.distances[state.vertex] + problem.distances[:, problem.end] <= state.left[0]
        moves = np.append(np.flatnonzero(free & near), problem.end).astype(np.int64)
        return int(
            _search(
                state.vertex, moves, problem.distances, problem.rewards, self._service, state.left[0],
                self._spare, self._factors, self._simulations, self._state,
            )
        )  # fmt: skip


def _skewnesses(chance: float) -> tuple[Floats, Floats]:
    table = quantile_table(chance)
    return np.linspace(-4.0, 8.0, len(table)), table


@compiled
def _search(
    here: int, moves: Ints, distances: Floats, rewards: Floats, service: Floats, left: float,
    spare: float, factors: Floats, simulations: int, state: Seeds,
) -> int:  # fmt: skip
    count = len(moves)
    end = moves[count - 1]
    scale = 0.0
    for v in moves[: count - 1]:
        scale += rewards[v]
    scale = max(scale, 1e-300)
    # Children of each node, one per move, as node numbers; the root is 0, -1 means none.
    child = np.full((simulations + 2, count), -1, np.int64)
    visits, value = np.zeros(simulations + 2), np.zeros(simulations + 2)
    path = np.empty(count + 2, np.int64)
    safe = np.zeros(count, np.bool_)
    nodes = 1
    for _ in range(simulations):
        taken = np.zeros(count, np.bool_)
        node, at, room, reward, depth = 0, here, left, 0.0, 0
        path[0] = 0
        growing = True
        while at != end:
            _open_moves(at, moves, distances, service, taken, room, spare, safe)
            pick = _pick(child[node], visits, value, safe, visits[node], scale, state) if growing else -1
            if pick < 0:
                pick = _random_move(at, moves, distances, safe, state)
            factor = factors[int(uniform(state) * len(factors))]
            room -= distances[at, moves[pick]] * factor + service[moves[pick]]
            at = moves[pick]
            taken[pick] = True
            if room >= 0.0 and at != end:
                reward += rewards[at]
            if growing:
                if child[node, pick] < 0:
                    child[node, pick] = nodes
                    nodes += 1
                    growing = False
                node = child[node, pick]
                depth += 1
                path[depth] = node
        for i in range(depth + 1):
            visits[path[i]] += 1.0
            if room >= 0.0:
                value[path[i]] += reward
    best, most = count - 1, -1.0
    for i in range(count):
        node = child[0, i]
        if node > 0 and visits[node] > most:
            best, most = i, visits[node]
    return moves[best]  # type: ignore[no-any-return]


@compiled
def _pick(
    child: Ints, visits: Floats, value: Floats, safe: NDArray[np.bool_], total: float, scale: float, state: Seeds
) -> int:
    """Return the move with the highest upper bound; untried moves come first, in random order."""
    best, most = -1, -np.inf
    for i in range(len(child)):
        if not safe[i]:
            continue
        node = child[i]
        if node < 0:
            bound = 1e9 + uniform(state)
        else:
            bound = value[node] / visits[node] / scale + 0.3 * math.sqrt(math.log(total + 1.0) / visits[node])
        if bound > most:
            best, most = i, bound
    return best


@compiled
def _open_moves(
    at: int, moves: Ints, distances: Floats, service: Floats, taken: NDArray[np.bool_], room: float, spare: float,
    safe: NDArray[np.bool_],
) -> None:  # fmt: skip
    """Mark the allowed moves in ``safe``: the end always, a vertex if driving there and on to the end is safe."""
    end = len(moves) - 1
    for i in range(end):
        a, b = distances[at, moves[i]], distances[moves[i], moves[end]]
        work = service[moves[i]] + service[moves[end]]
        safe[i] = not taken[i] and a + b + work + spare * math.sqrt(a * a + b * b) <= room
    safe[end] = True


@compiled
def _random_move(at: int, moves: Ints, distances: Floats, safe: NDArray[np.bool_], state: Seeds) -> int:
    """Return a random allowed move, with a preference for near vertices; the end if there is no other."""
    end = len(moves) - 1
    best, most = end, -1.0
    for i in range(end):
        if safe[i]:
            score = uniform(state) / (distances[at, moves[i]] + 1e-12)
            if score > most:
                best, most = i, score
    return best
