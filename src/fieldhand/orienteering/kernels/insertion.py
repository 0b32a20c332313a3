"""Insertion of the stops that add most value to a visiting order of which a robot may skip stops."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.kernels.compiled import compiled, inner
from fieldhand.orienteering.kernels.legs import Floats, Ints, LegLengths, length, sort_by
from fieldhand.orienteering.kernels.order_value import WORK, backward, forward, gains

#: Number of vertices tried for the first insertion, and for each later one.
CANDIDATES = 24
_AGAIN = 8
#: Number of free vertices from which a candidate is tried only next to its nearest vertices.
_MANY = 400


@inner
def floors_of(route: Ints, service: Floats, budgets: Floats, floors: Floats) -> None:
    """Compute for each position what must be left of the first limit at the end for the others to hold."""
    end = route[len(route) - 1]
    for i in range(len(floors)):
        floors[i] = 0.0
    for limit in range(1, len(budgets)):
        floor = budgets[0] - budgets[limit] + service[limit, end] - service[0, end]
        for i in range(len(route) - 1):
            if i > 0:
                floor += service[limit, route[i]] - service[0, route[i]]
            floors[i] = max(floors[i], floor)


@inner
def _detour(v: int, i: int, route: Ints, lengths: LegLengths) -> float:
    """Return the extra length of the leg to position i if it leads over v."""
    p, q = route[i - 1], route[i]
    return length(lengths, p, v) + length(lengths, v, q) - length(lengths, p, q)


@compiled
def _promising(
    route: Ints,
    free: Ints,
    inside: NDArray[np.bool_],
    lengths: LegLengths,
    near: Ints,
    rewards: Floats,
    service: Floats,
) -> Ints:
    """Return the free vertices outside the route with the highest reward per detour."""
    count = 0
    outside, score = np.empty(len(free), np.int64), np.empty(len(free))
    # With very many free vertices, only positions next to the nearest vertices of each, and the route's ends, are
    # tried.
    position = np.full(len(inside), -1, np.int64)
    if len(free) > _MANY:
        for i in range(len(route)):
            position[route[i]] = i
    for v in free:
        if inside[v]:
            continue
        least = np.inf
        if len(free) > _MANY:
            least = min(_detour(v, 1, route, lengths), _detour(v, len(route) - 1, route, lengths))
            for k in range(near.shape[1]):
                i = position[near[v, k]]
                if i > 0:
                    least = min(least, _detour(v, i, route, lengths))
                if 0 <= i < len(route) - 1:
                    least = min(least, _detour(v, i + 1, route, lengths))
        else:
            came = length(lengths, route[0], v)
            for i in range(1, len(route)):
                goes = length(lengths, route[i], v)
                least = min(least, came + goes - length(lengths, route[i - 1], route[i]))
                came = goes
        outside[count] = v
        score[count] = -rewards[v] / (least + service[v] + 1e-300)
        count += 1
    if count <= CANDIDATES:
        return outside[:count]
    sort_by(score, outside, count)
    return outside[:CANDIDATES]


@compiled
def grow(
    stops: Ints, here: int, free: Ints, longest: int, insertions: int, lengths: LegLengths, near: Ints,
    rewards: Floats, service: Floats, budgets: Floats, ends: Floats, bonus: float, skip: int, points: Floats,
    weights: Floats, order: Ints, figures: Floats,
) -> int:  # fmt: skip
    """Insert the most valuable stops into an order and compute its value.

    Args:
        stops: Initial order, without its ends.
        here: The robot's vertex.
        free: Vertices that may be inserted.
        longest: Maximum number of stops.
        insertions: Maximum number of insertions.
        near: Nearest vertices of each node, nearest first.
        lengths, rewards, service, budgets, ends, bonus, skip, points, weights: As for :func:`backward`; ``service`` and
            ``budgets`` have one row per limit, the tightest limit first.
        order: Overwritten: stops of the order.
        figures: Overwritten: expected further reward (0 for missions that exceed a limit), probability of success, and
            the position of the next stop (0 for the first stop, the number of stops for the end).

    Returns:
        Number of stops of the order.
    """
    end = len(rewards) - 1
    size = len(ends)
    step = budgets[0] / (size - 1)
    capacity = min(longest, len(stops) + insertions) + 2
    worth, success = np.empty((capacity, size)), np.empty((capacity, size))
    ahead, mass = np.empty((capacity, size)), np.empty((capacity, size))
    choice = np.empty((capacity, size), np.int64)
    floors, work, detours = np.empty(capacity), np.empty((WORK, size)), np.empty((2, capacity))
    route = np.empty(capacity, np.int64)
    inside = np.zeros(end + 1, np.bool_)
    count = len(stops)
    route[0] = here
    for i in range(count):
        route[i + 1] = stops[i]
        inside[stops[i]] = True
    route[count + 1] = end
    outside = free if insertions > 0 else free[:0]
    candidates = _promising(route[: count + 2], outside, inside, lengths, near, rewards, service[0])
    gain, place = np.empty(len(candidates)), np.empty(len(candidates), np.int64)
    left = len(candidates)
    for trial in range(insertions + 1):
        n = count + 2
        floors_of(route[:n], service, budgets, floors[:n])
        backward(
            route[:n], lengths, rewards, service[0], ends, floors[:n], bonus, step, skip, points, weights,
            worth[:n], success[:n], ahead[:n], choice[:n], work,
        )  # fmt: skip
        if trial == insertions or n >= capacity or left == 0:
            break
        forward(route[:n], lengths, service[0], step, skip, points, weights, choice[:n], mass[:n], work)
        gains(
            route[:n], lengths, rewards, service[0], ends, floors[:n], bonus, step, points, weights,
            worth[:n], success[:n], ahead[:n], mass[:n], candidates[:left], gain[:left], place[:left],
            work, detours,
        )  # fmt: skip
        most = 0
        for i in range(left):
            if gain[i] > gain[most]:
                most = i
        chosen, at = candidates[most], place[most]
        if gain[most] <= 1e-4 * rewards[chosen]:
            break
        for i in range(count + 1, at, -1):
            route[i + 1] = route[i]
        route[at + 1] = chosen
        count += 1
        # Vertices with little gain now rarely gain more next to another stop.
        for i in range(left):
            gain[i] = -gain[i]
        sort_by(gain, candidates, left)
        left = min(left, _AGAIN + 1)
        at = 0
        for i in range(left):
            if candidates[i] != chosen:
                candidates[at] = candidates[i]
                at += 1
        left = at
    for i in range(count):
        order[i] = route[i + 1]
    figures[0], figures[1] = worth[0, size - 1], success[0, size - 1]
    figures[2] = float(choice[0, size - 1] - 1)
    return count
