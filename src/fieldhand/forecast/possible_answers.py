"""Possible answers to a condition on a branch, given the readings taken and the site's data.

Only the order of a reading among the thresholds of the plan matters, so a few values represent all that a sensor can
return. An answer keeps only the values consistent with it, and a later test of the same reading must agree with them:
no branch is both hotter than 38 °C and colder than 33 °C. As on the robot, a test of a reading that was not taken on
the branch is unknown; a test of a tree's attribute has the answer given by the site.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from fieldhand.forecast.conditions import ConditionInputs, evaluate
from fieldhand.forecast.possible_series import DerivedReading, without_series
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task import conditions as c
from fieldhand.task import plan
from fieldhand.task.battery_condition import BatteryBelow
from fieldhand.task.conditions import Between, Compare, Condition, Level, TreeHas

#: Maximum number of combinations of values tried for one test; above it, both answers count as possible.
_MOST = 256

#: A quantity of one reading taken; reading and quantity that a condition tests; values that they may have.
_Taken = tuple[int, str]
_Tested = tuple[tuple[str, str], ...]
_Values = tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class _Outcome:
    """Possible results of a test: the answers, and the values consistent with each."""

    values: Mapping[bool, tuple[_Values, ...]]

    @property
    def answers(self) -> tuple[bool, ...]:
        return tuple(answer for answer in (True, False) if answer in self.values)


class ConditionOutcomes:
    """Possible results of conditions, cached for all walks of a mission.

    Args:
        root: Root of the plan, which contains the thresholds.
        site, robot: The site and the robot.
    """

    def __init__(self, root: plan.Node, site: Site, robot: RobotProfile) -> None:
        self._site, self._robot = site, robot
        self._values = dict(_standing_for(root, robot))
        self._outcomes: dict[object, _Outcome] = {}

    def values_of(self, quantity: str) -> _Values:
        """Return representative values of a quantity."""
        return self._values.get(quantity, (0.0,))

    def measured(self, action: str) -> dict[str, _Values]:
        """Return representative values of each quantity that an action measures."""
        known = self._robot.action.get(action)
        return {q: self.values_of(q) for q in known.measures} if known else {}

    def outcome(
        self,
        node_id: str,
        condition: Condition,
        here: Place,
        tested: _Tested,
        values: tuple[_Values, ...],
        charges: _Values = (),
    ) -> _Outcome | None:
        """Return the possible results of a test, given the values that each reading may have; None if too many.

        Args:
            node_id: Id of the condition's node.
            condition: The condition.
            here: The current place.
            tested: Reading and quantity of each tested reading that was taken.
            values: Possible values of each of them.
            charges: Possible charges of the battery, where the condition tests it.
        """
        at = here.id if any(isinstance(part, TreeHas) for part in c.walk(condition)) else ""
        charges = charges if tests_battery(condition) else ()
        key = (node_id, at, tested, values, charges)
        known = self._outcomes.get(key)
        if known is None and math.prod(len(v) for v in values) <= _MOST:
            known = self._outcomes[key] = self._try(condition, here, tested, values, charges)
        return known

    def _try(
        self, condition: Condition, here: Place, tested: _Tested, values: tuple[_Values, ...], charges: _Values
    ) -> _Outcome:
        with_answer: dict[bool, list[tuple[float, ...]]] = {}
        for combination in itertools.product(*values):
            readings: dict[str, dict[str, float]] = {}
            for (reading, quantity), value in zip(tested, combination, strict=True):
                readings.setdefault(reading, {})[quantity] = value
            for charge in charges or (None,):
                facts = ConditionInputs(
                    site=self._site, robot=self._robot, here=here, readings=readings, charge_percent=charge
                )
                with_answer.setdefault(evaluate(condition, facts).holds, []).append(combination)
        return _Outcome(
            values={
                answer: tuple(tuple(dict.fromkeys(each)) for each in zip(*some, strict=True))
                for answer, some in with_answer.items()
            }
        )


class BranchReadings:
    """The readings taken on one branch.

    Args:
        outcomes: Possible results of conditions, shared by all branches.
    """

    def __init__(self, outcomes: ConditionOutcomes) -> None:
        self._outcomes = outcomes
        self._bound: dict[str, tuple[int, str]] = {}
        self._left: dict[_Taken, _Values] = {}
        self._takings = 0
        self._sizes: dict[str, int] = {}
        self._derived: dict[str, DerivedReading] = {}

    def collect(self, reading: str, size: int) -> None:
        """Record the size of a series, which has another reading or has begun anew."""
        self._sizes[reading] = size
        for name in [name for name, derived in self._derived.items() if reading in derived.series]:
            del self._derived[name]
            self._bound.pop(name, None)

    def take(self, reading: str, action: str) -> None:
        """Record that an action has taken a new reading."""
        self._takings += 1
        self._bound[reading] = (self._takings, action)
        for quantity, values in self._outcomes.measured(action).items():
            self._left[self._takings, quantity] = values

    def lose(self, reading: str) -> None:
        """Record that a reading is unknown because its action failed."""
        self._bound.pop(reading, None)

    def missing(self, condition: Condition) -> tuple[str, ...]:
        """Return the readings that a condition tests but that were not taken."""
        plain, derived = without_series(condition)
        names = {d.name for d in derived}
        single = {r for r in c.readings(plain) - names if r not in self._bound}
        return tuple(sorted(single | {r for r in c.series(condition) if not self._sizes.get(r)}))

    def answers(self, node_id: str, condition: Condition, here: Place, charges: _Values = ()) -> tuple[bool, ...]:
        """Return the possible answers to a condition now, at least one."""
        plain, tested, values = self._tested(condition)
        found = self._outcomes.outcome(node_id, plain, here, tested, values, charges)
        return (True, False) if found is None else found.answers

    def settle(self, node_id: str, condition: Condition, here: Place, answer: bool, charges: _Values = ()) -> None:
        """Restrict the readings to values consistent with an answer."""
        plain, tested, values = self._tested(condition)
        found = self._outcomes.outcome(node_id, plain, here, tested, values, charges)
        if found is None:
            return
        for (reading, quantity), left in zip(tested, found.values[answer], strict=bool(tested)):
            self._left[self._bound[reading][0], quantity] = left

    def _tested(self, condition: Condition) -> tuple[Condition, _Tested, tuple[_Values, ...]]:
        """Return the condition as a test of single values, these, and their possible values."""
        plain, derived = without_series(condition)
        for one in derived:
            self._derive(one)
        tests = {
            (part.reading, part.quantity): self._left.get((self._bound[part.reading][0], part.quantity))
            for part in c.walk(plain)
            if isinstance(part, Compare | Between | Level) and part.reading in self._bound
        }
        known = {test: values for test, values in tests.items() if values is not None}
        return plain, tuple(known), tuple(known.values())

    def _derive(self, derived: DerivedReading) -> None:
        """Take a reading that is derived from series, unless it is known or a series is empty."""
        if derived.name in self._derived or not all(self._sizes.get(name) for name in derived.series):
            return
        self._takings += 1
        self._derived[derived.name] = derived
        self._bound[derived.name] = (self._takings, "")
        self._left[self._takings, derived.quantity] = derived.values(self._sizes, self._outcomes.values_of)


def tests_battery(condition: Condition) -> bool:
    """Return True if a condition tests the charge of the battery."""
    return any(isinstance(part, BatteryBelow) for part in c.walk(condition))


def _standing_for(root: plan.Node, robot: RobotProfile) -> Iterator[tuple[str, _Values]]:
    """Yield representative values of each quantity: its thresholds, a value between each two, and its range."""
    thresholds: dict[str, set[float]] = {}
    for node in plan.walk(root):
        condition = node.tested
        for part in c.walk(condition) if condition is not None else ():
            match part:
                case Compare(quantity=name, value=value):
                    thresholds.setdefault(name, set()).add(value)
                case Between(quantity=name, low=low, high=high):
                    thresholds.setdefault(name, set()).update((low, high))
                case Level(quantity=name, level=level) if name in robot.quantity:
                    known = robot.quantity[name].levels.get(level)
                    thresholds.setdefault(name, set()).update(() if known is None else (known.value,))
                case _:
                    pass
    for name, some in thresholds.items():
        quantity = robot.quantity.get(name)
        if quantity is None:
            continue
        low, high = quantity.minimum, quantity.maximum
        inside = sorted({low, high, *(value for value in some if low <= value <= high)})
        between = [a + (b - a) / 2 for a, b in itertools.pairwise(inside)]
        yield name, tuple(sorted({*inside, *between}))
