"""Conditions, attributes and actions as English clauses: "the canopy temperature there is below 33 °C"."""

from __future__ import annotations

from collections.abc import Mapping
from typing import assert_never

from fieldhand.robot.model import RobotProfile
from fieldhand.site.places.attribute_words import say_test
from fieldhand.task import conditions as c
from fieldhand.task.plan import Act
from fieldhand.task.words import TESTS, listed, say_action, say_name, say_number, say_quantity

Names = Mapping[str, str]


def say_condition(
    condition: c.Condition, where: Names | None = None, robot: RobotProfile | None = None, *, negated: bool = False
) -> str:
    """A condition as a clause: "the canopy temperature there is below 33 °C".

    Args:
        condition: What to say.
        where: Where each reading was taken ("there", "of step 3"); else its name is quoted.
        robot: Says what "low" and "high" mean.
        negated: Say the opposite.
    """
    places = where or {}
    no = " not" if negated else ""
    match condition:
        case c.Compare():
            amount = say_quantity(condition.value, condition.unit)
            return f"{_reading(condition, places)} is{no} {TESTS[condition.test]} {amount}"
        case c.Between():
            low, high = say_number(condition.low), say_quantity(condition.high, condition.unit)
            return f"{_reading(condition, places)} is{no} between {low} and {high}"
        case c.Level():
            return f"{_reading(condition, places)} is{no} {say_name(condition.level)}{_threshold(condition, robot)}"
        case c.TreeHas():
            clause = say_test(condition.attribute, condition.test, condition.value)
            return f"it is not so that the tree's {clause}" if negated else f"the tree's {clause}"
        case c.AllOf(conditions=inner) | c.AnyOf(conditions=inner):
            joined = _joined(inner, "and" if isinstance(condition, c.AllOf) else "or", places, robot)
            return f"it is not so that {joined}" if negated else joined
        case c.Not(condition=inner_condition):
            return say_condition(inner_condition, places, robot, negated=not negated)
        case _:
            assert_never(condition)


def _reading(condition: c.Compare | c.Between | c.Level, where: Names) -> str:
    place = where.get(condition.reading, f"of the reading “{condition.reading}”")
    return f"the {say_name(condition.quantity)} {place}".rstrip()


def _threshold(condition: c.Level, robot: RobotProfile | None) -> str:
    quantity = robot.quantity.get(condition.quantity) if robot else None
    level = quantity.levels.get(condition.level) if quantity else None
    if quantity is None or level is None:
        return ""
    return f" ({level.direction} {say_quantity(level.value, quantity.unit)})"


def _joined(inner: tuple[c.Condition, ...], word: str, where: Names, robot: RobotProfile | None) -> str:
    """Parts joined by one word; a part that joins others itself stands in brackets, so that there is one reading."""
    said = [say_condition(part, where, robot) for part in inner]
    bracketed = [
        f"({text})" if isinstance(part, c.AllOf | c.AnyOf) and len(part.conditions) > 1 else text
        for part, text in zip(inner, said, strict=True)
    ]
    return f" {word} ".join(bracketed) or ("always" if word == "and" else "never")


def say_act(act: Act, robot: RobotProfile | None = None) -> str:
    """An action with its parameters: "take 2 thermal pictures with exposure 20 ms"."""
    units = {}
    if robot is not None and act.action in robot.action:
        units = {p.name: p.unit for p in robot.action[act.action].parameters}
    settings = [
        f"{say_name(name)} {say_quantity(value, units.get(name, '')) if isinstance(value, float | int) else value}"
        for name, value in act.parameters
    ]
    return say_action(act.action, act.count) + (f" with {listed(settings)}" if settings else "")
