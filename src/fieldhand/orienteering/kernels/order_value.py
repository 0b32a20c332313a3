"""The value of a visiting order for a robot that may skip stops: a dynamic programme over the amount left.

At every stop and for every amount left (a grid) the robot drives on to one of the next few stops or straight to the
end, whichever has the highest value. ``worth`` is the expected further reward, with 0 for missions that exceed a limit;
``success`` is the probability that no limit is exceeded, and each success counts ``bonus`` in addition. Both are linear
between grid points and 0 below the grid.
"""

from __future__ import annotations

import math

import numpy as np

from fieldhand.orienteering.kernels.compiled import inner
from fieldhand.orienteering.kernels.legs import Floats, Ints, LegLengths, copy, length

#: Number of rows of working memory.
WORK = 7
#: Number of positions at which a candidate is tried; positions that missions reach with a lower probability than the
#: second value are not tried.
_PLACES = 5
_RARE = 1e-3


@inner
def drive(
    worth: Floats,
    success: Floats,
    to_worth: Floats,
    to_success: Floats,
    leg: float,
    service: float,
    step: float,
    points: Floats,
    weights: Floats,
) -> None:
    """Compute the expectations before a leg and the service at its end from those after them.

    Args:
        worth, success: Expectations after them, by amount left.
        to_worth, to_success: Overwritten: expectations before them, by amount left.
        leg, service: Length of the leg, and amount used by the work at its end.
        step: Distance between grid points.
        points, weights: Possible costs of a leg of length 1, and their probabilities. If ``weights`` is empty, the cost
            is ``points[0]`` plus an exponential part with mean ``points[1]``.
    """
    size = len(worth)
    for k in range(size):
        to_worth[k] = 0.0
        to_success[k] = 0.0
    if len(weights) > 0:
        for i in range(len(points)):
            _shift(worth, success, to_worth, to_success, (service + leg * points[i]) / step, weights[i])
        return
    scale = leg * points[1]
    at = (service + leg * points[0]) / step
    if scale <= 1e-9 * step:
        _shift(worth, success, to_worth, to_success, at, 1.0)
        return
    if at >= size:
        return
    # Exact for a function that is linear between grid points: integrate over whole cells, then over the partial cell
    # that ends at the deterministic cost of the leg.
    whole = math.ceil(at)
    stay, earlier, later = cell(1.0, scale / step)
    last_stay, last_earlier, last_later = cell(whole - at, scale / step)
    mean_worth, mean_success = 0.0, 0.0
    low_worth, low_success = worth[0], success[0]
    high_worth, high_success = worth[min(1, size - 1)], success[min(1, size - 1)]
    # With only ``whole`` left, the amount after the leg lies below the second grid point.
    if whole < size:
        to_worth[whole] = last_earlier * low_worth + last_later * high_worth
        to_success[whole] = last_earlier * low_success + last_later * high_success
    for k in range(1, size - whole):
        mean_worth = stay * mean_worth + (earlier * low_worth + later * high_worth)
        mean_success = stay * mean_success + (earlier * low_success + later * high_success)
        low_worth, low_success = high_worth, high_success
        high_worth, high_success = worth[min(k + 1, size - 1)], success[min(k + 1, size - 1)]
        to_worth[k + whole] = last_stay * mean_worth + (last_earlier * low_worth + last_later * high_worth)
        to_success[k + whole] = last_stay * mean_success + (last_earlier * low_success + last_later * high_success)


@inner
def cell(width: float, mean: float) -> tuple[float, float, float]:
    """Return the factors of the expectation over an exponential cost, ``width`` cells above a grid point.

    Returns:
        Factors of the expectation at the grid point below, of the function there, and of the function at the next
        point.
    """
    if width <= 0.0:
        return 1.0, 0.0, 0.0
    stay = math.exp(-width / mean)
    later = width - mean * (1.0 - stay)
    return stay, 1.0 - stay - later, later


@inner
def _shift(worth: Floats, success: Floats, to_worth: Floats, to_success: Floats, at: float, weight: float) -> None:
    size = len(worth)
    if at >= size:
        return
    whole = int(at)
    part = at - whole
    if part > 0.0:
        for k in range(whole + 1, size):
            to_worth[k] += weight * ((1.0 - part) * worth[k - whole] + part * worth[k - whole - 1])
            to_success[k] += weight * ((1.0 - part) * success[k - whole] + part * success[k - whole - 1])
    else:
        for k in range(whole, size):
            to_worth[k] += weight * worth[k - whole]
            to_success[k] += weight * success[k - whole]


@inner
def gather(
    mass: Floats, choice: Ints, chosen: int, into: Floats, leg: float, service: float, step: float, points: Floats,
    weights: Floats, work: Floats,
) -> None:  # fmt: skip
    """Propagate probability mass over a leg: the transpose of :func:`drive`."""
    size = len(mass)
    if len(weights) > 0:
        for i in range(len(points)):
            at = (service + leg * points[i]) / step
            if at < size:
                whole = int(at)
                part = at - whole
                for k in range(whole + (1 if part > 0.0 else 0), size):
                    if choice[k] == chosen:
                        into[k - whole] += weights[i] * (1.0 - part) * mass[k]
                        if part > 0.0:
                            into[k - whole - 1] += weights[i] * part * mass[k]
        return
    scale = leg * points[1]
    at = (service + leg * points[0]) / step
    if at >= size:
        return
    for k in range(size):
        work[k] = 0.0
    if scale <= 1e-9 * step:
        whole = int(at)
        part = at - whole
        for k in range(whole + (1 if part > 0.0 else 0), size):
            if choice[k] == chosen:
                into[k - whole] += (1.0 - part) * mass[k]
                if part > 0.0:
                    into[k - whole - 1] += part * mass[k]
        return
    whole = math.ceil(at)
    stay, earlier, later = cell(1.0, scale / step)
    last_stay, last_earlier, last_later = cell(whole - at, scale / step)
    for k in range(whole, size):
        if choice[k] == chosen:
            work[k - whole] += last_stay * mass[k]
            into[k - whole] += last_earlier * mass[k]
            into[min(k - whole + 1, size - 1)] += last_later * mass[k]
    coming = 0.0
    for k in range(size - 1, 0, -1):
        here = work[k] + stay * coming
        into[k] += later * here + earlier * coming
        coming = here
    into[0] += earlier * coming


@inner
def home(success: Floats, to_success: Floats, floor: float, step: float) -> None:
    """Compute the probability of success by amount left at the end, if the other limits require at least ``floor``."""
    size = len(success)
    at = floor / step
    whole = int(at)
    part = at - whole
    for k in range(size):
        if k <= whole:
            to_success[k] = success[0] if part <= 0.0 and k == whole else 0.0
        else:
            to_success[k] = (1.0 - part) * success[k - whole] + part * success[k - whole - 1]


@inner
def backward(
    route: Ints, lengths: LegLengths, rewards: Floats, service: Floats, ends: Floats, floors: Floats,
    bonus: float, step: float, skip: int, points: Floats, weights: Floats,
    worth: Floats, success: Floats, ahead: Floats, choice: Ints, work: Floats,
) -> None:  # fmt: skip
    """Compute the dynamic programme from the end of ``route`` to its beginning.

    Args:
        route: Nodes from the current vertex to the end, both included.
        lengths: Leg lengths, as for :func:`length`.
        rewards: Reward of each vertex.
        service: Service cost of each vertex in the first limit.
        ends: Probability, by amount left at the end, that the legs after it keep to the limit.
        floors: For each position the amount of the first limit that must be left when driving to the end from there, so
            that the other limits hold; 0 if there is only one limit.
        bonus: Value of success in addition to further rewards.
        step: Distance between grid points; the last point is the current amount left.
        skip: Number of stops ahead among which the next is chosen.
        points, weights: Cost distribution of a leg, as for :func:`drive`.
        worth, success: Overwritten, shape (positions, points of the grid).
        ahead: Overwritten: ``worth`` with the reward of the position itself.
        choice: Overwritten: the next position.
        work: Overwritten, shape (:data:`WORK`, points of the grid).
    """
    last = len(route) - 1
    size = worth.shape[1]
    to_worth, to_success, arrived = work[0], work[1], work[2]
    for k in range(size):
        worth[last, k] = 0.0
        ahead[last, k] = 0.0
        success[last, k] = ends[k]
    collected = bonus
    for i in range(1, last):
        collected += rewards[route[i]]
    for i in range(last - 1, -1, -1):
        leg = length(lengths, route[i], route[last])
        home(ends, arrived, floors[i], step)
        drive(worth[last], arrived, worth[i], success[i], leg, service[route[last]], step, points, weights)
        for k in range(size):
            choice[i, k] = last
        reward = rewards[route[i]] if i > 0 else 0.0
        for j in range(i + 1, min(i + skip, last - 1) + 1):
            leg = length(lengths, route[i], route[j])
            drive(ahead[j], success[j], to_worth, to_success, leg, service[route[j]], step, points, weights)
            for k in range(size):
                if to_worth[k] + collected * to_success[k] > worth[i, k] + collected * success[i, k]:
                    worth[i, k] = to_worth[k]
                    success[i, k] = to_success[k]
                    choice[i, k] = j
        for k in range(size):
            ahead[i, k] = worth[i, k] + reward * success[i, k]
        collected -= reward


@inner
def forward(
    route: Ints, lengths: LegLengths, service: Floats, step: float, skip: int, points: Floats, weights: Floats,
    choice: Ints, mass: Floats, work: Floats,
) -> None:  # fmt: skip
    """Compute ``mass``: the probability of reaching each position with each amount left. ``work`` is overwritten."""
    last = len(route) - 1
    size = mass.shape[1]
    for i in range(last + 1):
        for k in range(size):
            mass[i, k] = 0.0
    mass[0, size - 1] = 1.0
    for i in range(last):
        for to in range(i + 1, min(i + skip, last - 1) + 2):
            j = to if to <= min(i + skip, last - 1) else last
            going = 0.0
            for k in range(size):
                if choice[i, k] == j:
                    going += mass[i, k]
            if going > 1e-12:
                leg = length(lengths, route[i], route[j])
                gather(mass[i], choice[i], j, mass[j], leg, service[route[j]], step, points, weights, work[0])


@inner
def _tried(v: int, route: Ints, lengths: LegLengths, coming: Floats, detour: Floats) -> float:
    """Compute the detour over v after each position; return the longest one that is tried."""
    last = len(route) - 1
    came = length(lengths, route[0], v)
    for i in range(last):
        goes = length(lengths, v, route[i + 1])
        detour[i] = came + goes - length(lengths, route[i], route[i + 1]) if coming[i] >= _RARE else np.inf
        came = goes
    longest = -np.inf
    for _ in range(_PLACES):
        least = np.inf
        for i in range(last):
            if longest < detour[i] < least:
                least = detour[i]
        if least == np.inf:
            break
        longest = least
    return longest


@inner
def gains(
    route: Ints, lengths: LegLengths, rewards: Floats, service: Floats, ends: Floats, floors: Floats,
    bonus: float, step: float, points: Floats, weights: Floats,
    worth: Floats, success: Floats, ahead: Floats, mass: Floats, candidates: Ints, gain: Floats, place: Ints,
    work: Floats, detours: Floats,
) -> None:  # fmt: skip
    """Compute for each candidate the gain of inserting it at its best position.

    From the candidate the robot drives on to the next position or to the end. Only the positions with the shortest
    detours are tried. ``work`` is overwritten, shape (:data:`WORK`, points of the grid), and so is ``detours``, shape
    (2, positions).
    """
    last = len(route) - 1
    size = worth.shape[1]
    then_worth, then_success, to_worth, to_success = work[0], work[1], work[2], work[3]
    arrived, home_worth, home_success = work[4], work[5], work[6]
    coming, detour = detours[0], detours[1]
    for i in range(last):
        coming[i] = 0.0
        for k in range(size):
            coming[i] += mass[i, k]
    for c in range(len(candidates)):
        v = candidates[c]
        gain[c] = 0.0
        place[c] = 0
        leg_home = length(lengths, v, route[last])
        longest = _tried(v, route, lengths, coming, detour)
        floor = -1.0
        here = bonus
        for i in range(last):
            here += rewards[route[i]] if i > 0 else 0.0
            if detour[i] > longest:
                continue
            value = here + rewards[v]
            if floors[i] != floor:
                floor = floors[i]
                takes = service[route[last]]
                home(ends, arrived, floor, step)
                drive(worth[last], arrived, home_worth, home_success, leg_home, takes, step, points, weights)
            copy(home_worth, then_worth)
            copy(home_success, then_success)
            if i + 1 < last:
                leg = length(lengths, v, route[i + 1])
                takes = service[route[i + 1]]
                drive(ahead[i + 1], success[i + 1], to_worth, to_success, leg, takes, step, points, weights)
                for k in range(size):
                    if to_worth[k] + value * to_success[k] > then_worth[k] + value * then_success[k]:
                        then_worth[k] = to_worth[k]
                        then_success[k] = to_success[k]
            for k in range(size):
                then_worth[k] += rewards[v] * then_success[k]
            leg = length(lengths, route[i], v)
            drive(then_worth, then_success, to_worth, to_success, leg, service[v], step, points, weights)
            found = 0.0
            for k in range(size):
                more = to_worth[k] - worth[i, k] + here * (to_success[k] - success[i, k])
                if more > 0.0:
                    found += more * mass[i, k]
            if found > gain[c]:
                gain[c] = found
                place[c] = i
