"""Whether a condition of the plan holds, and why, in words.

A reading that was never taken (its action failed, or stands on a branch that was not followed) is unknown, and so is
every condition that hangs on it; what is unknown does not hold, and neither does its opposite (Kleene's three-valued
logic).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from fieldhand.errors import PlaceError
from fieldhand.robot.model import RobotProfile
from fieldhand.site.context import Context
from fieldhand.site.kinds import phrase
from fieldhand.site.model import Place, Site
from fieldhand.site.places import resolve
from fieldhand.task.conditions import AllOf, AnyOf, Between, Compare, Condition, Level, Not, TreeHas
from fieldhand.task.selectors import Test, TreeIs, Value, Where
from fieldhand.task.words import TESTS, listed, say_name, say_number, say_unit, say_value


@dataclass(frozen=True, kw_only=True)
class Facts:
    """What a condition is tested against.

    Attributes:
        readings: For each reading that was bound, its value by quantity.
        here: The place in hand.
    """

    site: Site
    robot: RobotProfile
    here: Place
    readings: Mapping[str, Mapping[str, float]] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Finding:
    """Whether a condition is true (None: unknown), and why, as a sentence that is true."""

    truth: bool | None
    why: str

    @property
    def holds(self) -> bool:
        """Whether the mission goes by it."""
        return self.truth is True


def evaluate(condition: Condition, facts: Facts) -> Finding:
    """Test a condition. Never fails: what cannot be known is unknown."""
    match condition:
        case Compare(test=how, value=value, unit=unit):
            return _measured(condition, facts, lambda r: _passes(r, how, value), f"{TESTS[how]} {_amount(value, unit)}")
        case Between(low=low, high=high, unit=unit):
            words = f"between {say_number(low)} and {_amount(high, unit)}"
            return _measured(condition, facts, lambda r: low <= r <= high, words)
        case Level():
            return _level(condition, facts)
        case TreeHas():
            return _attribute(condition, facts)
        case Not(condition=inner):
            found = evaluate(inner, facts)
            return Finding(truth=None if found.truth is None else not found.truth, why=found.why)
        case AllOf(conditions=inner):
            return _joined([evaluate(c, facts) for c in inner], decisive=False)
        case AnyOf(conditions=inner):
            return _joined([evaluate(c, facts) for c in inner], decisive=True)


def _passes(value: float, how: Test, threshold: float) -> bool:
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
    condition: Compare | Between | Level, facts: Facts, passes: Callable[[float], bool], words: str
) -> Finding:
    """A reading against a threshold that ``words`` says ("below 33 degC")."""
    value = facts.readings.get(condition.reading, {}).get(condition.quantity)
    name = say_name(condition.quantity)
    if value is None:
        return Finding(truth=None, why=f"there is no reading of {name}")
    quantity = facts.robot.quantity.get(condition.quantity)
    truth = passes(value)
    amount = _amount(value, quantity.unit if quantity else "")
    return Finding(truth=truth, why=f"{name} {amount} is {'' if truth else 'not '}{words}")


def _level(condition: Level, facts: Facts) -> Finding:
    quantity = facts.robot.quantity.get(condition.quantity)
    level = None if quantity is None else quantity.levels.get(condition.level)
    if quantity is None or level is None:
        why = f"the robot has no word '{condition.level}' for {say_name(condition.quantity)}"
        return Finding(truth=None, why=why)
    how: Test = "lt" if level.direction == "below" else "gt"
    words = f"{condition.level} ({level.direction} {_amount(level.value, quantity.unit)})"
    return _measured(condition, facts, lambda r: _passes(r, how, level.value), words)


def _attribute(condition: TreeHas, facts: Facts) -> Finding:
    """What the site file says of the tree in hand, tested exactly as the selector ``Where`` tests it."""
    tree = facts.site.by_id.get(facts.here.id) if facts.here.kind == "tree" else None
    if tree is None:
        return Finding(truth=None, why="the robot is not at a tree")
    name = say_name(condition.attribute)
    known = {phrase(key): value for key, value in tree.properties.items()}
    value = tree.properties.get(condition.attribute, known.get(phrase(condition.attribute)))
    if value is None:
        return Finding(truth=None, why=f"the site does not say the {name} of tree {tree.place.id}")
    selector = Where(
        attribute=condition.attribute, test=condition.test, value=condition.value, of=TreeIs(tree=tree.place.id)
    )
    said = f"the {name} of tree {tree.place.id}, {say_value(value)},"
    if condition.test not in ("eq", "ne") and not (_is_number(value) and _is_number(condition.value)):
        return Finding(truth=None, why=f"{said} cannot be ordered against {say_value(condition.value)}")
    try:
        truth = bool(resolve(selector, facts.site, Context(here=facts.here)))
    except PlaceError:
        # No tree has the value that is asked for, this one included.
        truth = False
    words = f"{'' if truth else 'not '}{TESTS[condition.test]} {say_value(condition.value)}"
    return Finding(truth=truth, why=f"{said} is {words}")


def _is_number(value: Value) -> bool:
    """Whether a value is a number or text that spells one."""
    try:
        return not isinstance(value, bool) and math.isfinite(float(value))
    except ValueError:
        return False


def _joined(found: Sequence[Finding], *, decisive: bool) -> Finding:
    """All of, or any of: one finding that is ``decisive`` settles it, else one that is unknown leaves it open."""
    settling = [f for f in found if f.truth is decisive]
    if settling:
        return Finding(truth=decisive, why=listed([f.why for f in settling]))
    unknown = [f for f in found if f.truth is None]
    return Finding(truth=None if unknown else not decisive, why=listed([f.why for f in unknown or found]))


def _amount(value: float, unit: str) -> str:
    """A value as people read it: "31.2 °C". The log's readings hold every digit."""
    return f"{say_number(value, 4)} {say_unit(unit)}".rstrip()
