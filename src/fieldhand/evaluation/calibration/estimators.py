"""Estimators of legs, durations and energy, each with a 95 % confidence interval."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

CONFIDENCE = 0.95
_DRAWS = 5_000
#: Of the smallest to the largest singular value: below it two causes cannot be told apart.
_APART = 0.02
#: Steps within which errors may depend on each other: a charge read wrong is wrong on both its sides.
_LAG = 2


@dataclass(frozen=True, kw_only=True)
class FittedValue:
    """A figure with its confidence interval and how many observations it rests on."""

    value: float
    low: float
    high: float
    count: int

    def contains(self, value: float) -> bool:
        """Return True if a value lies in the interval."""
        return self.low <= value <= self.high


@dataclass(frozen=True, kw_only=True)
class LegFit:
    """Legs that cost ``scale * d * (alpha + Exp(1 - alpha))``.

    Attributes:
        alpha, scale: Fitted.
        likely: p-value of the Kolmogorov-Smirnov test of the model, 0 to 1.
    """

    alpha: FittedValue
    scale: FittedValue
    likely: float


def fit_legs(ratios: Floats, rng: np.random.Generator) -> LegFit:
    """Fit alpha and scale by maximum likelihood, corrected for bias.

    Args:
        ratios: Driven to planned metres of each leg; at least two.
        rng: Random generator of the draws for the intervals.

    A ratio is ``a + Exp(b)``. With n of them, ``2 n (mean - least) / b`` is chi-square with 2n - 2 degrees of freedom
    and ``n (least - a) / b`` is exponential, each independent of the other; so draws of both give the intervals of
    whatever follows from a and b, for any number of legs.
    """
    from scipy import stats

    n, least, mean = len(ratios), float(ratios.min()), float(ratios.mean())
    spread = n / (n - 1) * (mean - least)
    if spread <= 1e-9 * mean:
        scale = FittedValue(value=mean, low=mean, high=mean, count=n)
        return LegFit(alpha=FittedValue(value=1.0, low=1.0, high=1.0, count=n), scale=scale, likely=1.0)
    b = 2 * n * (mean - least) / rng.chisquare(2 * n - 2, _DRAWS)
    a = least - b * rng.standard_exponential(_DRAWS) / n
    first = max(0.0, least - spread / n)
    likely = float(stats.kstest((ratios - least) / spread, "expon").pvalue)
    return LegFit(
        alpha=_interval(min(1.0, first / mean), np.clip(a / (a + b), 0.0, 1.0), n),
        scale=_interval(mean, a + b, n),
        likely=likely,
    )


def fit_mean(values: Floats) -> FittedValue:
    """Return the mean with its interval, from at least two values."""
    return fit_ratio(values, np.ones_like(values))


def fit_ratio(amounts: Floats, sizes: Floats) -> FittedValue:
    """Return the ratio of the sum of amounts to that of sizes; errors grow with the size."""
    from scipy import stats

    rate = float(amounts.sum() / sizes.sum())
    variance = float(((amounts - rate * sizes) ** 2 / sizes).sum()) / (len(sizes) - 1) / float(sizes.sum())
    half = float(stats.t.ppf(0.5 + CONFIDENCE / 2, len(sizes) - 1)) * math.sqrt(variance)
    return FittedValue(value=rate, low=max(0.0, rate - half), high=rate + half, count=len(sizes))


def apart(columns: Floats) -> bool:
    """Return True if the causes in the columns of a table can be distinguished by its rows."""
    norms = np.linalg.norm(columns, axis=0)
    if not len(norms) or (norms <= 0).any():
        return False
    values = np.linalg.svd(columns / norms, compute_uv=False)
    return bool(values[-1] > _APART * values[0])


def fit_shares(columns: Floats, amounts: Floats) -> tuple[FittedValue, ...]:
    """Fit the amount per cause by non-negative least squares.

    Args:
        columns: Amount of each cause per row, shape (rows, causes); more rows than causes.
        amounts: Amount used per row, in the order of measurement.

    Errors may differ from row to row and hang together over two rows, so the intervals are those of Newey and West
    (1987).
    """
    from scipy import optimize, stats

    norms = np.linalg.norm(columns, axis=0)
    scaled = columns / norms
    found = np.asarray(optimize.nnls(scaled, amounts)[0], dtype=np.float64)
    rows, causes = columns.shape
    errors = amounts - scaled @ found
    inverse = np.linalg.pinv(scaled.T @ scaled)
    scores = scaled * errors[:, None]
    middle = scores.T @ scores
    for lag in range(1, min(_LAG, rows - 1) + 1):
        both = scores[lag:].T @ scores[:-lag]
        middle += (1 - lag / (_LAG + 1)) * (both + both.T)
    variances = np.clip(np.diag(inverse @ middle @ inverse), 0.0, None) * rows / (rows - causes)
    half = float(stats.t.ppf(0.5 + CONFIDENCE / 2, rows - causes)) * np.sqrt(variances)
    return tuple(
        FittedValue(value=float(v / n), low=max(0.0, float((v - h) / n)), high=float((v + h) / n), count=rows)
        for v, h, n in zip(found, half, norms, strict=True)
    )


def plausible(values: Sequence[float], most: float = 3.0) -> NDArray[np.bool_]:
    """Return True per duration if it is at most ``most`` times the median; longer ones were waits."""
    array = np.asarray(values, dtype=np.float64)
    return np.asarray(array <= most * np.median(array))


def _interval(value: float, draws: Floats, count: int) -> FittedValue:
    low, high = np.quantile(draws, [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])
    return FittedValue(value=value, low=min(float(low), value), high=max(float(high), value), count=count)
