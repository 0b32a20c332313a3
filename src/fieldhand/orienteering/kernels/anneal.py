"""Search for fixed routes: remove strings of stops, reinsert greedily, accept or undo by simulated annealing.

The route is a doubly linked list, so the cost of a move and of its undo is proportional to the stops it changes.
Source: slack induction by string removals (Christiaens and Vanden Berghe 2020), extended by optional stops.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.kernels.compiled import compiled, inner
from fieldhand.orienteering.kernels.legs import (
    Floats,
    Ints,
    LegLengths,
    Seeds,
    copy,
    cost_quantile,
    length,
    sort_by,
    uniform,
)

# Entries of ``sums``: sums of the legs' lengths, of their squares and of their cubes; total reward; number of stops.

#: Probability with which an insertion position is skipped, so that the best one is not always taken ("blinks").
_BLINK = 0.02
#: Number of free vertices above which a search that continues from a route first tries only those near the route.
_FEW = 400


@inner
def excess(sums: Floats, used: Floats, budgets: Floats, cumulants: Floats, quantiles: Floats) -> float:
    """Return the largest excess over any limit; zero or negative if all limits are kept."""
    worst = -np.inf
    for limit in range(len(budgets)):
        over = cost_quantile(sums[0], sums[1], sums[2], cumulants, quantiles[limit]) + used[limit] - budgets[limit]
        worst = max(worst, over)
    return worst


@inner
def link(
    p: int, v: int, after: Ints, before: Ints, sums: Floats, used: Floats, lengths: LegLengths, rewards: Floats,
    service: Floats,
) -> None:  # fmt: skip
    """Insert v into the route after p."""
    q = after[p]
    a, b, c = length(lengths, p, v), length(lengths, v, q), length(lengths, p, q)
    sums[0] += a + b - c
    sums[1] += a * a + b * b - c * c
    sums[2] += a * a * a + b * b * b - c * c * c
    sums[3] += rewards[v]
    sums[4] += 1.0
    for limit in range(len(used)):
        used[limit] += service[limit, v]
    after[p] = v
    before[v] = p
    after[v] = q
    before[q] = v


@inner
def unlink(
    v: int, after: Ints, before: Ints, sums: Floats, used: Floats, lengths: LegLengths, rewards: Floats,
    service: Floats,
) -> None:  # fmt: skip
    """Remove v from the route."""
    p, q = before[v], after[v]
    a, b, c = length(lengths, p, v), length(lengths, v, q), length(lengths, p, q)
    sums[0] -= a + b - c
    sums[1] -= a * a + b * b - c * c
    sums[2] -= a * a * a + b * b * b - c * c * c
    sums[3] -= rewards[v]
    sums[4] -= 1.0
    for limit in range(len(used)):
        used[limit] -= service[limit, v]
    after[p] = q
    before[q] = p
    after[v] = -1
    before[v] = -1


@inner
def begin(
    here: int, stops: Ints, afterwards: Floats, after: Ints, before: Ints, sums: Floats, used: Floats,
    lengths: LegLengths, rewards: Floats, service: Floats, budgets: Floats, cumulants: Floats, quantiles: Floats,
    max_stops: int,
) -> None:  # fmt: skip
    """Lay the route from here over ``stops`` to the end; leave out those worth least while a limit is exceeded, or
    while there are more than ``max_stops``."""
    end = len(rewards) - 1
    for v in range(end + 1):
        after[v] = -1
        before[v] = -1
    after[here] = end
    before[end] = here
    c = length(lengths, here, end)
    sums[0] = c + afterwards[0]
    sums[1] = c * c + afterwards[1]
    sums[2] = c * c * c + afterwards[2]
    sums[3] = 0.0
    sums[4] = 0.0
    for limit in range(len(used)):
        used[limit] = service[limit, end]
    last = here
    for v in stops:
        link(last, v, after, before, sums, used, lengths, rewards, service)
        last = v
    while sums[4] > max_stops or (sums[4] > 0.0 and excess(sums, used, budgets, cumulants, quantiles) > 0.0):
        worst, least = -1, np.inf
        v = after[here]
        while v != end:
            p, q = before[v], after[v]
            detour = length(lengths, p, v) + length(lengths, v, q) - length(lengths, p, q)
            for limit in range(len(used)):
                detour += service[limit, v]
            if detour > 0.0 and rewards[v] / detour < least:
                worst, least = v, rewards[v] / detour
            v = q
        if worst < 0 and sums[4] > max_stops:
            worst = before[end]
        if worst < 0:
            break
        unlink(worst, after, before, sums, used, lengths, rewards, service)


@inner
def _best_place(
    v: int, here: int, end: int, after: Ints, before: Ints, near: Ints, lengths: LegLengths, blink: float,
    state: Seeds,
) -> int:  # fmt: skip
    """Return the node after which v lengthens the route least, among those near v and the route's ends."""
    best, place = np.inf, -1
    for i in range(-2, near.shape[1]):
        u = here if i == -2 else (before[end] if i == -1 else near[v, i])
        if u != here and after[u] < 0:
            continue
        there = length(lengths, u, v)
        for side in range(2):
            if side == 1 and u == here:
                continue
            if blink > 0.0 and uniform(state) < blink:
                continue
            p = u if side == 0 else before[u]
            if side == 0:
                more = there + length(lengths, v, after[u]) - length(lengths, u, after[u])
            else:
                more = length(lengths, p, v) + there - length(lengths, p, u)
            if more < best:
                best, place = more, p
    return place


@inner
def _beside(v: int, after: Ints, near: Ints) -> bool:
    """Return True if the route leads over one of the nearest vertices of v."""
    for i in range(near.shape[1]):  # noqa: SIM110  compiled as it stands
        if after[near[v, i]] >= 0:
            return True
    return False


@inner
def _take_out(
    seed: int, here: int, turn: int, allowed: NDArray[np.bool_], seen: Ints, moves: Ints, after: Ints, before: Ints,
    sums: Floats, used: Floats, lengths: LegLengths, near: Ints, rewards: Floats, service: Floats, state: Seeds,
) -> int:  # fmt: skip
    """Remove one or two strings of stops near ``seed``; record them in ``moves`` and return their number."""
    end = len(rewards) - 1
    steps = 0
    strings = 1 + int(uniform(state) * 2.0)
    longest = min(10.0, 0.5 * sums[4] + 1.0)
    for i in range(-1, near.shape[1]):
        if strings == 0:
            break
        u = seed if i < 0 else near[seed, i]
        if not allowed[u] or after[u] < 0 or seen[u] == turn:
            continue
        strings -= 1
        size = 1 + int(uniform(state) * longest)
        for _ in range(int(uniform(state) * size)):
            if before[u] == here:
                break
            u = before[u]
        for _ in range(size):
            if u == end:
                break
            q = after[u]
            moves[steps, 0], moves[steps, 1], moves[steps, 2] = u, before[u], 0
            steps += 1
            unlink(u, after, before, sums, used, lengths, rewards, service)
            seen[u] = turn
            u = q
    return steps


@inner
def _rank(out: Ints, key: Floats, count: int, seed: int, lengths: LegLengths, rewards: Floats, state: Seeds) -> None:
    """Sort the stops to be inserted: at random, by reward, by reward with noise, or by distance from ``seed``."""
    rule = int(uniform(state) * 4.0)
    for i in range(count):
        v = out[i]
        if rule == 0:
            key[i] = uniform(state)
        elif rule == 1:
            key[i] = -rewards[v]
        elif rule == 2:
            key[i] = -rewards[v] * (0.3 + uniform(state))
        else:
            key[i] = length(lengths, v, seed)
    sort_by(key, out, count)


@inner
def _drop(v: int, p: int, after: Ints, before: Ints) -> None:
    """Unlink v, which follows p; the caller updates the sums."""
    q = after[v]
    after[p] = q
    before[q] = p
    after[v] = -1
    before[v] = -1


@inner
def _undo(moves: Ints, steps: int, after: Ints, before: Ints) -> None:
    """Undo the moves, the last one first."""
    for i in range(steps - 1, -1, -1):
        v, p = moves[i, 0], moves[i, 1]
        if moves[i, 2] == 1:
            _drop(v, p, after, before)
        else:
            q = after[p]
            after[p] = v
            before[v] = p
            after[v] = q
            before[q] = v


@compiled
def anneal(
    here: int, free: Ints, after: Ints, before: Ints, sums: Floats, used: Floats,
    lengths: LegLengths, near: Ints, rewards: Floats, service: Floats, budgets: Floats, cumulants: Floats,
    quantiles: Floats, max_stops: int, worth: float, hot: float, cold: float, rounds: int, state: Seeds, best: Ints,
    record: Floats,
) -> int:  # fmt: skip
    """Improve the route in ``after`` and ``before`` by a number of rounds of simulated annealing.

    Args:
        here: First vertex of the route.
        free: Vertices that may be visited; each of them not in the route has -1 in ``after``.
        after, before, sums, used: The route and its sums, changed in place.
        lengths, near: Leg lengths, and the nearest vertices of each node, nearest first.
        rewards, service, budgets: ``service`` has limits along its first axis.
        cumulants, quantiles: For :func:`cost_quantile`; ``quantiles`` has limits along its first axis.
        max_stops: Maximum number of stops.
        worth: Penalty per unit of length, as a fraction of the best reward.
        hot, cold: Temperature of the first and of the last round, in units of reward.
        state: State of the random generator.
        best, record: Overwritten: stops of the best route, and its reward and length; results of earlier calls are kept
            if better.

    Returns:
        Number of stops in ``best``.
    """
    end = len(rewards) - 1
    allowed, seen = np.zeros(end + 1, np.bool_), np.zeros(end + 1, np.int64)
    for v in free:
        allowed[v] = True
    out, key, moves = np.empty(end + 1, np.int64), np.empty(end + 1), np.empty((2 * end + 4, 3), np.int64)
    old_sums, old_used = np.empty(len(sums)), np.empty(len(used))
    one_sums, one_used = np.empty(len(sums)), np.empty(len(used))
    found = int(record[2])
    for turn in range(rounds + 1):
        copy(sums, old_sums)
        copy(used, old_used)
        seed = free[int(uniform(state) * len(free))]
        steps, count = 0, 0
        if turn == 0:
            everywhere = sums[4] == 0.0 or len(free) <= _FEW
            for v in free:
                if after[v] < 0 and (everywhere or _beside(v, after, near)):
                    out[count] = v
                    count += 1
        else:
            if sums[4] > 0.0:
                steps = _take_out(
                    seed, here, turn, allowed, seen, moves, after, before, sums, used, lengths, near, rewards,
                    service, state,
                )  # fmt: skip
            for i in range(steps):
                out[i] = moves[i, 0]
            count = steps
            for i in range(-1, near.shape[1]):
                u = seed if i < 0 else near[seed, i]
                if allowed[u] and after[u] < 0 and seen[u] != turn:
                    seen[u] = turn
                    out[count] = u
                    count += 1
        _rank(out, key, count, seed, lengths, rewards, state)
        over = excess(sums, used, budgets, cumulants, quantiles)
        for i in range(count):
            if sums[4] >= max_stops:
                break
            v = out[i]
            p = _best_place(v, here, end, after, before, near, lengths, _BLINK, state)
            if p < 0:
                continue
            copy(sums, one_sums)
            copy(used, one_used)
            link(p, v, after, before, sums, used, lengths, rewards, service)
            now = excess(sums, used, budgets, cumulants, quantiles)
            if now <= 0.0 or now < over:
                moves[steps, 0], moves[steps, 1], moves[steps, 2] = v, p, 1
                steps += 1
                over = now
            else:
                _drop(v, p, after, before)
                copy(one_sums, sums)
                copy(one_used, used)
        heat = hot * (cold / hot) ** (turn / max(rounds, 1))
        gain = sums[3] - old_sums[3] - worth * max(record[0], 0.0) * (sums[0] - old_sums[0])
        if turn > 0 and gain <= heat * math.log(uniform(state) + 1e-300):
            _undo(moves, steps, after, before)
            copy(old_sums, sums)
            copy(old_used, used)
            continue
        better = sums[3] > record[0] + 1e-12 or (sums[3] > record[0] - 1e-12 and sums[0] < record[1])
        if better and over <= 0.0:
            record[0], record[1] = sums[3], sums[0]
            found = 0
            u = after[here]
            while u != end:
                best[found] = u
                found += 1
                u = after[u]
            record[2] = found
    return found
