"""Text of conditions on all readings of a series: "the mean of the readings of the CO2 of step 3 is above 450 ppm"."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from fieldhand.language import message
from fieldhand.language.words import say_number, say_quantity
from fieldhand.places.series_statistics import Statistic
from fieldhand.task import conditions as c
from fieldhand.task.aggregates import Aggregate, CompareSeries, CountReadings, MeanKnown, SeriesCondition

#: Returns the readings of a name and quantity in words: "the CO2 of step 3".
SayReadings = Callable[[str, str], str]
#: Returns the threshold of a level in words: "(above 36 °C)".
SayLevel = Callable[[c.Level], str]


def say_series_condition(condition: SeriesCondition, readings: SayReadings, level: SayLevel) -> tuple[str, str]:
    """Return a condition as a clause, and the subject with which its comparison can be phrased; one is empty."""
    match condition:
        case Aggregate(of=of, condition=inner):
            return "", say_statistic(of, readings(inner.reading, inner.quantity))
        case CountReadings():
            return _count(condition, readings, level), ""
        case MeanKnown():
            return _known(condition, readings(condition.reading, condition.quantity)), ""
        case CompareSeries(of=of):
            return "", say_statistic(of, readings(condition.reading, condition.quantity))


def say_statistic(of: Statistic, readings: str) -> str:
    """Return the statistic of some readings: "the mean of the readings of the CO2 of step 3"."""
    match of:
        case "mean":
            return message("the mean of the readings of {readings}", readings=readings)
        case "median":
            return message("the median of the readings of {readings}", readings=readings)
        case "minimum":
            return message("the lowest of the readings of {readings}", readings=readings)
        case "maximum":
            return message("the highest of the readings of {readings}", readings=readings)
        case "range":
            return message("the range of the readings of {readings}", readings=readings)


def say_other_series(condition: CompareSeries, readings: SayReadings) -> str:
    """Return what a series is compared with: "the mean of the readings of the CO2 of step 4 plus 20 ppm"."""
    other = say_statistic(condition.of, readings(condition.than, condition.quantity))
    if not condition.value:
        return other
    return message("{other} plus {amount}", other=other, amount=say_quantity(condition.value, condition.unit))


def _count(condition: CountReadings, readings: SayReadings, level: SayLevel) -> str:
    inner = condition.condition
    return message(
        "{how_many} of the readings of {readings} are {bound}",
        how_many=_how_many(condition),
        readings=readings(inner.reading, inner.quantity),
        bound=_bound(inner, level),
    )


def _how_many(condition: CountReadings) -> str:
    whole = condition.percent and condition.number == 100
    if condition.test in ("eq", "ge") and whole:
        return message("all", context="readings")
    if condition.number == 0 and condition.test in ("eq", "le"):
        return message("none", context="readings")
    number = say_number(condition.number)
    amount = message("{number} %", number=number) if condition.percent else number
    match condition.test:
        case "gt":
            return message("more than {amount}", amount=amount)
        case "ge":
            return message("at least {amount}", amount=amount)
        case "lt":
            return message("fewer than {amount}", amount=amount)
        case "le":
            return message("at most {amount}", amount=amount, context="readings")
        case "eq":
            return message("exactly {amount}", amount=amount, context="readings")
        case "ne":
            return message("not exactly {amount}", amount=amount)


def _bound(condition: c.Compare | c.Between | c.Level, level: SayLevel) -> str:
    """Return the test of each reading: "above 36 °C"."""
    match condition:
        case c.Between():
            high = say_quantity(condition.high, condition.unit)
            return message("between {low} and {high}", low=say_number(condition.low), high=high, context="readings")
        case c.Level():
            return level(condition)
        case c.Compare():
            return _tested(condition)


def _tested(condition: c.Compare) -> str:
    fills: Mapping[str, str] = {"amount": say_quantity(condition.value, condition.unit)}
    match condition.test:
        case "lt":
            return message("below {amount}", context="readings", **fills)
        case "le":
            return message("no higher than {amount}", **fills)
        case "gt":
            return message("above {amount}", context="readings", **fills)
        case "ge":
            return message("no lower than {amount}", **fills)
        case "eq":
            return message("equal to {amount}", **fills)
        case "ne":
            return message("other than {amount}", **fills)


def _known(condition: MeanKnown, readings: str) -> str:
    if condition.value is not None:
        width = say_quantity(condition.value, condition.unit)
    else:
        width = message("{number} % of its value", number=say_number(condition.percent or 0.0))
    return message(
        "the mean of the readings of {readings} is known to within {width} (95 % confidence, {count} readings or more)",
        readings=readings,
        width=width,
        count=condition.at_least,
    )
