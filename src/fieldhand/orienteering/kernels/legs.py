"""Basic functions of all compiled loops: leg length, random number, cost quantile, sorting."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.kernels.compiled import inner

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Seeds = NDArray[np.uint64]


class LegLengths(NamedTuple):
    """Lengths of the legs between any two nodes.

    Attributes:
        matrix: Lengths, shape (nodes, nodes); empty if given by ``xy`` or ``table``.
        xy: Coordinates, shape (nodes, 2); empty unless legs are straight lines.
        table: Lengths in single precision, shape (nodes - 1, nodes - 1), if neither ``matrix`` nor ``xy`` is given.
        end: Row and column of the last node in ``table``.
    """

    matrix: Floats
    xy: Floats
    table: NDArray[np.float32]
    end: int


#: Skewness at the first entry of a table of quantiles, and entries per unit of skewness.
TABLE_FROM = -4.0
TABLE_PER_UNIT = 16.0


@inner
def uniform(state: Seeds) -> float:
    """Return the next random number in [0, 1) (splitmix64, Steele et al. 2014); ``state`` is one word."""
    z = state[0] + np.uint64(0x9E3779B97F4A7C15)
    state[0] = z
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    z = z ^ (z >> np.uint64(31))
    return float(z >> np.uint64(11)) * (1.0 / 9007199254740992.0)


@inner
def length(lengths: LegLengths, u: int, v: int) -> float:
    """Return the length of the leg from u to v: an entry of the matrix or the table, or the straight line."""
    if lengths.matrix.shape[0] > 0:
        return lengths.matrix[u, v]  # type: ignore[no-any-return]
    if lengths.xy.shape[0] > 0:
        x, y = lengths.xy[u, 0] - lengths.xy[v, 0], lengths.xy[u, 1] - lengths.xy[v, 1]
        return math.sqrt(x * x + y * y)
    last = lengths.table.shape[0]
    return float(lengths.table[lengths.end if u == last else u, lengths.end if v == last else v])


@inner
def cost_quantile(first: float, second: float, third: float, cumulants: Floats, quantiles: Floats) -> float:
    """Return the cost that legs exceed with a given probability (Pearson III distribution with three given cumulants).

    Args:
        first, second, third: Sums of the legs' lengths, of their squares and of their cubes.
        cumulants: Second and third cumulant of the cost of a leg of length 1.
        quantiles: Standardised quantiles at that probability, by skewness.
    """
    variance = cumulants[0] * second
    if variance <= 0.0:
        return first
    deviation = math.sqrt(variance)
    skewness = cumulants[1] * third / (variance * deviation)
    at = min(max((skewness - TABLE_FROM) * TABLE_PER_UNIT, 0.0), len(quantiles) - 1.001)
    entry = int(at)
    part = at - entry
    return first + deviation * (quantiles[entry] * (1.0 - part) + quantiles[entry + 1] * part)  # type: ignore[no-any-return]


@inner
def copy(values: Floats, to: Floats) -> None:
    """Copy values into ``to``. A loop, because assigning slices takes a second longer to compile."""
    for i in range(len(values)):
        to[i] = values[i]


@inner
def sort_by(key: Floats, values: Ints, count: int) -> None:
    """Sort the first ``count`` keys and their values (Shell 1959). numpy's sort takes seconds to compile."""
    gap = count // 2
    while gap > 0:
        for i in range(gap, count):
            k, v = key[i], values[i]
            j = i
            while j >= gap and key[j - gap] > k:
                key[j], values[j] = key[j - gap], values[j - gap]
                j -= gap
            key[j], values[j] = k, v
        gap //= 2
