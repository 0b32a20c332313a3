"""Insert stops into a visiting order where a robot that may skip stops gains most."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.kernels.compiled import compiled, inner
from fieldhand.orienteering.kernels.legs import Floats, Ints, LegLengths, length, sort_by
from fieldhand.orienteering.kernels.order_value import WORK, backward, forward, gains

#: Vertices that are tried for the first insertion, and for those after it.
CANDIDATES = 24
_AGAIN = 8
#: Free vertices from which on a candidate is only looked at beside its nearest.
_MANY = 400


@inner
def floors_of(route: Ints, service: Floats, budgets: Floats, floors: Floats) -> None:
    """Compute, per position, what the other limits require to be left of the first limit at the end."""
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
    """Return what the way over v adds to the leg that leads to position i."""
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
    # Where very many are free, only places beside the nearest vertices of each are looked at, and the route's ends.
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
        stops: The order to begin with, without its ends.
        here: The robot's vertex.
        free: Vertices that may be inserted.
        longest: Stops that the order may have.
        insertions: Maximum number of insertions.
        near: Nearest vertices of each.
        lengths, rewards, service, budgets, ends, bonus, skip, points, weights: As for :func:`backward`; ``service``
            and ``budgets`` of every limit, the one with the least budget first.
        order: Overwritten: the order's stops.
        figures: Overwritten: reward still to come of missions that keep to the limits, chance that they do, and the
            position driven to first (0 for the first stop, the number of stops for the end).

    Returns:
        How many stops the order has.
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
        # What gains little now gains no more beside another stop, as a rule.
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
