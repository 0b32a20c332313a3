"""The chance that the legs of a route cost more than is left.

The sum of legs ``d_i * (alpha + X_i)`` is a fixed part ``alpha * sum(d_i)`` and a sum of exponentials with means
``(1 - alpha) * d_i``. That sum is taken as the gamma distribution with the same mean and variance: exact for legs of
equal length (Erlang) and for a single leg, and checked against sampling in the tests for the others.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import gammainc, gammaincc, gammainccinv, gammaincinv, ndtr, ndtri

Floats = NDArray[np.float64]

_SYMMETRIC = 1e-3


def chance_over(length: ArrayLike, squares: ArrayLike, left: ArrayLike, alpha: float) -> Floats:
    """P(cost of the legs > ``left``), elementwise.

    Args:
        length: Sum of the legs' lengths.
        squares: Sum of the legs' squared lengths.
        left: What the legs may cost together; below 0 the answer is 1.
        alpha: The certain part of a leg's cost, 0 to 1.
    """
    total, square = np.asarray(length, dtype=np.float64), np.asarray(squares, dtype=np.float64)
    room = np.asarray(left, dtype=np.float64)
    over = room - alpha * total
    certain = (over < -1e-9 * (1.0 + np.abs(room))).astype(np.float64)
    random = (1.0 - alpha) * total
    moving = (random > 0.0) & (square > 0.0) & np.isfinite(total)
    if not moving.any():
        return np.where(np.isfinite(total), certain, 1.0)
    safe_total = np.where(moving, total, 1.0)
    safe_square = np.where(moving, square, 1.0)
    shape = safe_total**2 / safe_square
    scale = (1.0 - alpha) * safe_square / safe_total if alpha < 1.0 else np.ones_like(safe_total)
    tail = gammaincc(shape, np.maximum(over, 0.0) / scale)
    return np.where(moving, np.where(over < 0.0, 1.0, tail), np.where(np.isfinite(total), certain, 1.0))


def leg_costs(length: float, alpha: float, count: int) -> Floats:
    """Equally likely costs of one leg: the middles of ``count`` slices of its distribution, ascending."""
    middles = (np.arange(count) + 0.5) / count
    return length * (alpha - (1.0 - alpha) * np.log1p(-middles))


def exceeding(mean: ArrayLike, variance: ArrayLike, third: ArrayLike, left: ArrayLike) -> Floats:
    """P(cost > ``left``) of a sum whose first three cumulants are known, elementwise: the Pearson III through them.

    Exact for equal exponential or gamma legs, and for certain ones. docs/orienteering.md has its error for others.

    Args:
        mean, variance, third: Cumulants of the sum: mean, variance, third central moment.
        left: What it may be; below 0 the answer is 1.
    """
    m, v, t, x = np.broadcast_arrays(*(np.asarray(a, dtype=np.float64) for a in (mean, variance, third, left)))
    certain = (x - m < -1e-9 * (1.0 + np.abs(x))).astype(np.float64)
    moving = (v > 0.0) & np.isfinite(m)
    deviation = np.sqrt(np.where(moving, v, 1.0))
    z = np.where(moving, (x - m) / deviation, 0.0)
    skewness = np.where(moving, t, 0.0) / deviation**3
    skewed = np.abs(skewness) > _SYMMETRIC
    safe = np.where(skewed, skewness, 1.0)
    shape = 4.0 / safe**2
    at = np.maximum(shape + 2.0 * z / safe, 0.0)
    tail = np.where(safe > 0.0, gammaincc(shape, at), gammainc(shape, at))
    tail = np.where(skewed, tail, ndtr(-z))
    return np.where(np.isfinite(m), np.where(moving, np.where(x < 0.0, 1.0, tail), certain), 1.0)


def quantile_table(chance: float) -> Floats:
    """What a Pearson III variable with mean 0 and variance 1 exceeds with this chance, by skewness from -4 to 8."""
    skewness = np.arange(-4.0, 8.0 + 1e-9, 1.0 / 16.0)
    skewed = np.abs(skewness) > _SYMMETRIC
    safe = np.where(skewed, skewness, 1.0)
    shape = 4.0 / safe**2
    at = np.where(safe > 0.0, gammainccinv(shape, chance), gammaincinv(shape, chance))
    return np.where(skewed, (at - shape) * safe / 2.0, -ndtri(chance))
