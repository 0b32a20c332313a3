"""Check what no schema can: that the parts of a Task refer to each other correctly."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from fieldhand.places.selectors import Bound
from fieldhand.task import conditions
from fieldhand.task.aggregates import CompareSeries, MeanKnown, series_faults, series_of
from fieldhand.task.capabilities import Capabilities
from fieldhand.task.conditions import Between, Compare, Condition, Level
from fieldhand.task.frames import Task
from fieldhand.task.plan import Node, walk


@dataclass(frozen=True, kw_only=True)
class ReferenceProblem:
    """A faulty reference inside a Task.

    Attributes:
        what: One sentence that names the node or the goal.
        node: Id of the plan node it is found at, empty if there is none.
    """

    what: str
    node: str = ""


def references(task: Task, capabilities: Capabilities | None = None) -> tuple[str, ...]:
    """Return the sentences of :func:`reference_problems`."""
    return tuple(problem.what for problem in reference_problems(task, capabilities))


def reference_problems(task: Task, capabilities: Capabilities | None = None) -> tuple[ReferenceProblem, ...]:
    """Return the faulty references inside a Task, each once; empty if there are none.

    Rules: ids are unique; goals and state variables name actions of the plan; a label is bound before it is used; a
    reading is taken before it is tested, by a node that can precede the test on some branch and is not inside an
    optional step, which may be shed; ranges have their low end first; no optional work is nested in an optional step,
    nor an optional step in an optional for-each; optional visits have no fixed order; nested repeats do not multiply
    beyond ``MAX_ROUNDS``. With capabilities: the actions that take a tested reading measure the tested quantity.
    """
    nodes = {node.id: node for node in walk(task.composition.plan)}
    problems = [*_ids(task), *_frames(task, nodes), *_endless(task.composition.plan)]
    problems.extend(_twice_optional(task.composition.plan))
    problems.extend(_ordered_optional(task.composition.plan))
    problems.extend(_never_collected(task.composition.plan))
    _visit(task.composition.plan, _Known(), _ReferenceCheck(problems=problems, capabilities=capabilities))
    return tuple(problems)


def _ids(task: Task) -> Iterator[ReferenceProblem]:
    counts = Counter(node.id for node in walk(task.composition.plan))
    for name, count in counts.items():
        if not name:
            yield ReferenceProblem(what=f"{count} nodes of the plan have no id")
        elif count > 1:
            yield ReferenceProblem(node=name, what=f"{count} nodes of the plan have the id {name!r}")
    for name, count in Counter(goal.id for goal in task.command.goals).items():
        if count > 1:
            yield ReferenceProblem(what=f"{count} goals have the id {name!r}")


def _frames(task: Task, nodes: Mapping[str, Node]) -> Iterator[ReferenceProblem]:
    for goal in task.command.goals:
        named = nodes.get(goal.node)
        act = None if named is None else named.act or named.work
        what = ""
        if act is None or not act.action:
            what = f"goal {goal.id!r} names {goal.node!r}, which is not an action of the plan"
        elif act.action != goal.action:
            what = f"goal {goal.id!r} counts {goal.action!r}, but its node {goal.node!r} does {act.action!r}"
        if what:
            yield ReferenceProblem(node=goal.node if goal.node in nodes else "", what=what)
    for variable in task.command.variables:
        act = nodes[variable.node].act if variable.node in nodes else None
        what = ""
        if act is None:
            what = f"state variable {variable.name!r} names {variable.node!r}, which is not an action of the plan"
        elif act.reading != variable.name:
            what = f"state variable {variable.name!r} is not the reading that {variable.node!r} binds"
        if what:
            yield ReferenceProblem(node=variable.node if variable.node in nodes else "", what=what)


#: Maximum product of the rounds of nested repeats; no real mission needs as many.
MAX_ROUNDS = 100_000


def _endless(plan: Node, around: int = 1) -> Iterator[ReferenceProblem]:
    """Yield a problem for each outermost repeat at which the product of rounds exceeds the maximum."""
    rounds = around * (1 if plan.rounds is None else plan.rounds)
    if rounds > MAX_ROUNDS:
        what = f"node {plan.id!r} can run {rounds:,} rounds, including the loops around it; {MAX_ROUNDS:,} is the most"
        yield ReferenceProblem(node=plan.id, what=what)
        return
    for child in plan.children:
        yield from _endless(child, rounds)


def _twice_optional(node: Node, around: Node | None = None) -> Iterator[ReferenceProblem]:
    """Yield a problem for each optional step nested in, or around, optional work: the guard could not decide which to
    shed.
    """
    if around is not None and node.is_optional and (node.is_optional_step or around.is_optional_step):
        what = f"node {node.id!r} is optional inside {around.id!r}, which is itself optional; make only one so"
        yield ReferenceProblem(node=node.id, what=what)
    for child in node.children:
        yield from _twice_optional(child, node if node.is_optional else around)


def _ordered_optional(plan: Node) -> Iterator[ReferenceProblem]:
    """Yield a problem for each for-each with optional visits in a fixed order: the solver chooses visits and order."""
    for node in walk(plan):
        if node.is_optional and node.visits_each and not node.in_any_order:
            yield ReferenceProblem(
                node=node.id,
                what=f"node {node.id!r} is optional and has a given order, which optional visits cannot keep: as many"
                " are made as fit, in the order that drives least; let a 'top' or 'take' choose which places, or leave"
                " out 'order'",
            )


def _never_collected(plan: Node) -> Iterator[ReferenceProblem]:
    """Yield a problem for each loop that begins the series of a reading that nothing inside takes."""
    for node in walk(plan):
        if node.collects and all(inner.reading != node.collects for inner in walk(node)):
            what = f"node {node.id!r} collects the reading {node.collects!r}, which nothing inside it takes"
            yield ReferenceProblem(node=node.id, what=what)


@dataclass(frozen=True, kw_only=True)
class _Known:
    """Bindings possible when a node is reached: labels, and for each reading the actions that may have taken it."""

    labels: frozenset[str] = frozenset()
    readings: Mapping[str, frozenset[str]] = field(default_factory=dict)

    def label(self, name: str) -> _Known:
        return _Known(labels=self.labels | {name}, readings=self.readings) if name else self

    def reading(self, name: str, action: str) -> _Known:
        """Return the bindings after a reading was taken anew, which replaces the previous one."""
        return _Known(labels=self.labels, readings={**self.readings, name: frozenset({action})}) if name else self

    def within(self, names: _Known) -> _Known:
        """Return the bindings restricted to names that were bound before."""
        readings = {name: actions for name, actions in self.readings.items() if name in names.readings}
        return _Known(labels=self.labels & names.labels, readings=readings)

    def __or__(self, other: _Known) -> _Known:
        names = self.readings.keys() | other.readings.keys()
        none: frozenset[str] = frozenset()
        merged = {n: self.readings.get(n, none) | other.readings.get(n, none) for n in names}
        return _Known(labels=self.labels | other.labels, readings=merged)


@dataclass(frozen=True, kw_only=True)
class _ReferenceCheck:
    problems: list[ReferenceProblem]
    capabilities: Capabilities | None
    #: Names bound inside optional steps, which are unreliable outside.
    shed: set[str] = field(default_factory=set)

    def add(self, node: Node, what: str) -> None:
        """Add a problem of a node, once."""
        problem = ReferenceProblem(node=node.id, what=what)
        if problem not in self.problems:
            self.problems.append(problem)


def _visit(node: Node, known: _Known, check: _ReferenceCheck) -> _Known:
    """Check a node given the bindings possible before it, and return those possible after it."""
    _check_places(node, known, check)
    known = known.label(node.label)
    if node.act is not None:
        known = known.reading(node.reading, node.act.action)
    after = node.flow(
        known,
        lambda child, before: _visit(child, before, check),
        lambda tester, before: _check_condition(tester, before, check),
    )
    if not node.is_optional_step:
        return after
    check.shed.update((after.labels | after.readings.keys()) - (known.labels | known.readings.keys()))
    return after.within(known)


_NOTHING_BINDS, _NOTHING_TAKES = "nothing before it binds", "nothing before it takes"


def _check_places(node: Node, known: _Known, check: _ReferenceCheck) -> None:
    selector = node.selector
    for part in selector.walk() if selector is not None else ():
        if isinstance(part, Bound) and part.label not in known.labels:
            by = "only an optional step binds: name it inside that" if part.label in check.shed else _NOTHING_BINDS
            check.add(node, f"node {node.id!r} names the place {part.label!r}, which {by}")
        if part.by_series is not None:
            _check_reading(node, "chooses places by", *part.by_series, known, check)


def _check_condition(node: Node, known: _Known, check: _ReferenceCheck) -> None:
    condition: Condition | None = node.tested
    for part in conditions.walk(condition) if condition is not None else ():
        if isinstance(part, Between) and part.low > part.high:
            check.add(
                node,
                f"node {node.id!r} tests whether the {part.quantity} is between {part.low:g} and {part.high:g}, which "
                "is impossible: give the low end first",
            )
        if isinstance(part, Compare | Between | Level):
            _check_reading(node, "tests", part.reading, part.quantity, known, check)
        elif isinstance(part, MeanKnown | CompareSeries):
            for reading in series_of(part):
                _check_reading(node, "tests", reading, part.quantity, known, check)
        for what in series_faults(part):
            check.add(node, f"node {node.id!r} {what}")


def _check_reading(node: Node, uses: str, reading: str, quantity: str, known: _Known, check: _ReferenceCheck) -> None:
    """Check that a reading that a node uses was taken, by actions that measure the quantity."""
    actions = known.readings.get(reading)
    if actions is None:
        by = "only an optional step takes: test it inside that" if reading in check.shed else _NOTHING_TAKES
        check.add(node, f"node {node.id!r} {uses} the reading {reading!r}, which {by}")
        return
    for action in sorted(actions) if check.capabilities else ():
        able = check.capabilities.actions.get(action) if check.capabilities else None
        if able is None or quantity not in able.measures:
            check.add(
                node,
                f"node {node.id!r} {uses} the {quantity} of the reading {reading!r}, but {action} does not measure it",
            )
