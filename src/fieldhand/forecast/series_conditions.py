"""Evaluation of conditions on all readings of a series, with the reason in words.

A condition on a series without a reading is unknown, like one on a reading that was never taken.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from fieldhand.forecast.conditions import TEST_WORDS, ConditionInputs, ConditionResult, amount_text, evaluate, passes
from fieldhand.language import message, named
from fieldhand.language.words import say_name, say_number
from fieldhand.places.reading_series import ReadingSeries
from fieldhand.places.series_statistics import Statistic, half_width, statistic
from fieldhand.task.aggregates import (
    Aggregate,
    CompareSeries,
    CountReadings,
    MeanKnown,
    SeriesCondition,
)
from fieldhand.task.conditions import Between, Compare, Level


def evaluate_series(condition: SeriesCondition, facts: ConditionInputs) -> ConditionResult:
    """Evaluate a condition on a series. Never raises: what cannot be determined is unknown."""
    match condition:
        case Aggregate():
            return _aggregate(condition, facts)
        case CountReadings():
            return _count(condition, facts)
        case MeanKnown():
            return _known(condition, facts)
        case CompareSeries():
            return _compared(condition, facts)


def _aggregate(condition: Aggregate, facts: ConditionInputs) -> ConditionResult:
    inner = condition.condition
    values = _values(facts, inner.reading, inner.quantity)
    if not values:
        return _no_reading(inner.quantity)
    value = statistic(condition.of, values)
    called = name_of(condition.of, inner.quantity, len(values))
    return evaluate(inner, replace(facts, readings={inner.reading: {inner.quantity: value}}, called=called))


def name_of(of: Statistic, quantity: str, count: int) -> str:
    """Return the name of a statistic of some readings as stored in event logs: "mean CO₂ (of 12)"."""
    name, total = say_name(quantity), say_number(count)
    match of:
        case "mean":
            return message("mean {name} (of {total})", context="log", name=name, total=total)
        case "median":
            return message("median {name} (of {total})", context="log", name=name, total=total)
        case "minimum":
            return message("lowest {name} (of {total})", context="log", name=name, total=total)
        case "maximum":
            return message("highest {name} (of {total})", context="log", name=name, total=total)
        case "range":
            return message("range of {name} (of {total})", context="log", name=name, total=total)


def _count(condition: CountReadings, facts: ConditionInputs) -> ConditionResult:
    inner = condition.condition
    values = _values(facts, inner.reading, inner.quantity)
    if not values:
        return _no_reading(inner.quantity)
    results = [evaluate(inner, replace(facts, readings={inner.reading: {inner.quantity: value}})) for value in values]
    if any(result.truth is None for result in results):
        return next(result for result in results if result.truth is None)
    passing = sum(result.holds for result in results)
    found = 100 * passing / len(values) if condition.percent else float(passing)
    truth = passes(found, condition.test, condition.number)
    unit = "percent" if condition.percent else ""
    fills = {
        "name": say_name(inner.quantity),
        "passing": say_number(passing),
        "total": say_number(len(values)),
        "how": TEST_WORDS[condition.test],
        "limit": amount_text(condition.number, unit),
    }
    return ConditionResult(truth=truth, why=_why_count(truth, inner, fills))


def _why_count(truth: bool, inner: Compare | Between | Level, fills: dict[str, str]) -> str:
    """Return the number of readings that pass a test in words."""
    match inner:
        case Compare(test=how, value=value, unit=unit):
            fills |= {"over": TEST_WORDS[how], "bound": amount_text(value, unit)}
            if truth:
                return message(
                    "readings of {name}: {passing} of {total} {over} {bound}, which is {how} {limit}",
                    context="log",
                    **fills,
                )
            return message(
                "readings of {name}: {passing} of {total} {over} {bound}, which is not {how} {limit}",
                context="log",
                **fills,
            )
        case Between(low=low, high=high, unit=unit):
            fills |= {"low": say_number(low), "high": amount_text(high, unit)}
            if truth:
                return message(
                    "readings of {name}: {passing} of {total} between {low} and {high}, which is {how} {limit}",
                    context="log",
                    **fills,
                )
            return message(
                "readings of {name}: {passing} of {total} between {low} and {high}, which is not {how} {limit}",
                context="log",
                **fills,
            )
        case Level(level=level):
            fills |= {"word": named(level, "level")}
            if truth:
                return message(
                    "readings of {name}: {passing} of {total} “{word}”, which is {how} {limit}", context="log", **fills
                )
            return message(
                "readings of {name}: {passing} of {total} “{word}”, which is not {how} {limit}", context="log", **fills
            )


def _known(condition: MeanKnown, facts: ConditionInputs) -> ConditionResult:
    values = _values(facts, condition.reading, condition.quantity)
    if not values:
        return _no_reading(condition.quantity)
    name = say_name(condition.quantity)
    if len(values) < condition.at_least:
        why = message(
            "readings of {name}: {passing} so far, and the mean needs at least {least}",
            context="log",
            name=name,
            passing=say_number(len(values)),
            least=say_number(condition.at_least),
        )
        return ConditionResult(truth=False, why=why)
    quantity = facts.robot.quantity.get(condition.quantity)
    unit = quantity.unit if quantity else ""
    mean, width = statistic("mean", values), half_width(values)
    limit = wanted_width(condition, mean)
    truth = width <= limit
    fills = {
        "known": name_of("mean", condition.quantity, len(values)),
        "mean": amount_text(mean, unit),
        "width": amount_text(width, unit),
        "limit": amount_text(limit, unit),
    }
    if truth:
        why = message("{known}, {mean}, is known to within {width}, and {limit} is asked for", context="log", **fills)
    else:
        why = message(
            "{known}, {mean}, is known only to within {width}, and {limit} is asked for", context="log", **fills
        )
    return ConditionResult(truth=truth, why=why)


def wanted_width(condition: MeanKnown, mean: float) -> float:
    """Return the accepted half width of the confidence interval, in the unit of the quantity."""
    if condition.value is not None:
        return condition.value
    return abs(mean) * (condition.percent or 0.0) / 100


def _compared(condition: CompareSeries, facts: ConditionInputs) -> ConditionResult:
    sides = [_values(facts, reading, condition.quantity) for reading in (condition.reading, condition.than)]
    if not all(sides):
        return _no_reading(condition.quantity)
    one, other = (statistic(condition.of, values) for values in sides)
    quantity = facts.robot.quantity.get(condition.quantity)
    unit = quantity.unit if quantity else condition.unit
    truth = passes(one, condition.test, other + condition.value)
    fills = {
        "first": name_of(condition.of, condition.quantity, len(sides[0])),
        "amount": amount_text(one, unit),
        "how": TEST_WORDS[condition.test],
        "second": name_of(condition.of, condition.quantity, len(sides[1])),
        "other": amount_text(other, unit),
    }
    if condition.value:
        fills["by"] = amount_text(condition.value, unit)
        if truth:
            why = message("{first}, {amount}, is {how} the other, {second}, {other}, plus {by}", context="log", **fills)
        else:
            why = message(
                "{first}, {amount}, is not {how} the other, {second}, {other}, plus {by}", context="log", **fills
            )
    elif truth:
        why = message("{first}, {amount}, is {how} the other, {second}, {other}", context="log", **fills)
    else:
        why = message("{first}, {amount}, is not {how} the other, {second}, {other}", context="log", **fills)
    return ConditionResult(truth=truth, why=why)


def _values(facts: ConditionInputs, reading: str, quantity: str) -> Sequence[float]:
    return facts.series.get(reading, ReadingSeries()).values(quantity)


def _no_reading(quantity: str) -> ConditionResult:
    return ConditionResult(
        truth=None, why=message("there is no reading of {name}", context="log", name=say_name(quantity))
    )
