"""The probability that the legs of a route cost more than the amount left.

Cumulants of independent legs add up; the total is approximated by the Pearson III distribution (a shifted gamma) with
the same first three cumulants. docs/orienteering.md gives the error against sampling.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

_SYMMETRIC = 1e-3
#: Variance below which a sum is certain; its powers would underflow.
_LEAST_VARIANCE = 1e-180


def overrun_probability(mean: ArrayLike, variance: ArrayLike, third: ArrayLike, left: ArrayLike) -> Floats:
    """Return P(cost > ``left``) of a sum with three known cumulants, elementwise (Pearson III).

    Exact for deterministic legs and for equal exponential or gamma legs; docs/orienteering.md gives the error for
    others.

    Args:
        mean, variance, third: Cumulants of the sum: mean, variance, third central moment.
        left: Amount left; below 0 the probability is 1.
    """
    from scipy.special import gammainc, gammaincc, ndtr

    m, v, t, x = np.broadcast_arrays(*(np.asarray(a, dtype=np.float64) for a in (mean, variance, third, left)))
    certain = (x - m < -1e-9 * (1.0 + np.abs(x))).astype(np.float64)
    moving = (v > _LEAST_VARIANCE) & np.isfinite(m)
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
    """Return standardised Pearson III quantiles at an exceedance probability, by skewness from -4 to 8."""
    from scipy.special import gammainccinv, gammaincinv, ndtri

    skewness = np.arange(-4.0, 8.0 + 1e-9, 1.0 / 16.0)
    skewed = np.abs(skewness) > _SYMMETRIC
    safe = np.where(skewed, skewness, 1.0)
    shape = 4.0 / safe**2
    at = np.where(safe > 0.0, gammainccinv(shape, chance), gammaincinv(shape, chance))
    return np.where(skewed, (at - shape) * safe / 2.0, -ndtri(chance))


def standardised_quantile(table: Floats, variance: float, third: float) -> float:
    """Return the entry of a :func:`quantile_table` for a sum with given central moments; 0 for a deterministic one.

    Multiplied by the standard deviation, it is the excess over the mean that is exceeded with the table's probability.
    """
    if variance <= 0.0:
        return 0.0
    return float(np.interp(third / variance**1.5, np.arange(-4.0, 8.0 + 1e-9, 1.0 / 16.0), table))
