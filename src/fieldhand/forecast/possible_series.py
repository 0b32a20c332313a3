"""Conditions on series as conditions on single values, for the enumeration of branches.

Only the value that a condition derives from a series matters on a branch: its mean, the number of readings that pass,
whether the mean is known. Each becomes a *derived* reading with a few possible values. All conditions that derive the
same value from a series must agree until another reading is taken.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from fieldhand.task.aggregates import Aggregate, CompareSeries, CountReadings, MeanKnown, SeriesCondition, series_of
from fieldhand.task.conditions import AllOf, AnyOf, Compare, Condition, Not

#: Largest series for which each number of passing readings is a value of its own.
_COUNTED = 40


@dataclass(frozen=True, kw_only=True)
class DerivedReading:
    """A value derived from series.

    Attributes:
        name: Name of the derived reading, unique for what it derives.
        quantity: Quantity under which its value is stored.
        condition: Condition from which it is derived.
    """

    name: str
    quantity: str
    condition: SeriesCondition

    @property
    def series(self) -> tuple[str, ...]:
        """The names of the readings that it is derived from."""
        return series_of(self.condition)

    def values(self, sizes: Mapping[str, int], measured: Callable[[str], tuple[float, ...]]) -> tuple[float, ...]:
        """Return its possible values.

        Args:
            sizes: Number of readings in each series; none is empty.
            measured: Returns representative values of a quantity.
        """
        match self.condition:
            case Aggregate(of="range"):
                (reading,) = self.series
                return (0.0,) if sizes[reading] < 2 else tuple(v for v in measured(self.quantity) if v >= 0) or (0.0,)
            case Aggregate():
                return measured(self.quantity)
            case CountReadings(percent=percent, number=number):
                (reading,) = self.series
                size = sizes[reading]
                near = {round(number * size / 100 if percent else number) + k for k in (-1, 0, 1)}
                counts = range(size + 1) if size <= _COUNTED else sorted(k for k in {0, size, *near} if 0 <= k <= size)
                return tuple(100 * k / size if percent else float(k) for k in counts)
            case MeanKnown(at_least=least):
                (reading,) = self.series
                return (0.0, 1.0) if sizes[reading] >= least else (0.0,)
            case CompareSeries():
                return (-1.0, 0.0, 1.0)


def derived(condition: SeriesCondition) -> tuple[DerivedReading, Condition]:
    """Return the derived reading of a condition, and the condition as a test of that reading."""
    match condition:
        case Aggregate(of=of, condition=inner):
            name = f"{of} of {inner.reading}"
            reading = DerivedReading(name=name, quantity=inner.quantity, condition=condition)
            return reading, replace(inner, reading=name)
        case CountReadings(condition=inner, test=test, number=number):
            name = f"{'share' if condition.percent else 'count'} of {inner!r}"
            return _compared(condition, name, Compare(reading=name, quantity="", test=test, value=number, unit=""))
        case MeanKnown():
            name = f"{condition!r}"
            return _compared(condition, name, Compare(reading=name, quantity="", test="ge", value=1.0, unit=""))
        case CompareSeries(test=test):
            name = f"{replace(condition, test='gt')!r}"
            return _compared(condition, name, Compare(reading=name, quantity="", test=test, value=0.0, unit=""))


def _compared(condition: SeriesCondition, name: str, test: Compare) -> tuple[DerivedReading, Condition]:
    return DerivedReading(name=name, quantity=test.quantity, condition=condition), test


def without_series(condition: Condition) -> tuple[Condition, tuple[DerivedReading, ...]]:
    """Return a condition with a test of a derived reading in place of each condition on a series."""
    match condition:
        case AllOf(conditions=inner) | AnyOf(conditions=inner):
            parts = [without_series(part) for part in inner]
            return replace(condition, conditions=tuple(part for part, _ in parts)), tuple(
                d for _, ds in parts for d in ds
            )
        case Not(condition=part):
            changed, found = without_series(part)
            return Not(condition=changed), found
        case Aggregate() | CountReadings() | MeanKnown() | CompareSeries():
            reading, test = derived(condition)
            return test, (reading,)
        case _:
            return condition, ()
