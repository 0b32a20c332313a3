"""Text of conditions and actions as clauses: "the canopy temperature there is below 33 °C"."""

from __future__ import annotations

from collections.abc import Mapping

from fieldhand.compatibility import assert_never
from fieldhand.language import joined, labelled, message, named
from fieldhand.language.words import listed, say_action, say_name, say_number, say_quantity, say_times
from fieldhand.places.filters.attribute_words import say_of_tree, say_with_article
from fieldhand.robot.model import RobotProfile
from fieldhand.task import conditions as c
from fieldhand.task.aggregates import Aggregate, CompareSeries, CountReadings, MeanKnown, SeriesCondition
from fieldhand.task.battery_condition import BatteryBelow
from fieldhand.task.plan import Act
from fieldhand.terms import Test
from fieldhand.wording.recharging import say_battery
from fieldhand.wording.series_conditions import say_other_series, say_series_condition

Names = Mapping[str, str]


def say_condition(
    condition: c.Condition,
    where: Names | None = None,
    robot: RobotProfile | None = None,
    *,
    negated: bool = False,
    series: Names | None = None,
) -> str:
    """Return a condition as a clause: "the canopy temperature there is below 33 °C".

    Args:
        condition: Condition to describe.
        where: Place of each reading ("there", "of step 3"); readings not listed are quoted by name.
        robot: Robot profile that defines levels such as "low" and "high".
        negated: Describe the opposite condition.
        series: Origin of all readings of a name ("of step 3"); by default as in ``where``.
    """
    places = where or {}
    all_of = places if series is None else series
    match condition:
        case c.Compare() | c.Between() | c.Level():
            return _tested(condition, _reading(condition, places, robot), robot, negated=negated)
        case c.TreeHas():
            clause = say_of_tree(condition.attribute, condition.test, condition.value)
            return message("it is not the case that {clause}", clause=clause) if negated else clause
        case BatteryBelow(percent=percent):
            return say_battery(percent, negated=negated)
        case c.AllOf() | c.AnyOf():
            whole = _joined(condition, places, robot, all_of)
            return message("it is not the case that {clause}", clause=whole) if negated else whole
        case c.Not(condition=inner_condition):
            return say_condition(inner_condition, places, robot, negated=not negated, series=all_of)
        case Aggregate() | CountReadings() | MeanKnown() | CompareSeries():
            return _of_series(condition, all_of, robot, negated=negated)
        case _:
            assert_never(condition)


def _tested(
    condition: c.Compare | c.Between | c.Level, reading: str, robot: RobotProfile | None, *, negated: bool
) -> str:
    """Return the test of a reading, or of a statistic of several."""
    match condition:
        case c.Compare():
            return _compared(condition.test, reading, say_quantity(condition.value, condition.unit), negated=negated)
        case c.Between():
            fills = {
                "reading": reading,
                "low": say_number(condition.low),
                "high": say_quantity(condition.high, condition.unit),
            }
            if negated:
                return message("{reading} is not between {low} and {high}", **fills)
            return message("{reading} is between {low} and {high}", **fills)
        case c.Level():
            fills = {
                "reading": reading,
                "low": named(say_name(condition.level), "level", message("“{name}”", name=condition.level)),
                "threshold": _threshold(condition, robot),
            }
            if negated:
                return message("{reading} is not {low} {threshold}", **fills)
            return message("{reading} is {low} {threshold}", **fills)


def _compared(test: Test, reading: str, amount: str, *, negated: bool) -> str:
    """Return the comparison of a reading with a threshold; each test and each negation is a message of its own."""
    match test, negated:
        case "lt", False:
            return message("{reading} is below {amount}", reading=reading, amount=amount)
        case "lt", True:
            return message("{reading} is not below {amount}", reading=reading, amount=amount)
        case "le", False:
            return message("{reading} is at most {amount}", reading=reading, amount=amount)
        case "le", True:
            return message("{reading} is not at most {amount}", reading=reading, amount=amount)
        case "gt", False:
            return message("{reading} is above {amount}", reading=reading, amount=amount)
        case "gt", True:
            return message("{reading} is not above {amount}", reading=reading, amount=amount)
        case "ge", False:
            return message("{reading} is at least {amount}", reading=reading, amount=amount)
        case "ge", True:
            return message("{reading} is not at least {amount}", reading=reading, amount=amount)
        case "eq", False:
            return message("{reading} is exactly {amount}", reading=reading, amount=amount)
        case "eq", True:
            return message("{reading} is not exactly {amount}", reading=reading, amount=amount)
        case _, False:
            return message("{reading} is other than {amount}", reading=reading, amount=amount)
    return message("{reading} is not other than {amount}", reading=reading, amount=amount)


def _reading(condition: c.Compare | c.Between | c.Level, where: Names, robot: RobotProfile | None) -> str:
    quantity = say_with_article(condition.quantity)
    if robot is not None and condition.quantity in robot.quantity:
        quantity = labelled(quantity, robot.quantity[condition.quantity].labels)
    if condition.reading in where:
        return message("{quantity} {where}", quantity=quantity, where=where[condition.reading])
    return message("{quantity} of the reading “{name}”", quantity=quantity, name=condition.reading)


def _labels(once: Mapping[str, str], count: int) -> Mapping[str, str]:
    """Return the translated labels of an action, extended by the number of captures."""
    if count == 1:
        return once
    return {code: message("{action} {times}", action=phrase, times=say_times(count)) for code, phrase in once.items()}


def _threshold(condition: c.Level, robot: RobotProfile | None) -> str:
    quantity = robot.quantity.get(condition.quantity) if robot else None
    level = quantity.levels.get(condition.level) if quantity else None
    if quantity is None or level is None:
        return ""
    amount = say_quantity(level.value, quantity.unit)
    return (
        message("(below {amount})", amount=amount)
        if level.direction == "below"
        else message("(above {amount})", amount=amount)
    )


def _of_series(condition: SeriesCondition, series: Names, robot: RobotProfile | None, *, negated: bool) -> str:
    """Return a condition on a series; a statistic is compared in the words of a single reading."""

    def readings(name: str, quantity: str) -> str:
        return _reading(c.Level(reading=name, quantity=quantity, level=""), series, robot)

    def level(tested: c.Level) -> str:
        low = named(say_name(tested.level), "level", message("“{name}”", name=tested.level))
        return message("{low} {threshold}", low=low, threshold=_threshold(tested, robot))

    clause, subject = say_series_condition(condition, readings, level)
    match condition:
        case Aggregate(condition=inner):
            return _tested(inner, subject, robot, negated=negated)
        case CompareSeries(test=test):
            return _compared(test, subject, say_other_series(condition, readings), negated=negated)
    return message("it is not the case that {clause}", clause=clause) if negated else clause


def _joined(condition: c.AllOf | c.AnyOf, where: Names, robot: RobotProfile | None, series: Names) -> str:
    """Return the parts joined by "and" or "or", with nested groups in brackets to avoid ambiguity."""
    every = isinstance(condition, c.AllOf)
    if not condition.conditions:
        return message("always") if every else message("never")
    clauses = ""
    for part in condition.conditions:
        text = say_condition(part, where, robot, series=series)
        if isinstance(part, c.AllOf | c.AnyOf) and len(part.conditions) > 1:
            text = joined("", ("(", text, ")"))
        if not clauses:
            clauses = text
        elif every:
            clauses = message("{clause} and {other}", clause=clauses, other=text)
        else:
            clauses = message("{clause} or {other}", clause=clauses, other=text)
    return clauses


def say_act(act: Act, robot: RobotProfile | None = None) -> str:
    """Return an action with its parameters: "take 2 thermal pictures with exposure 20 ms"."""
    units = {}
    if robot is not None and act.action in robot.action:
        units = {p.name: p.unit for p in robot.action[act.action].parameters}
    settings = [
        joined(
            " ", (say_name(name), say_quantity(value, units.get(name, "")) if isinstance(value, float | int) else value)
        )
        for name, value in act.parameters
    ]
    doing = say_action(act.action, act.count)
    if robot is not None and act.action in robot.action:
        doing = labelled(doing, _labels(robot.action[act.action].labels, act.count))
    return message("{doing} with {settings}", doing=doing, settings=listed(settings)) if settings else doing
