"""Conditions on all readings of one name taken so far: their mean or extremes, how many pass a test, their precision.

A series holds every reading that actions bind to its name, from the beginning of the mission or of the last loop that
``collects`` it. Readings that failed are not in it. A condition on an empty series is unknown.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.places.series_statistics import Statistic
from fieldhand.terms import Test

if TYPE_CHECKING:
    from fieldhand.task.conditions import Between, Compare, Level


@dataclass(frozen=True, kw_only=True)
class Aggregate:
    """``condition`` is true of one value for all readings of its name so far, such as their mean or their range
    (maximum minus minimum)."""

    of: Statistic
    condition: Compare | Between | Level


@dataclass(frozen=True, kw_only=True)
class CountReadings:
    """The number of readings so far of which ``condition`` is true, or their share in ``percent``, compared with
    ``number``. "All": ``eq`` 100 percent; "none": ``eq`` 0."""

    test: Test
    number: float
    percent: bool = False
    condition: Compare | Between | Level


@dataclass(frozen=True, kw_only=True)
class MeanKnown:
    """The mean of all readings so far is known to within ``value``, or to ``percent`` of itself: half the width of its
    95 % confidence interval (Student's t), from ``at_least`` readings on."""

    reading: str
    quantity: str
    percent: float | None = None
    value: float | None = None
    unit: str = ""
    at_least: int = 5


@dataclass(frozen=True, kw_only=True)
class CompareSeries:
    """A value of all readings so far compared with that of the readings named ``than``, plus ``value``: ``gt`` and 2 is
    more than 2 higher."""

    of: Statistic
    reading: str
    than: str
    quantity: str
    test: Test
    value: float = 0.0
    unit: str = ""


SeriesCondition = Aggregate | CountReadings | MeanKnown | CompareSeries


def series_of(condition: SeriesCondition) -> tuple[str, ...]:
    """Return the names of the readings whose series a condition needs."""
    match condition:
        case Aggregate(condition=inner) | CountReadings(condition=inner):
            return (inner.reading,)
        case MeanKnown():
            return (condition.reading,)
        case CompareSeries():
            return (condition.reading, condition.than)


def series_faults(condition: object) -> tuple[str, ...]:
    """Return what is impossible in a condition on a series, each as the end of a sentence about its node."""
    match condition:
        case CountReadings(percent=True, number=number) if not 0 <= number <= 100:
            return (f"tests for {number:g} percent of the readings: give 0 to 100",)
        case CountReadings(percent=False, number=number) if number < 0 or number != int(number):
            return (f"tests for {number:g} readings: give a whole number from 0",)
        case MeanKnown(percent=percent, value=value) if (percent is None) == (value is None):
            return ("tests whether a mean is known: give either 'percent' or 'value' with its unit",)
        case MeanKnown(percent=percent, value=value) if (percent or value or 0.0) <= 0:
            return ("tests whether a mean is known to within less than nothing: give a number above 0",)
        case CompareSeries(reading=reading, than=than) if reading == than:
            return (f"compares the readings {reading!r} with themselves: name another series",)
    return ()
