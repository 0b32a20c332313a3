"""Compare a plan with its request and report certain contradictions only.

Each function yields contradictions of one kind, in both directions: facts of the request that the plan lacks, and facts
of the plan that do not follow from the request.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import accumulate, takewhile

from fieldhand.language import Number, message
from fieldhand.language.words import listed, say_name
from fieldhand.places.selectors import AlongRow, InRow, Rows
from fieldhand.request_check import words as w
from fieldhand.request_check.amounts import StatedAmount, numbers_of
from fieldhand.request_check.earlier import actions_of_records, periods_of, selects_by_work, without_stated_periods
from fieldhand.request_check.limits import limit_mismatches
from fieldhand.request_check.mismatch import PlanMismatch
from fieldhand.request_check.places import place_mismatches
from fieldhand.request_check.plan_facts import PlanFacts, PlannedCaptures, PlannedNumber, plan_facts
from fieldhand.request_check.request_facts import RequestFacts, hints, request_facts
from fieldhand.request_check.selector_sizes import SelectorSizes
from fieldhand.request_check.thresholds import threshold_mismatches
from fieldhand.request_check.times import without_stated_times
from fieldhand.request_check.unsupported import unsupported_words
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task

#: Maximum number of consecutive steps whose counts are added.
_MOST_STEPS = 40
#: Words of parts of a row.
_PARTS = frozenset({"half", "third", "quarter", "middle", "centre", "center"})
#: Kinds of numbers that count nothing, and those that count no captures.
_NAMES = frozenset({"id", "row", "name", "length", "time", "percent", "temperature", "speed", "unit", "attribute"})
_PLACES = _NAMES | {"trees", "corners", "rows", "ordinal"}


def mismatches(task: Task, site: Site, robot: RobotProfile) -> tuple[PlanMismatch, ...]:
    """Return every certain contradiction between a plan and its request, each once.

    A plan without contradictions may still be wrong.
    """
    request = without_stated_times(task.command.read_as or task.command.request, task)
    request = without_stated_periods(request, task)
    sizes = SelectorSizes(task, site)
    waits = [watch for watch in task.composition.watches if watch.response == "wait"]
    longest = tuple(robot.patience.event_wait_s if one.at_most_s is None else one.at_most_s for one in waits)
    facts, plan = request_facts(request, robot, site), replace(plan_facts(task, sizes.of_node), waits=longest)
    plan = _with_strips(plan, facts, robot)
    found = [
        *_sensors(facts, plan, robot),
        *_counts(facts, plan, sizes),
        *threshold_mismatches(facts, plan, robot),
        *limit_mismatches(facts, plan),
        *place_mismatches(facts, plan, site),
        *unsupported_words(
            facts,
            periods_of(task),
            frozenset(node.dwell_s for node in plan.nodes if node.dwell_s),
            by_records=selects_by_work(task),
        ),
    ]
    return tuple(dict.fromkeys(found))


def _sensors(facts: RequestFacts, plan: PlanFacts, robot: RobotProfile) -> Iterator[PlanMismatch]:
    """Yield requested actions that the plan lacks, and planned actions that the request does not mention."""
    spoken: set[str] = set()
    planned = plan.actions | actions_of_records(plan.task, robot)
    reported: set[frozenset[str]] = set()
    for k, noun in facts.nouns.items():
        spoken |= noun.actions
        if noun.actions & planned or facts.negated(k) or noun.actions in reported:
            continue
        reported.add(noun.actions)
        words = w.quoted(facts.tokens[k : k + noun.length])
        able = listed([say_name(name) for name in sorted(noun.actions)], "or")
        yield PlanMismatch(
            kind="sensor",
            what=message(
                "the request says '{words}', but nothing in the plan does that ({able})", words=words, able=able
            ),
        )
    if not spoken or facts.unknown:
        return
    stems = {w.singular(word) for word in facts.words}
    for one in plan.captures:
        if one.action in spoken or one.action not in robot.action or hints(robot.action[one.action], robot) & stems:
            continue
        yield PlanMismatch(
            kind="sensor",
            what=message("the plan does '{action}', which the request does not mention", action=say_name(one.action)),
            node=one.node,
        )


def _counts(facts: RequestFacts, plan: PlanFacts, sizes: SelectorSizes) -> Iterator[PlanMismatch]:
    """Yield stated numbers of captures, trees or corners that the plan lacks, and numbers only in the plan."""
    for amount in facts.amounts:
        n = int(amount.values[0]) if float(amount.values[0]).is_integer() else 0
        if amount.kind not in ("captures", "trees", "corners") or n < 2 or facts.negated(amount.index):
            continue
        counted = {value for test in plan.tests if test.quantity and not test.unit for value in test.values}
        if amount.compared or n in _explained(plan, amount) or n in _visited(plan, sizes) or n in counted:
            continue
        yield PlanMismatch(
            kind="count",
            what=message(
                "the request says '{amount}', but no steps of the plan add up to {number}",
                amount=_phrase(facts, amount),
                number=n,
            ),
        )
    for number in plan.numbers:
        if number.kind != "count" or int(number.value) in _allowed(facts, number) or _by_itself(facts, number):
            continue
        if number.field == "count" and _amounts_to_stated_count(facts, plan, number.node, sizes):
            continue
        what_differs = message(
            "the plan holds the number {number} ({what}), which the request does not mention",
            number=Number(f"{number.value:g}"),
            what=number.what,
        )
        yield PlanMismatch(kind="count", what=what_differs, node=number.node)


def _with_strips(plan: PlanFacts, facts: RequestFacts, robot: RobotProfile) -> PlanFacts:
    """Return the facts with the stated width of a strip in place of the laps that make it: "a strip 3 m wide"."""
    lengths = [amount.values[0] for amount in facts.amounts if amount.kind == "length"]
    numbers = list(plan.numbers)
    for node in plan.nodes:
        action = None if node.work is None else robot.action.get(node.work.action)
        wide = None if action is None or action.implement is None else action.implement.width_m
        if node.work is None or node.work.mode != "perimeter" or not wide:
            continue
        laps = node.work.laps
        stated = next((x for x in lengths if wide * (laps - 1) < x < wide * (laps + 1)), None)
        if stated is not None:
            numbers = [one for one in numbers if one.node != node.id or one.field != "laps"]
            width = PlannedNumber(node=node.id, what="width of a strip", value=stated, kind="length", field="width")
            numbers.append(width)
    return replace(plan, numbers=tuple(numbers))


def _amounts_to_stated_count(facts: RequestFacts, plan: PlanFacts, node: str, sizes: SelectorSizes) -> bool:
    """Return True if a selector filters a counted group to as many places as the request states."""
    top = next(x for name, x in plan.selectors if name == node)
    stated = {n for a in facts.amounts if a.kind in ("trees", "captures") for n in numbers_of(a)}
    return not hasattr(top, "count") and sizes.of_node(node) in stated


def _phrase(facts: RequestFacts, amount: StatedAmount) -> str:
    """Return a number with the following words, up to the counted noun."""
    end = amount.index + 1
    for k in range(amount.index + 1, min(amount.index + 6, len(facts.tokens))):
        text = facts.tokens[k].text
        if text in w.ENDS_PHRASE:
            break
        end = k + (facts.nouns[k].length if k in facts.nouns else 1)
        if k in facts.nouns or text in w.TREES | w.CORNERS:
            break
    return w.quoted(facts.tokens[amount.index : end])


def _explained(plan: PlanFacts, amount: StatedAmount) -> set[int]:
    """Return every number that describes captures or visits of the plan."""
    acts = [one for one in plan.captures if not amount.actions or one.action in amount.actions]
    found = {n for one in acts for n in (one.each, *one.around)}
    for one in acts:
        found |= {n for n in (one.places.high, one.total.high, one.places.low, one.total.low) if n is not None}
    found |= _sums(acts)
    if amount.kind != "captures":
        found |= {int(number.value) for number in plan.numbers if number.kind == "count"}
        found |= {len(group) for group in (plan.trees, set(plan.trees), plan.captures)}
        found |= {len(x.which) for _, x in plan.selectors if hasattr(x, "which")}
        found |= {len(x.parts) for _, x in plan.selectors if hasattr(x, "parts")}
        found |= {getattr(x, "count", 0) for _, x in plan.selectors}
    return found


def _sums(acts: list[PlannedCaptures]) -> set[int]:
    """Return the totals of consecutive acts."""
    found: set[int] = {len(acts)}
    for start in range(len(acts)):
        highs = [one.total.high for one in acts[start:]]
        found.update(accumulate(h for h in highs if h is not None))
    return found


def _visited(plan: PlanFacts, sizes: SelectorSizes) -> set[int]:
    """Return the number of places of each selector ("all 18 yellow trees"), and of consecutive steps."""
    steps = [sizes.of_node(node.id) for node in plan.nodes if node.selector is not None]
    found = set(sizes.every)
    for start in range(min(len(steps), _MOST_STEPS)):
        known = takewhile(lambda n: n is not None, steps[start : start + _MOST_STEPS])
        found.update(accumulate(n for n in known if n is not None))
    return found


def _allowed(facts: RequestFacts, number: PlannedNumber) -> set[int]:
    """Return the whole numbers of the request that explain a number of the plan.

    Names of trees and rows, and numbers with a unit, are no numbers of captures.
    """
    captures = number.field == "captures"
    others = _PLACES if captures else _NAMES if number.field == "count" else frozenset()
    stated = {n for a in facts.amounts if a.kind not in others for n in numbers_of(a)}
    stated |= {n for word, n in w.MULTIPLES.items() if word in facts.words}
    found = set(stated)
    if number.selector is AlongRow:
        found |= set(range(max(stated, default=0) + 1))  # "the next five trees"
    if not captures:
        found |= {n + 1 for n in stated} | {n - 1 for n in stated}
    if facts.words & {"another", "again", "second", "repeat", "same", "more", "also", "other", "alternate"}:
        found |= {2}
    if facts.words & {"odd", "even", "next", "adjacent", "side"}:
        found |= {2}
    if facts.words & {"total", "altogether", "overall"} or {"in", "all"} <= facts.words:
        found |= {a * b for a in stated for b in stated} | {a // b for a in stated for b in stated if b and a % b == 0}
    return found


def _by_itself(facts: RequestFacts, number: PlannedNumber) -> bool:
    """Return True if a number follows without being stated, such as one row of "each row"."""
    if number.selector is InRow and facts.words & _PARTS:
        return True  # the trees of the first half of a row
    if number.field == "legs" and facts.words.isdisjoint(w.LEGS):
        return True  # a V has two legs, an N three, a diagonal one
    return facts.vague or (number.selector is Rows and bool(facts.words & {"each", "every", "all", "per"}))
