"""The order and directions in which stretches are driven, with short drives between them."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.working.stretch import Stretch
from fieldhand.site.working.units import WorkUnit

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

XY = tuple[float, float]
Floats = NDArray[np.float64]

#: Largest number of end points whose distances are those of drives; beyond it, of straight lines.
_MOST_POINTS = 400

#: Cost of a drive between places that no way connects, in metres.
_NO_WAY_M = 1e7


def in_order(
    drives: Drives, units: Sequence[WorkUnit], here: XY, home: XY | None, *, given: bool
) -> tuple[Stretch, ...]:
    """Return one way of doing each unit, in an order and in directions with short drives in between.

    Args:
        drives: Drives of the robot.
        units: The units.
        here: The robot's position.
        home: Where it drives afterwards; None if unknown.
        given: True to keep the order of the units and choose only ways and directions.
    """
    if not units:
        return ()
    problem = _Order(drives, units, here, home)
    count = len(units)
    sequences = [list(range(count))]
    if not given:
        sequences += [sequences[0][::-1], problem.nearest()]
    best = min((problem.ways(sequence) for sequence in sequences), key=lambda found: found[0])
    return tuple(stretch for variant in best[1] for stretch in problem.variants[variant])


class _Order:
    """Units with all their variants, and the drives between these."""

    def __init__(self, drives: Drives, units: Sequence[WorkUnit], here: XY, home: XY | None) -> None:
        self.variants: list[tuple[Stretch, ...]] = []
        self.of_unit: list[list[int]] = []
        for unit in units:
            numbers = []
            for option in unit.options:
                for variant in _directions(option):
                    numbers.append(len(self.variants))
                    self.variants.append(variant)
            self.of_unit.append(numbers)
        begins, ends = [v[0].begin for v in self.variants], [v[-1].end for v in self.variants]
        points = list(dict.fromkeys([here, *([] if home is None else [home]), *begins, *ends]))
        number = {xy: k for k, xy in enumerate(points)}
        lengths = _lengths(drives, points)
        begin, end = [number[xy] for xy in begins], [number[xy] for xy in ends]
        #: Metres driven between the stretches of each variant.
        self.inner = np.array([_inner(variant) for variant in self.variants])
        self.first = lengths[number[here], begin]
        self.between = lengths[np.ix_(end, begin)]
        self.last = np.zeros(len(end)) if home is None else lengths[end, number[home]]

    def nearest(self) -> list[int]:
        """Return the units by nearest neighbour."""
        left, sequence = set(range(len(self.of_unit))), []
        to = self.first
        while left:
            variants = [v for unit in sorted(left) for v in self.of_unit[unit]]
            best = min(variants, key=lambda v: float(to[v] + self.inner[v]))
            unit = next(u for u in left if best in self.of_unit[u])
            sequence.append(unit)
            left.remove(unit)
            to = self.between[best]
        return sequence

    def ways(self, sequence: Sequence[int]) -> tuple[float, list[int]]:
        """Return the metres between the stretches, and the best variant of each unit in a sequence."""
        cost: dict[int, tuple[float, int | None]] = {
            v: (float(self.first[v] + self.inner[v]), None) for v in self.of_unit[sequence[0]]
        }
        steps = [cost]
        for unit in sequence[1:]:
            following: dict[int, tuple[float, int | None]] = {}
            for v in self.of_unit[unit]:
                before = min(cost, key=lambda w: cost[w][0] + float(self.between[w, v]))
                following[v] = (cost[before][0] + float(self.between[before, v] + self.inner[v]), before)
            cost = following
            steps.append(cost)
        last = min(cost, key=lambda v: cost[v][0] + float(self.last[v]))
        total = cost[last][0] + float(self.last[last])
        chosen: list[int] = []
        at: int | None = last
        for step in reversed(steps):
            assert at is not None  # noqa: S101  every step but the first has a predecessor
            chosen.append(at)
            at = step[at][1]
        return total, chosen[::-1]


def _directions(option: tuple[Stretch, ...]) -> list[tuple[Stretch, ...]]:
    if any(stretch.one_way for stretch in option):
        return [option]
    return [option, tuple(stretch.reversed() for stretch in reversed(option))]


def _lengths(drives: Drives, points: Sequence[XY]) -> Floats:
    if len(points) <= _MOST_POINTS:
        lengths = np.asarray(drives.point_lengths(points), dtype=np.float64)
        return np.where(np.isfinite(lengths), lengths, _NO_WAY_M)
    at = np.array(points)
    return np.asarray(np.hypot(*(at[:, None, :] - at[None, :, :]).transpose(2, 0, 1)))


def _inner(variant: tuple[Stretch, ...]) -> float:
    """Return the metres between the stretches of a variant; straight lines, as only few are in several pieces."""
    return sum(math.dist(a.end, b.begin) for a, b in itertools.pairwise(variant))
