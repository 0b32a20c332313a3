"""Local search that shortens a path between two ends: 2-opt, or-opt, and kicks that are undone if they do not help.

All functions are plain Python, which is fast enough for short paths; :func:`for_long_paths` compiles the same functions
for long ones. So both give the same path, and short paths need no compiler.

Sources: Croes 1958 (2-opt); Or 1976 (moving short segments); Bentley 1992 (neighbour lists, don't-look bits); Martin,
Otto and Felten 1991 (a double bridge, then local search again); Park and Miller 1988 (random numbers).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from types import FunctionType
from typing import Any, NamedTuple

#: Sequences of integers: lists in plain Python, arrays in compiled code.
Numbers = Any
Lengths = Any

#: Virtual end vertex of a path with an open end, at distance 0 from every vertex.
ANYWHERE = -1
#: Smallest gain that counts, as a fraction of the initial length; smaller ones may be rounding errors.
_LEAST = 1e-12
_LONGEST_MOVED = 3


class SearchState(NamedTuple):
    """A path under local search. The last entries of ``place`` and ``waiting`` belong to ``ANYWHERE``.

    Attributes:
        path: Vertices from end to end, shape (n,).
        place: Position of each vertex in the path.
        near: The nearest vertices of each vertex, nearest first, as one flat sequence.
        away: Distances of the vertices in ``near``.
        size: Number of neighbours per vertex.
        queue: Ring buffer of the vertices to be examined, shape (n,).
        waiting: 1 for each vertex in the queue, else 0.
        flips: Undo log: first and last position of each reversed segment, as consecutive pairs.
        count: First index and length of the queue, and number of pairs in ``flips``.
    """

    path: Numbers
    place: Numbers
    near: Numbers
    away: Lengths
    size: int
    queue: Numbers
    waiting: Numbers
    flips: Numbers
    count: Numbers


def leg(lengths: Lengths, u: int, v: int) -> float:
    """Return the length of a leg; the last row and column of a table belong to an open end."""
    return lengths[u][v]  # type: ignore[no-any-return]


def neighbours(lengths: Lengths, state: SearchState, vertices: int) -> None:
    """Fill in the nearest vertices of each vertex; the last one is chosen so that clusters stay connected.

    That last one is the nearest vertex to which none of the others in the list is nearer; if there is none, its
    distance is infinite.
    """
    near, away = state.near, state.away
    for v in range(vertices):
        first = last = v * state.size
        beyond = first + state.size - 1
        for u in range(vertices):
            if u == v:
                continue
            far = leg(lengths, v, u)
            if last == beyond:
                if far >= away[last - 1]:
                    continue
                last -= 1
            k = last
            while k > first and away[k - 1] > far:
                away[k], near[k] = away[k - 1], near[k - 1]
                k -= 1
            away[k], near[k] = far, u
            last += 1
        near[beyond], away[beyond] = v, math.inf
        for u in range(vertices):
            far = leg(lengths, v, u)
            if not away[beyond - 1] < far < away[beyond]:
                continue
            for k in range(first, beyond):
                if leg(lengths, near[k], u) < far:
                    break
            else:
                near[beyond], away[beyond] = u, far


def begin(lengths: Lengths, state: SearchState) -> None:
    """Build the initial path by nearest neighbour between its fixed ends."""
    path, place = state.path, state.place
    # The unused vertices are in the path behind the current one.
    for i in range(len(path)):
        place[path[i]] = i
    for i in range(len(path) - 2):
        at, best, least = path[i], -1, 0.0
        for k in range(at * state.size, (at + 1) * state.size):
            if i < place[state.near[k]] < len(path) - 1:
                best = place[state.near[k]]
                break
        if best < 0:
            for j in range(i + 1, len(path) - 1):
                metres = leg(lengths, at, path[j])
                if best < 0 or metres < least:
                    best, least = j, metres
        u, v = path[i + 1], path[best]
        path[i + 1], path[best] = v, u
        place[v], place[u] = i + 1, best


def shorten(lengths: Lengths, state: SearchState, kicks: int, patience: int, reach: int) -> None:
    """Shorten the path by local search, then by repeated kicks and local search; its ends stay fixed.

    Args:
        lengths: Leg lengths.
        state: The path; its queue is empty.
        kicks: Maximum number of kicks.
        patience: Number of consecutive kicks without gain after which the search ends.
        reach: Maximum number of vertices in each of the two segments that a kick swaps.
    """
    path = state.path
    least = 0.0
    for i in range(len(path) - 1):
        least += _LEAST * leg(lengths, path[i], path[i + 1])
    _settle_all(lengths, state, least)
    # A kick needs two segments between the ends.
    inner = len(path) - 2
    reach = min(reach, inner // 2)
    if reach < 1:
        return
    random, fruitless, first = 1, 0, 0
    for _ in range(kicks):
        random = random * 48271 % 2147483647
        one = 1 + random % reach
        random = random * 48271 % 2147483647
        two = 1 + random % reach
        random = random * 48271 % 2147483647
        # Advance along the path, so that a kick touches memory that is still in the cache.
        first = (first + random % reach) % (inner + 1 - one - two)
        state.count[2] = 0
        gain = _kick(lengths, state, first, one, two) + _settle(lengths, state, least, False)
        fruitless += 1
        if gain > least:
            fruitless = 0
        elif gain < -least:
            _take_back(state)
        if fruitless > patience:
            break
    _settle_all(lengths, state, least)


def _look(state: SearchState, v: int) -> None:
    """Add a vertex to the queue unless it is in it."""
    if v >= 0 and state.waiting[v] == 0:
        state.waiting[v] = 1
        state.queue[(state.count[0] + state.count[1]) % len(state.queue)] = v
        state.count[1] += 1


def _next(state: SearchState) -> int:
    """Remove the first vertex from the queue and return it."""
    v = state.queue[state.count[0]]
    state.count[0] = (state.count[0] + 1) % len(state.queue)
    state.count[1] -= 1
    state.waiting[v] = 0
    return v  # type: ignore[no-any-return]


def _settle_all(lengths: Lengths, state: SearchState, least: float) -> None:
    """Apply improving moves until no vertex has one."""
    for v in state.path:
        _look(state, v)
    while state.count[1] > 0:
        state.count[2] = 0
        _settle(lengths, state, least, True)


def _settle(lengths: Lengths, state: SearchState, least: float, every: bool) -> float:
    """Apply improving moves until the queue is empty or the undo log is full; return the total gain."""
    total = 0.0
    while state.count[1] > 0 and 2 * state.count[2] + 6 <= len(state.flips):
        v = _next(state)
        gain = _turn(lengths, state, v, least, every)
        if gain == 0.0:
            gain = _shift(lengths, state, v, least, every)
        total += gain
    return total


def _turn(lengths: Lengths, state: SearchState, a: int, least: float, every: bool) -> float:
    """Apply the first improving 2-opt move of a vertex; return its gain, or 0 if there is none."""
    path, place, near, away, size = state.path, state.place, state.near, state.away, state.size
    # If all near vertices have been tried and a leg is still longer than their distances, every vertex is tried.
    many = size + (len(near) // size if every else 0)
    i = place[a]
    for step in (1, -1):
        if not 0 <= i + step < len(path):
            continue
        b = path[i + step]
        ab = leg(lengths, a, b)
        for k in range(many):
            c = near[a * size + k] if k < size else k - size
            saved = ab - (away[a * size + k] if k < size else leg(lengths, a, c))
            if saved <= least or c == a:
                if k < size - 1:
                    break
                continue
            j = place[c]
            if not 0 <= j + step < len(path):
                continue
            d = path[j + step]
            # Legs a-b and c-d become a-c and b-d.
            gain = saved + leg(lengths, c, d) - leg(lengths, b, d)
            if gain > least:
                low, high = min(i, j), max(i, j)
                if step > 0:
                    _flip(state, low + 1, high)
                else:
                    _flip(state, low, high - 1)
                for v in (a, b, c, d):
                    _look(state, v)
                return gain
    return 0.0


def _shift(lengths: Lengths, state: SearchState, a: int, least: float, every: bool) -> float:
    """Apply the first improving or-opt move of a segment that ends at ``a``; return its gain, or 0 if none."""
    path, place, near, away, size = state.path, state.place, state.near, state.away, state.size
    many = size + (len(near) // size if every else 0)
    i = place[a]
    for extent in range(1 - _LONGEST_MOVED, _LONGEST_MOVED):
        low, high = min(i, i + extent), max(i, i + extent)
        if low < 1 or high > len(path) - 2:
            continue
        # The segment runs from a to z; p is the neighbour of a, and q of z.
        z = path[i + extent]
        p, q = path[low - 1], path[high + 1]
        if extent < 0:
            p, q = q, p
        out = leg(lengths, p, a) + leg(lengths, z, q) - leg(lengths, p, q)
        for k in range(many):
            c = near[a * size + k] if k < size else k - size
            saved = out - (away[a * size + k] if k < size else leg(lengths, a, c))
            if saved <= least:
                if k < size - 1:
                    break
                continue
            j = place[c]
            if low <= j <= high:
                continue
            for step in (1, -1):
                if not 0 <= j + step < len(path) or low <= j + step <= high:
                    continue
                d = path[j + step]
                gain = saved + leg(lengths, c, d) - leg(lengths, z, d)
                if gain > least:
                    # The segment is reversed if the order of a and z changes.
                    _move(state, low, high, min(j, j + step), (extent < 0) == (step > 0))
                    for v in (a, z, p, q, c, d):
                        _look(state, v)
                    return gain
    return 0.0


def _move(state: SearchState, low: int, high: int, behind: int, turned: bool) -> None:
    """Move the segment from ``low`` to ``high`` behind another position, reversed if ``turned``."""
    size = high - low + 1
    if behind > high:
        _flip(state, low, behind)
        _flip(state, low, behind - size)
        low = behind - size + 1
    else:
        _flip(state, behind + 1, high)
        _flip(state, behind + 1 + size, high)
        low = behind + 1
    if not turned:
        _flip(state, low, low + size - 1)


def _kick(lengths: Lengths, state: SearchState, before: int, one: int, two: int) -> float:
    """Swap two adjacent segments of given sizes; return the gain, which is mostly negative."""
    path = state.path
    last = before + one
    a, b, c, d = path[before], path[before + 1], path[last], path[last + 1]
    e, f = path[last + two], path[last + two + 1]
    _move(state, before + 1, last, last + two, False)
    for v in (a, b, c, d, e, f):
        _look(state, v)
    lost = leg(lengths, a, d) + leg(lengths, e, b) + leg(lengths, c, f)
    return leg(lengths, a, b) + leg(lengths, c, d) + leg(lengths, e, f) - lost


def _flip(state: SearchState, i: int, j: int) -> None:
    """Reverse the path from i to j, and log it for :func:`_take_back`."""
    k = state.count[2]
    state.flips[2 * k], state.flips[2 * k + 1] = i, j
    state.count[2] = k + 1
    _turn_round(state.path, state.place, i, j)


def _turn_round(path: Numbers, place: Numbers, i: int, j: int) -> None:
    while i < j:
        a, b = path[i], path[j]
        path[i], path[j] = b, a
        place[b], place[a] = i, j
        i, j = i + 1, j - 1


def _take_back(state: SearchState) -> None:
    """Undo every logged flip, and clear the queue."""
    for k in range(state.count[2] - 1, -1, -1):
        _turn_round(state.path, state.place, state.flips[2 * k], state.flips[2 * k + 1])
    while state.count[1] > 0:
        _next(state)


@cache
def for_long_paths() -> tuple[Callable[..., None], Callable[..., None], Callable[..., None]]:
    """Return :func:`neighbours`, :func:`begin` and :func:`shorten` compiled for arrays."""
    from fieldhand.orienteering.kernels import legs
    from fieldhand.orienteering.kernels.compiled import inner

    def length(lengths: legs.LegLengths, u: int, v: int) -> float:
        return 0.0 if u < 0 or v < 0 else legs.length(lengths, u, v)

    # The same code, with each name in it bound to its compiled counterpart.
    names: dict[str, Any] = {**globals(), "leg": inner(length)}
    for plain in (
        neighbours, begin, _turn_round, _flip, _look, _next, _move, _turn, _shift, _settle, _settle_all, _kick,
        _take_back, shorten,
    ):  # fmt: skip
        names[plain.__name__] = inner(FunctionType(plain.__code__, names, plain.__name__))
    return names["neighbours"], names["begin"], names["shorten"]
