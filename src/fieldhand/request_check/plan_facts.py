"""Countable facts of a plan: captures, places, tests, limits, names, sides, exit.

They follow from the Task alone; numbers that depend on the site, a reading or the budget are ranges.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, replace
from functools import cached_property, partial
from typing import Literal

from fieldhand.places import selectors as s
from fieldhand.places.count_range import ONE, CountRange, exactly
from fieldhand.places.points.transect import OFF_EDGE_M
from fieldhand.places.selector import Selector
from fieldhand.request_check.earlier import earlier_tests
from fieldhand.task import conditions as c
from fieldhand.task import plan as p
from fieldhand.task.aggregates import CompareSeries, CountReadings, MeanKnown
from fieldhand.task.battery_condition import BatteryBelow
from fieldhand.task.codec_shapes import element_name
from fieldhand.task.frames import Task
from fieldhand.task.recharging import recharges
from fieldhand.task.watches import EventBeyond, ReadingBeyond
from fieldhand.terms import Side, Test, Value

#: Opposite sides.
_ACROSS: tuple[tuple[Side, Side], ...] = (("north", "south"), ("east", "west"))


@dataclass(frozen=True, kw_only=True)
class PlannedCaptures:
    """The captures of one act of the plan.

    Attributes:
        node: Id of the act.
        action: Name of the action.
        each: Number of captures at one place.
        places: Number of distinct places, from the enclosing for-eaches.
        total: Number of captures in the whole mission, if the act is reached.
        bound: True if it is conditional, in a try, or optional.
        around: Numbers in the enclosing selectors and nodes.
    """

    node: str
    action: str
    each: int
    places: CountRange
    total: CountRange
    bound: bool
    around: frozenset[int]


@dataclass(frozen=True, kw_only=True)
class PlannedTest:
    """A threshold tested by the plan: of a reading, or of an attribute if ``quantity`` is empty.

    Attributes:
        node: Id of the node that tests it.
        quantity: Measured quantity.
        attribute: Attribute of the tree.
        test: Comparison.
        values: Thresholds.
        unit: Unit of the thresholds.
        level: Level word, if the test uses one.
        plainly: The test has a ``then`` without an ``otherwise``, and neither negation nor a stop inverts it.
        then, otherwise: Actions if the test is true or false, including "stop"; both empty if it ends a repetition or
            is negated.
    """

    node: str
    quantity: str
    attribute: str
    test: Test | Literal["between", "level"]
    values: tuple[float, ...]
    unit: str = ""
    level: str = ""
    plainly: bool = False
    then: frozenset[str] = frozenset()
    otherwise: frozenset[str] = frozenset()


@dataclass(frozen=True, kw_only=True)
class PlannedNumber:
    """A whole number, share or distance in a selector or node that differs from the default.

    Attributes:
        node: Id of the node.
        what: Name of the number, for messages.
        value: The number.
        kind: ``count`` for a whole number, ``length`` for metres, ``percent`` for a share of a group.
        field: Field of the selector or the node.
        selector: Class of the selector; None for a number of the node itself.
    """

    node: str
    what: str
    value: float
    kind: Literal["count", "length", "percent"]
    field: str
    selector: type[Selector] | None = None


@dataclass(frozen=True, kw_only=True)
class PlanFacts:
    """The facts of a Task: its plan nodes in order, every selector of these, captures, tests, numbers and waits."""

    task: Task
    nodes: tuple[p.Node, ...]
    selectors: tuple[tuple[str, Selector], ...]
    captures: tuple[PlannedCaptures, ...]
    tests: tuple[PlannedTest, ...]
    numbers: tuple[PlannedNumber, ...]
    waits: tuple[float, ...] = ()

    def having(self, *classes: type) -> Iterator[tuple[str, Selector]]:
        """Return the selectors of some classes, each with its node."""
        return ((node, x) for node, x in self.selectors if isinstance(x, classes))

    @cached_property
    def actions(self) -> frozenset[str]:
        """Return the actions of the plan."""
        return frozenset({*(one.action for one in self.captures), *(work.action for work in self.works if work.action)})

    @cached_property
    def works(self) -> tuple[p.WorkAlong, ...]:
        """Return the work along paths."""
        return tuple(node.work for node in self.nodes if node.work is not None)

    @cached_property
    def trees(self) -> tuple[tuple[str, str], ...]:
        """Return the ids of named trees, each with its node."""
        return tuple((node, x.named_tree) for node, x in self.selectors if x.named_tree)

    @cached_property
    def markers(self) -> frozenset[str]:
        """Return the named markers."""
        named = frozenset(x.named_marker for _, x in self.selectors if x.named_marker)
        return named | {"charger"} if self.recharges else named

    @cached_property
    def recharges(self) -> bool:
        """Return True if the mission charges the battery."""
        return recharges(self.task)

    @cached_property
    def charges_percent(self) -> tuple[float, ...]:
        """Return the charges of the battery that the plan names: those at which something begins or ends."""
        limits = self.task.constraints
        named = [limits.return_percent, limits.recharge_below_percent, limits.recharge_until_percent]
        named += [node.recharge.until_percent for node in self.nodes if node.recharge is not None]
        tests = [node.tested for node in self.nodes if node.tested is not None]
        tested = [part.percent for test in tests for part in c.walk(test) if isinstance(part, BatteryBelow)]
        return (*(one for one in named if one is not None), *tested)

    @cached_property
    def areas(self) -> tuple[tuple[str, str], ...]:
        """Return the named zones and blocks, each with its node."""
        named = ((node, getattr(x, "zone", "") or getattr(x, "block", "")) for node, x in self.selectors)
        return tuple((node, name) for node, name in named if name)

    @cached_property
    def sides(self) -> dict[Side, str]:
        """Return the compass sides named by selectors, each with a node; none for all four corners together."""
        found: dict[Side, str] = {}
        visited: dict[tuple[Selector, str], set[str]] = {}
        for _, x in self.selectors:
            if isinstance(x, s.Corners):
                visited.setdefault((x.of, x.zone), set()).update(x.which)
        for node, x in self.selectors:
            if isinstance(x, s.Corners) and len(visited[x.of, x.zone]) == 4:
                continue  # together they are all four sides, which the request need not mention
            for side in x.sides:
                found.setdefault(side, node)
        return found

    @cached_property
    def ends_driven(self) -> frozenset[Side]:
        """Return the sides that only distinguish the two ends of one direction."""
        drives = {n.id: n.selector for n in self.nodes if n.only_drives and isinstance(n.selector, s.Extreme)}
        ends = {(place.of, place.side) for place in drives.values()}
        elsewhere = {side for node, x in self.selectors if x != drives.get(node) for side in x.sides}
        ways = [{one, other} for one, other in _ACROSS for of, _ in ends if {(of, one), (of, other)} <= ends]
        return frozenset(side for way in ways for side in way) - elsewhere

    @cached_property
    def values(self) -> tuple[tuple[str, str, Value], ...]:
        """Return node, attribute and value of each test of a site attribute."""
        kept = [(node, x.attribute, x.value) for node, x in self.selectors if isinstance(x, s.Where)]
        for node in self.nodes:
            condition = node.tested
            for part in c.walk(condition) if condition is not None else ():
                kept.extend([(node.id, part.attribute, part.value)] if isinstance(part, c.TreeHas) else [])
        return tuple(kept)


def plan_facts(task: Task, size: Callable[[str], int | None]) -> PlanFacts:
    """Return the facts of a Task.

    Args:
        size: Function from a node's id to the number of places of its selector on the site; None if that is open.
    """
    root = task.composition.plan
    nodes = tuple(p.walk(root))
    selectors = (
        *((n.id, x) for n in nodes if (top := n.selector) is not None for x in top.walk()),
        *((root.id, x) for avoid in task.constraints.avoid for x in avoid.places.walk()),
        *((root.id, x) for slow in task.constraints.slow for x in slow.places.walk()),
    )
    return PlanFacts(
        task=task,
        nodes=nodes,
        selectors=selectors,
        captures=tuple(_captures(root, _Surroundings(), size)),
        tests=(*_tests(nodes, selectors), *_watched(task)),
        numbers=(*_numbers(nodes, selectors), *_kept_distances(task)),
    )


def _watched(task: Task) -> Iterator[PlannedTest]:
    """Yield the thresholds that the mission watches."""
    for watch in task.composition.watches:
        match watch.condition:
            case EventBeyond(event=name, test=test, value=value, unit=unit):
                yield PlannedTest(node="", quantity=name, attribute="", test=test, values=(value,), unit=unit)
            case ReadingBeyond(quantity=name, test=test, value=value, unit=unit):
                yield PlannedTest(node="", quantity=name, attribute="", test=test, values=(value,), unit=unit)
            case _:
                pass


@dataclass(frozen=True, kw_only=True)
class _Surroundings:
    """Surroundings of a node: distinct places, rounds, numbers, and whether it is conditional."""

    places: CountRange = ONE
    rounds: CountRange = ONE
    numbers: frozenset[int] = frozenset()
    bound: bool = False


def _captures(node: p.Node, around: _Surroundings, size: Callable[[str], int | None]) -> Iterator[PlannedCaptures]:
    """Yield the captures of the acts inside a node."""
    act = node.act
    if act is not None:
        own = {act.count, *(_counts(act.at) if act.at is not None else ())}
        yield PlannedCaptures(
            node=act.id,
            action=act.action,
            each=act.count,
            places=around.places,
            total=around.places.times(around.rounds).times(exactly(act.count)),
            bound=around.bound,
            around=around.numbers | own,
        )
    loose = node.tested is not None or node.is_optional or not all(part.certain for part in node.parts)
    inside = replace(around, bound=around.bound or loose)
    if node.visits_each and node.selector is not None:
        inside = _visited(node, node.selector, inside, size(node.id), loose=loose)
    elif node.rounds is not None:
        times = CountRange(low=1 if node.tested is not None else node.rounds, high=node.rounds)
        inside = replace(inside, rounds=around.rounds.times(times), numbers=around.numbers | {node.rounds})
    for child in node.children:
        yield from _captures(child, inside, size)


def _visited(node: p.Node, select: Selector, around: _Surroundings, size: int | None, *, loose: bool) -> _Surroundings:
    """Return the surroundings inside a node that visits each place: number of places, and numbers in the node."""
    inside = select.size if size is None else exactly(size)
    most = frozenset({node.at_most} if node.at_most is not None else ())
    if node.at_most is not None:
        high = node.at_most if inside.high is None else min(inside.high, node.at_most)
        inside = CountRange(low=min(inside.low, high), high=high)
    inside = CountRange(low=0, high=inside.high) if loose else inside
    return replace(
        around,
        places=around.places.times(inside),
        numbers=around.numbers | most | frozenset(_counts(select)),
    )


def _counts(selector: Selector) -> Iterator[int]:
    """Yield the counts in a selector."""
    for part in selector.walk():
        count = getattr(part, "count", 0)
        yield from (count,) if count else ()


def _tests(nodes: tuple[p.Node, ...], selectors: tuple[tuple[str, Selector], ...]) -> Iterator[PlannedTest]:
    for node, x in selectors:
        for past in earlier_tests(x):
            yield PlannedTest(
                node=node, quantity=past.quantity, attribute="", test=past.test, values=(past.value,), unit=past.unit,
                plainly=True,
            )  # fmt: skip
        if isinstance(x, s.Where) and isinstance(x.value, float | int) and not isinstance(x.value, bool):
            yield PlannedTest(
                node=node, quantity="", attribute=x.attribute, test=x.test, values=(float(x.value),), plainly=True
            )
    for one in nodes:
        condition = one.tested
        parts = tuple(c.walk(condition)) if condition is not None else ()
        straight = one.is_choice and not any(isinstance(part, c.Not) for part in parts)
        then, otherwise = (*map(_done, one.children if straight else ()), frozenset[str](), frozenset[str]())[:2]
        plainly = straight and len(one.children) == 1 and "stop" not in then
        for part in parts:
            for tested in _tested(part, one.id):
                yield replace(tested, plainly=plainly, then=then, otherwise=otherwise)


def _done(node: p.Node) -> frozenset[str]:
    """Return the actions inside a node, and "stop" if it ends the mission."""
    stops = {"stop" for one in p.walk(node) if one.ends_plan}
    return frozenset(stops | ({act.action for act in p.acts(node)} | {work.action for work in p.works(node)}))


def _tested(part: c.Condition, node: str) -> Iterator[PlannedTest]:
    match part:
        case c.Compare():
            yield PlannedTest(
                node=node, quantity=part.quantity, attribute="", test=part.test, values=(part.value,), unit=part.unit,
            )  # fmt: skip
        case c.Between():
            yield PlannedTest(
                node=node, quantity=part.quantity, attribute="", test="between", values=(part.low, part.high),
                unit=part.unit,
            )  # fmt: skip
        case c.Level():
            yield PlannedTest(
                node=node, quantity=part.quantity, attribute="", test="level", values=(), level=part.level,
            )  # fmt: skip
        case CountReadings(condition=inner, number=number, percent=percent) if not _in_words(part):
            unit = "percent" if percent else ""
            yield PlannedTest(
                node=node, quantity=inner.quantity, attribute="", test=part.test, values=(number,), unit=unit,
            )  # fmt: skip
        case MeanKnown(percent=percent, value=value) if within := percent or value:
            unit = "percent" if percent else part.unit
            yield PlannedTest(
                node=node, quantity=part.quantity, attribute="", test="le", values=(within,), unit=unit,
            )  # fmt: skip
        case CompareSeries(value=by) if by:
            yield PlannedTest(
                node=node, quantity=part.quantity, attribute="", test=part.test, values=(abs(by),), unit=part.unit,
            )  # fmt: skip
        case c.TreeHas(value=value) if isinstance(value, float | int) and not isinstance(value, bool):
            yield PlannedTest(node=node, quantity="", attribute=part.attribute, test=part.test, values=(float(value),))
        case _:
            return


def _in_words(condition: CountReadings) -> bool:
    """Return True for a number of readings that requests say in words: any, none, all, most, half."""
    whole = (50, 100) if condition.percent else (0, 1)
    return condition.number in whole or (condition.percent and condition.number == 0)


def _kept_distances(task: Task) -> Iterator[PlannedNumber]:
    """Yield the distances that a plan keeps from places, and within which it drives slowly."""
    kept = [("avoid distance m", avoid.distance_m) for avoid in task.constraints.avoid]
    for what, distance_m in (*kept, *(("slow within m", slow.distance_m) for slow in task.constraints.slow)):
        if distance_m:
            yield PlannedNumber(
                node=task.composition.plan.id,
                what=what,
                value=distance_m,
                kind="length",
                field="distance_m",
            )


def _numbers(nodes: tuple[p.Node, ...], selectors: tuple[tuple[str, Selector], ...]) -> Iterator[PlannedNumber]:
    """Yield the numbers of nodes and selectors that differ from their defaults."""
    for node in nodes:
        if node.act is not None and node.act.count > 1:
            yield PlannedNumber(
                node=node.id, what="captures at a place", value=node.act.count, kind="count", field="captures"
            )
        if node.work is not None:
            for what, value in (("laps", node.work.laps), ("every n-th aisle", node.work.every)):
                if value > 1:
                    yield PlannedNumber(node=node.id, what=what, value=value, kind="count", field=what.split()[0])
        if node.at_most is not None:
            yield PlannedNumber(node=node.id, what="visits at most", value=node.at_most, kind="count", field="at_most")
        if node.rounds is not None and node.tested is None:
            yield PlannedNumber(node=node.id, what="rounds", value=node.rounds, kind="count", field="rounds")
    for name, x in selectors:
        for field in fields(x):
            value = getattr(x, field.name)
            if isinstance(value, bool) or value == field.default or isinstance(x, s.Where) or field.name == "value":
                continue
            if field.name == "off_m" and value == -OFF_EDGE_M:  # "next to" it, so far outside of its edge
                continue
            if field.name == "seed":
                continue  # it numbers draws from several groups
            what = re.sub("[-_]", " ", f"{element_name(type(x))} {field.name}")
            number = partial(PlannedNumber, node=name, what=what, field=field.name, selector=type(x))
            if isinstance(value, float):
                yield number(value=value, kind="percent" if field.name == "percent" else "length")
            elif isinstance(value, int) and abs(value) > 1:
                yield number(value=abs(value), kind="count")
