"""Distributions of the cost of a leg: its length times an independent random factor with mean 1."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import ProblemError

Floats = NDArray[np.float64]

#: Probabilities that bound the slices of a distribution: finer at high costs, which determine the overrun.
_EDGES = np.array([0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.88, 0.94, 0.97, 0.985, 0.995, 1.0])
_FINE = 64


class CostModel(Protocol):
    """The distribution of the random factor by which a leg's length is multiplied; its mean is 1."""

    def cumulants(self) -> tuple[float, float]:
        """Return the variance and the third central moment of the factor."""
        ...

    def quantile(self, probability: Floats) -> Floats:
        """Return the quantiles of the factor, elementwise."""
        ...

    def draw(self, rng: np.random.Generator, size: int) -> Floats:
        """Draw independent factors."""
        ...


@dataclass(frozen=True)
class ShiftedExponential:
    """``alpha + Exp`` with an exponential part of mean ``1 - alpha``: the model of the published experiments."""

    alpha: float = 0.5

    def __post_init__(self) -> None:
        if not 0.0 <= self.alpha <= 1.0:
            raise ProblemError(f"alpha is {self.alpha:g}", advice="give a number from 0 to 1")

    def cumulants(self) -> tuple[float, float]:
        scale = 1.0 - self.alpha
        return scale**2, 2.0 * scale**3

    def quantile(self, probability: Floats) -> Floats:
        return np.asarray(self.alpha - (1.0 - self.alpha) * np.log1p(-probability))

    def draw(self, rng: np.random.Generator, size: int) -> Floats:
        return self.alpha + (1.0 - self.alpha) * rng.standard_exponential(size)


@dataclass(frozen=True)
class Deterministic:
    """A deterministic cost: each leg costs its length."""

    def cumulants(self) -> tuple[float, float]:
        return 0.0, 0.0

    def quantile(self, probability: Floats) -> Floats:
        return np.ones_like(probability)

    def draw(self, rng: np.random.Generator, size: int) -> Floats:  # noqa: ARG002
        return np.ones(size)


@dataclass(frozen=True)
class Gamma:
    """A gamma distribution with a given coefficient of variation (standard deviation divided by mean)."""

    variation: float

    def __post_init__(self) -> None:
        _check_variation(self.variation)

    def cumulants(self) -> tuple[float, float]:
        return self.variation**2, 2.0 * self.variation**4

    def quantile(self, probability: Floats) -> Floats:
        from scipy.special import gammaincinv

        shape = self.variation**-2
        return np.asarray(gammaincinv(shape, probability) / shape)

    def draw(self, rng: np.random.Generator, size: int) -> Floats:
        shape = self.variation**-2
        return rng.standard_gamma(shape, size) / shape


@dataclass(frozen=True)
class Lognormal:
    """A lognormal distribution with a given coefficient of variation (standard deviation divided by mean)."""

    variation: float

    def __post_init__(self) -> None:
        _check_variation(self.variation)

    def cumulants(self) -> tuple[float, float]:
        square = self.variation**2
        return square, square**2 * (3.0 + square)

    def quantile(self, probability: Floats) -> Floats:
        from scipy.special import ndtri

        spread = math.log1p(self.variation**2)
        return np.asarray(np.exp(math.sqrt(spread) * ndtri(probability) - 0.5 * spread))

    def draw(self, rng: np.random.Generator, size: int) -> Floats:
        spread = math.log1p(self.variation**2)
        return np.exp(math.sqrt(spread) * rng.standard_normal(size) - 0.5 * spread)


@dataclass(frozen=True, eq=False)
class Empirical:
    """An empirical distribution of measured factors: cost divided by length, of at least two legs.

    The samples are divided by their mean; if it is not 1, the caller must scale the lengths by it.
    """

    samples: Sequence[float]
    _factors: Floats = field(init=False, repr=False)

    def __post_init__(self) -> None:
        factors = np.sort(np.asarray(self.samples, dtype=np.float64).reshape(-1))
        if len(factors) < 2 or not np.isfinite(factors).all() or factors[0] < 0.0 or factors.mean() <= 0.0:
            raise ProblemError("samples of leg costs must be two or more finite numbers, none below 0 and not all 0")
        object.__setattr__(self, "_factors", factors / factors.mean())

    def cumulants(self) -> tuple[float, float]:
        away = self._factors - 1.0
        return float((away**2).mean()), float((away**3).mean())

    def quantile(self, probability: Floats) -> Floats:
        return np.asarray(np.quantile(self._factors, probability, method="inverted_cdf"))

    def draw(self, rng: np.random.Generator, size: int) -> Floats:
        return rng.choice(self._factors, size)


def slices(model: CostModel) -> tuple[Floats, Floats]:
    """Return the factor as points and weights for the compiled loops; an exponential has only parameters."""
    if isinstance(model, ShiftedExponential):
        return np.array([model.alpha, 1.0 - model.alpha]), np.zeros(0)
    if model.cumulants()[0] <= 0.0:
        return np.ones(1), np.ones(1)
    weights = np.diff(_EDGES)
    inside = (np.arange(_FINE) + 0.5) / _FINE
    points = model.quantile((_EDGES[:-1, None] + weights[:, None] * inside).reshape(-1))
    points = points.reshape(-1, _FINE).mean(axis=1)
    # The part of the tail beyond the finest slice is added to the last point, so that the mean stays 1.
    points[-1] += max(0.0, 1.0 - float(weights @ points)) / weights[-1]
    return points, weights


def _check_variation(variation: float) -> None:
    if not (math.isfinite(variation) and 0.0 < variation <= 3.0):
        raise ProblemError(
            f"a leg's coefficient of variation is {variation:g}", advice="give a number above 0 and up to 3"
        )
