"""Conditions tested by an if, a repeat or a for-each.

An action binds a reading (``Act.reading``); a condition names that binding and the quantity, so that a schema can
refuse quantities that the robot does not measure.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from fieldhand.task.aggregates import Aggregate, CompareSeries, CountReadings, MeanKnown, SeriesCondition, series_of
from fieldhand.task.battery_condition import BatteryBelow
from fieldhand.terms import Test, Value


@dataclass(frozen=True, kw_only=True)
class Compare:
    """A reading compared with a threshold, in the unit of the profile."""

    reading: str
    quantity: str
    test: Test
    value: float
    unit: str


@dataclass(frozen=True, kw_only=True)
class Between:
    """A reading between two thresholds, both inclusive."""

    reading: str
    quantity: str
    low: float
    high: float
    unit: str


@dataclass(frozen=True, kw_only=True)
class Level:
    """A reading compared with a word ("low", "high") whose threshold the profile defines."""

    reading: str
    quantity: str
    level: str


@dataclass(frozen=True, kw_only=True)
class TreeHas:
    """An attribute of the current tree, from the site file, compared with a value."""

    attribute: str
    test: Test
    value: Value


@dataclass(frozen=True, kw_only=True)
class AllOf:
    """All conditions are true."""

    conditions: tuple[Condition, ...]


@dataclass(frozen=True, kw_only=True)
class AnyOf:
    """At least one condition is true."""

    conditions: tuple[Condition, ...]


@dataclass(frozen=True, kw_only=True)
class Not:
    """The condition is false."""

    condition: Condition


Condition = (
    Compare
    | Between
    | Level
    | TreeHas
    | BatteryBelow
    | AllOf
    | AnyOf
    | Not
    | Aggregate
    | CountReadings
    | MeanKnown
    | CompareSeries
)


def walk(condition: Condition) -> Iterator[Condition]:
    """Yield this condition and all nested ones, outermost first."""
    yield condition
    match condition:
        case AllOf(conditions=inner) | AnyOf(conditions=inner):
            for part in inner:
                yield from walk(part)
        case Not(condition=part) | Aggregate(condition=part) | CountReadings(condition=part):
            yield from walk(part)
        case _:
            pass


def readings(condition: Condition) -> frozenset[str]:
    """Return the names of the readings that a condition needs."""
    single = (c.reading for c in walk(condition) if isinstance(c, Compare | Between | Level))
    return frozenset(single) | series(condition)


def series(condition: Condition) -> frozenset[str]:
    """Return the names of the readings of which a condition needs all that were taken."""
    return frozenset(name for c in walk(condition) if isinstance(c, SeriesCondition) for name in series_of(c))
