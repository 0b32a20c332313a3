"""One value for all readings of a series, and the precision of their mean."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from typing import Literal

Statistic = Literal["mean", "median", "minimum", "maximum", "range"]

#: Confidence of the interval in which a mean is known.
CONFIDENCE = 0.95


def statistic(of: Statistic, values: Sequence[float]) -> float:
    """Return one value for several, at least one."""
    match of:
        case "mean":
            return math.fsum(values) / len(values)
        case "median":
            return statistics.median(values)
        case "minimum":
            return min(values)
        case "maximum":
            return max(values)
        case "range":
            return max(values) - min(values)


def half_width(values: Sequence[float]) -> float:
    """Return half the width of the 95 % confidence interval of a mean; infinite for fewer than two values.

    Student's t distribution with n - 1 degrees of freedom times the standard error of the mean.
    """
    if len(values) < 2:
        return math.inf
    return t_quantile(len(values) - 1) * statistics.stdev(values) / math.sqrt(len(values))


def t_quantile(freedom: int) -> float:
    """Return the two-sided quantile of Student's t distribution at :data:`CONFIDENCE`."""
    from scipy.special import stdtrit

    return float(stdtrit(freedom, 0.5 + CONFIDENCE / 2))
