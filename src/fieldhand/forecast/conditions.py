"""Evaluation of a plan's conditions, with the reason in words.

A reading that was never taken (its action failed, or is on a branch that was not followed) is unknown, and so is every
condition that depends on it. An unknown condition does not hold, and neither does its negation (Kleene's three-valued
logic).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from fieldhand.errors import PlaceError
from fieldhand.language import joined, message, named
from fieldhand.language.words import listed, say_name, say_number, say_unit, say_value
from fieldhand.places.context import Context
from fieldhand.places.reading_series import SeriesByName
from fieldhand.places.resolution import resolve
from fieldhand.places.selectors import TreeIs, Where
from fieldhand.robot.model import RobotProfile
from fieldhand.site.feature_kinds import phrase
from fieldhand.site.model import Place, Site
from fieldhand.task.aggregates import Aggregate, CompareSeries, CountReadings, MeanKnown
from fieldhand.task.battery_condition import BatteryBelow
from fieldhand.task.conditions import AllOf, AnyOf, Between, Compare, Condition, Level, Not, TreeHas
from fieldhand.terms import Test, Value

#: Wording of each test in the sentences stored in event logs.
TEST_WORDS: Mapping[Test, str] = {
    "lt": message("below", context="log"),
    "le": message("at most", context="log"),
    "gt": message("above", context="log"),
    "ge": message("at least", context="log"),
    "eq": message("exactly", context="log"),
    "ne": message("other than", context="log"),
}


@dataclass(frozen=True, kw_only=True)
class ConditionInputs:
    """The inputs of a condition.

    Attributes:
        readings: Values by quantity, in the profile's units, of each bound reading.
        here: The plan's current place.
        series: All readings of each name, for conditions on series.
        called: Name of the tested value in the reason; by default that of its quantity.
        charge_percent: Charge of the battery now; None if unknown.
    """

    site: Site
    robot: RobotProfile
    here: Place
    readings: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    series: SeriesByName = field(default_factory=dict)
    called: str = ""
    charge_percent: float | None = None


@dataclass(frozen=True, kw_only=True)
class ConditionResult:
    """The truth of a condition (None if unknown), and the reason as a true sentence."""

    truth: bool | None
    why: str

    @property
    def holds(self) -> bool:
        """Return True if the condition is true; unknown counts as false."""
        return self.truth is True


def evaluate(condition: Condition, facts: ConditionInputs) -> ConditionResult:
    """Evaluate a condition. Never raises: what cannot be determined is unknown."""
    match condition:
        case Compare(test=how, value=value, unit=unit):
            bound = {"how": TEST_WORDS[how], "limit": amount_text(value, unit)}
            return _measured(condition, facts, lambda r: passes(r, how, value), _compared, bound)
        case Between(low=low, high=high, unit=unit):
            between = {"low": say_number(low), "high": amount_text(high, unit)}
            return _measured(condition, facts, lambda r: low <= r <= high, _between, between)
        case Level():
            return _level(condition, facts)
        case TreeHas():
            return _attribute(condition, facts)
        case BatteryBelow(percent=percent):
            return _battery(percent, facts)
        case Not(condition=inner):
            found = evaluate(inner, facts)
            return ConditionResult(truth=None if found.truth is None else not found.truth, why=found.why)
        case AllOf(conditions=inner):
            return _joined([evaluate(c, facts) for c in inner], decisive=False)
        case AnyOf(conditions=inner):
            return _joined([evaluate(c, facts) for c in inner], decisive=True)
        case Aggregate() | CountReadings() | MeanKnown() | CompareSeries():
            from fieldhand.forecast.series_conditions import evaluate_series

            return evaluate_series(condition, facts)


def passes(value: float, how: Test, threshold: float) -> bool:
    """Return True if a value passes a test."""
    match how:
        case "lt":
            return value < threshold
        case "le":
            return value <= threshold
        case "gt":
            return value > threshold
        case "ge":
            return value >= threshold
        case "eq":
            return value == threshold
        case "ne":
            return value != threshold


def _measured(
    condition: Compare | Between | Level,
    facts: ConditionInputs,
    passes: Callable[[float], bool],
    say: Callable[[bool, Mapping[str, str]], str],
    bounds: Mapping[str, str],
) -> ConditionResult:
    """Compare a reading with a threshold; ``say`` puts the result into words."""
    value = facts.readings.get(condition.reading, {}).get(condition.quantity)
    name = say_name(condition.quantity)
    if value is None:
        return ConditionResult(truth=None, why=message("there is no reading of {name}", context="log", name=name))
    quantity = facts.robot.quantity.get(condition.quantity)
    truth = passes(value)
    amount = amount_text(value, quantity.unit if quantity else "")
    fills = {"name": name, "amount": amount, **bounds}
    return ConditionResult(truth=truth, why=say(truth, fills | ({"called": facts.called} if facts.called else {})))


def _compared(truth: bool, fills: Mapping[str, str]) -> str:
    if "called" in fills and truth:
        return message("{called}, {amount}, is {how} {limit}", context="log", **fills)
    if "called" in fills:
        return message("{called}, {amount}, is not {how} {limit}", context="log", **fills)
    if truth:
        return message("{name} {amount} is {how} {limit}", context="log", **fills)
    return message("{name} {amount} is not {how} {limit}", context="log", **fills)


def _between(truth: bool, fills: Mapping[str, str]) -> str:
    if "called" in fills and truth:
        return message("{called}, {amount}, is between {low} and {high}", context="log", **fills)
    if "called" in fills:
        return message("{called}, {amount}, is not between {low} and {high}", context="log", **fills)
    if truth:
        return message("{name} {amount} is between {low} and {high}", context="log", **fills)
    return message("{name} {amount} is not between {low} and {high}", context="log", **fills)


def _on_level(truth: bool, fills: Mapping[str, str]) -> str:
    if "called" in fills and truth:
        return message("{called}, {amount}, is {word} ({how} {limit})", context="log", **fills)
    if "called" in fills:
        return message("{called}, {amount}, is not {word} ({how} {limit})", context="log", **fills)
    if truth:
        return message("{name} {amount} is {word} ({how} {limit})", context="log", **fills)
    return message("{name} {amount} is not {word} ({how} {limit})", context="log", **fills)


def _level(condition: Level, facts: ConditionInputs) -> ConditionResult:
    quantity = facts.robot.quantity.get(condition.quantity)
    level = None if quantity is None else quantity.levels.get(condition.level)
    if quantity is None or level is None:
        why = message(
            "the robot does not define the level '{word}' for {name}",
            context="log",
            word=named(condition.level, "level"),
            name=say_name(condition.quantity),
        )
        return ConditionResult(truth=None, why=why)
    how: Test = "lt" if level.direction == "below" else "gt"
    bound = {
        "word": named(condition.level, "level"),
        "how": TEST_WORDS[how],
        "limit": amount_text(level.value, quantity.unit),
    }
    return _measured(condition, facts, lambda r: passes(r, how, level.value), _on_level, bound)


def _attribute(condition: TreeHas, facts: ConditionInputs) -> ConditionResult:
    """Test an attribute of the current tree exactly as the selector ``Where`` does."""
    tree = facts.site.by_id.get(facts.here.id) if facts.here.kind == "tree" else None
    if tree is None:
        return ConditionResult(truth=None, why=message("the robot is not at a tree", context="log"))
    name = say_name(condition.attribute)
    known = {phrase(key): value for key, value in tree.properties.items()}
    value = tree.properties.get(condition.attribute, known.get(phrase(condition.attribute)))
    if value is None:
        why = message("the site does not record the {name} of tree {id}", context="log", name=name, id=tree.place.id)
        return ConditionResult(truth=None, why=why)
    selector = Where(
        attribute=condition.attribute, test=condition.test, value=condition.value, of=TreeIs(tree=tree.place.id)
    )
    fills = {"name": name, "id": tree.place.id, "has": say_value(value), "bound": say_value(condition.value)}
    if condition.test not in ("eq", "ne") and not (_is_number(value) and _is_number(condition.value)):
        why = message("the {name} of tree {id}, {has}, cannot be compared with {bound}", context="log", **fills)
        return ConditionResult(truth=None, why=why)
    try:
        truth = bool(resolve(selector, facts.site, Context(here=facts.here)))
    except PlaceError:
        # No tree has the requested value, so neither has this one.
        truth = False
    fills["how"] = TEST_WORDS[condition.test]
    if truth:
        why = message("the {name} of tree {id}, {has}, is {how} {bound}", context="log", **fills)
    else:
        why = message("the {name} of tree {id}, {has}, is not {how} {bound}", context="log", **fills)
    return ConditionResult(truth=truth, why=why)


def _battery(percent: float, facts: ConditionInputs) -> ConditionResult:
    if facts.charge_percent is None:
        return ConditionResult(truth=None, why=message("the charge of the battery is unknown", context="log"))
    fills = {"charge": say_number(facts.charge_percent, 3), "percent": say_number(percent)}
    if facts.charge_percent <= percent:
        return ConditionResult(
            truth=True, why=message("the battery is at {charge} %, not above {percent} %", context="log", **fills)
        )
    return ConditionResult(
        truth=False, why=message("the battery is at {charge} %, above {percent} %", context="log", **fills)
    )


def _is_number(value: Value) -> bool:
    """Return True if a value is a number or text that spells one."""
    try:
        return not isinstance(value, bool) and math.isfinite(float(value))
    except ValueError:
        return False


def _joined(results: Sequence[ConditionResult], *, decisive: bool) -> ConditionResult:
    """Combine results: one equal to ``decisive`` determines the result; otherwise an unknown one makes it unknown."""
    settling = [f for f in results if f.truth is decisive]
    if settling:
        return ConditionResult(truth=decisive, why=_all(settling))
    unknown = [f for f in results if f.truth is None]
    return ConditionResult(truth=None if unknown else not decisive, why=_all(unknown or results))


def _all(results: Sequence[ConditionResult]) -> str:
    """Return the reasons of several results as a list, in a form stored in event logs."""
    whys = [finding.why for finding in results]
    if len(whys) < 2:
        return listed(whys)
    return message("{known} and {also}", context="log", known=joined(", ", whys[:-1]), also=whys[-1])


def amount_text(value: float, unit: str) -> str:
    """Format a value with its unit: "31.2 °C". The log's readings keep every digit."""
    return joined(" ", [part for part in (say_number(value, 4), say_unit(unit)) if part])
