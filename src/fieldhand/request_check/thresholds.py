"""Check the thresholds and levels ("low") that a plan tests against those that the request states."""

from __future__ import annotations

from collections.abc import Iterator

from fieldhand.language import message
from fieldhand.language.words import TESTS, say_name, say_quantity
from fieldhand.request_check import words as w
from fieldhand.request_check.amounts import StatedAmount
from fieldhand.request_check.limits import BATTERY
from fieldhand.request_check.mismatch import PlanMismatch
from fieldhand.request_check.plan_facts import PlanFacts, PlannedTest
from fieldhand.request_check.request_facts import RequestFacts
from fieldhand.robot.model import RobotProfile

#: Factors between units in which the same quantity may be stated.
_FACTORS = (1.0, 100.0, 0.01, 1e4, 1e-4, 1e3, 1e-3)
#: Range of attribute values that are calendar years, which may follow from an age.
_CALENDAR = (1900.0, 2100.0)
#: Words with which a clause begins, before which another quantity may be named.
_CLAUSES = frozenset({"if", "when", "whenever", "where", "wherever", "or", "and", ",", "unless"})
_WAYS = {"below": ("lt", "le"), "above": ("gt", "ge")}


def threshold_mismatches(facts: RequestFacts, plan: PlanFacts, robot: RobotProfile) -> Iterator[PlanMismatch]:
    """Yield contradictions in tested thresholds and levels."""
    for amount in facts.amounts:
        yield from _kept(facts, plan, robot, amount)
    for test in plan.tests:
        if test.test != "level":
            yield from _invented(facts, robot, test)
    yield from _levels(facts, plan)


def _kept(facts: RequestFacts, plan: PlanFacts, robot: RobotProfile, amount: StatedAmount) -> Iterator[PlanMismatch]:
    """Yield a mismatch if a stated threshold is not tested, or with the wrong direction or quantity."""
    if not _certain(facts, amount):
        return
    same = [t for t in plan.tests if any(_same(v, x) for v in amount.values for x in t.values)]
    if not same:
        if not _as_level(plan, robot, amount) and not (amount.kind == "attribute" and _calendar(plan)):
            yield PlanMismatch(
                kind="condition",
                what=message(
                    "the request states the threshold '{amount}', which the plan never tests", amount=amount.words
                ),
            )
        return
    yield from _turned(amount, same, facts)
    yield from _other_quantity(amount, same, facts, robot)


def _certain(facts: RequestFacts, amount: StatedAmount) -> bool:
    """Return True if a number is certainly the threshold of a condition."""
    if amount.kind == "attribute":
        return bool(amount.compared) and not facts.negated(amount.index)
    if not facts.conditional(amount.sentence) or _is_pronoun(facts, amount):
        return False
    if amount.kind == "percent":
        return bool(amount.compared) and not {t.text for t in facts.tokens if t.sentence == amount.sentence} & BATTERY
    return amount.kind in ("temperature", "unit") or (amount.kind == "plain" and bool(amount.compared))


def _is_pronoun(facts: RequestFacts, amount: StatedAmount) -> bool:
    """Return True for the "one" of "above the cool one", before which an adjective stands."""
    before = facts.tokens[max(0, amount.index - 2) : amount.index]
    return facts.tokens[amount.index].text == "one" and len(before) == 2 and before[0].text in ("the", "that")


def _calendar(plan: PlanFacts) -> bool:
    return any(_CALENDAR[0] <= x <= _CALENDAR[1] for t in plan.tests for x in t.values)


def _as_level(plan: PlanFacts, robot: RobotProfile, amount: StatedAmount) -> bool:
    """Return True if a threshold is tested by its level ("low" is below 33)."""
    for test in plan.tests:
        quantity = robot.quantity.get(test.quantity)
        level = quantity.levels.get(test.level) if quantity is not None else None
        if level is not None and any(_same(value, level.value) for value in amount.values):
            return True
    return False


def _turned(amount: StatedAmount, same: list[PlannedTest], facts: RequestFacts) -> Iterator[PlanMismatch]:
    """Yield a mismatch if "below" is tested as "above", unless plan or request negates it."""
    alike = {a.compared for a in facts.amounts if any(_same(v, x) for v in a.values for x in amount.values)}
    ways = _WAYS.get(amount.compared)
    around = [t.text for t in facts.tokens if t.sentence == amount.sentence]
    if ways is None or alike != {amount.compared} or w.NEGATIONS.intersection(around) or "until" in around:
        return
    wanted = _wanted(facts, amount)
    for test in same:
        if test.test not in ("lt", "le", "gt", "ge") or test.test in ways or test.attribute:
            continue
        if test.plainly or (wanted & test.then and not wanted & test.otherwise):
            yield PlanMismatch(
                kind="threshold",
                what=message(
                    "the request says {test} '{amount}', and the plan tests {planned} {value}",
                    test=amount.compared,
                    amount=amount.words,
                    planned=TESTS[test.test],
                    value=say_quantity(test.values[0], test.unit),
                ),
                node=test.node,
            )


def _wanted(facts: RequestFacts, amount: StatedAmount) -> frozenset[str]:
    """Return the actions that a sentence requests if its threshold holds; "stop" for an end of the mission."""
    found: set[str] = set()
    for k in range(amount.index + 1, len(facts.tokens)):
        token = facts.tokens[k]
        if token.sentence != amount.sentence or token.text in ("otherwise", "else", "if"):
            break
        found |= facts.nouns[k].actions if k in facts.nouns else set()
        found |= {"stop"} if token.text in ("stop", "finish", "end") else set()
    return frozenset(found)


def _other_quantity(
    amount: StatedAmount, same: list[PlannedTest], facts: RequestFacts, robot: RobotProfile
) -> Iterator[PlanMismatch]:
    """Yield a mismatch if another quantity is tested than the one named before the threshold."""
    named = _quantity_before(amount, facts, robot)
    if named and all(t.quantity and t.quantity != named for t in same):
        test = same[0]
        what_differs = message(
            "the request compares the {quantity} with '{amount}', and the plan the {other}",
            quantity=say_name(named),
            amount=amount.words,
            other=say_name(test.quantity),
        )
        yield PlanMismatch(kind="sensor", what=what_differs, node=test.node)


def _quantity_before(amount: StatedAmount, facts: RequestFacts, robot: RobotProfile) -> str:
    """Return the one quantity named in the few words before a number; empty if not unique."""
    words: list[str] = []
    for token in reversed(facts.tokens[max(0, amount.index - 7) : amount.index]):
        if token.sentence != amount.sentence or token.text in _CLAUSES:
            break
        words.insert(0, token.text)
    text = f" {' '.join(words)} "
    own = {
        q.name: [x for x in q.words if not any(x in other.words for other in robot.quantities if other is not q)]
        for q in robot.quantities
    }
    found = [name for name, phrases in own.items() if any(f" {phrase} " in text for phrase in phrases)]
    return found[0] if len(found) == 1 else ""


def _invented(facts: RequestFacts, robot: RobotProfile, test: PlannedTest) -> Iterator[PlanMismatch]:
    """Yield thresholds of the plan that do not follow from the request."""
    for value in test.values:
        if test.attribute and _CALENDAR[0] <= value <= _CALENDAR[1]:
            continue
        if any(_follows(value, amount, test) for amount in facts.amounts):
            continue
        quantity = robot.quantity.get(test.quantity)
        if quantity is not None and any(_same(value, level.value) for level in quantity.levels.values()):
            continue
        what = say_name(test.attribute or test.quantity)
        text = say_quantity(value, test.unit)
        yield PlanMismatch(
            kind="threshold",
            what=message(
                "the plan compares the {what} with {value}, which the request does not mention", what=what, value=text
            ),
            node=test.node,
        )


def _follows(value: float, amount: StatedAmount, test: PlannedTest) -> bool:
    if amount.kind == "unit" and test.unit and amount.unit != test.unit.lower():
        return False
    if amount.kind == "temperature":
        # An attribute has no unit to compare, unlike a reading.
        return test.unit not in ("ppm", "percent") and any(_same(value, x) for x in amount.values)
    factors = _FACTORS if amount.kind in ("unit", "percent", "plain", "attribute", "length") else (1.0,)
    return any(_same(value, x * factor) for x in amount.values for factor in factors)


def _levels(facts: RequestFacts, plan: PlanFacts) -> Iterator[PlanMismatch]:
    """Yield levels tested but not requested, and levels requested while no reading is tested."""
    tested = {t.level: t.node for t in plan.tests if t.test == "level"}
    if facts.levels and not facts.unknown:
        for word in sorted(tested.keys() - facts.words):
            what_differs = message("the plan tests for '{word}', which the request does not mention", word=word)
            yield PlanMismatch(kind="condition", what=what_differs, node=tested[word])
    if tested or any(t.quantity for t in plan.tests):
        return
    if plan.recharges or plan.charges_percent:
        return  # "when the battery is low"
    for word in sorted(facts.levels):
        what_differs = message(
            "the request makes something depend on '{word}', but the plan tests no reading", word=word
        )
        yield PlanMismatch(kind="condition", what=what_differs)


def _same(a: float, b: float) -> bool:
    """Return True if two numbers are equal but for rounding in a conversion."""
    return abs(a - b) <= max(
        1e-6, 0.002 * abs(a), 0.06 if not float(b).is_integer() or not float(a).is_integer() else 0.0
    )
