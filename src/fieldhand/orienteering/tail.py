"""The chance that the legs of a route cost more than is left.

The sum of legs ``d_i * (alpha + X_i)`` is a fixed part ``alpha * sum(d_i)`` and a sum of exponentials with means
``(1 - alpha) * d_i``. That sum is taken as the gamma distribution with the same mean and variance: exact for legs of
equal length (Erlang) and for a single leg, and checked against sampling in the tests for the others.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import gammaincc

Floats = NDArray[np.float64]


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
