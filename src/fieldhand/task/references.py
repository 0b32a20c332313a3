"""What no schema can check: that the parts of a Task refer to each other rightly."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from fieldhand.places.selectors import Bound
from fieldhand.task import conditions
from fieldhand.task.capabilities import Capabilities
from fieldhand.task.conditions import Between, Compare, Condition, Level
from fieldhand.task.frames import Task
from fieldhand.task.plan import Node, walk


def references(task: Task, capabilities: Capabilities | None = None) -> tuple[str, ...]:
    """What is wrong with the references inside a Task, a sentence each with the node's id; empty if nothing is.

    Ids are unique; goals and state variables name actions of the plan; a place is bound before it is named; a reading
    is taken before it is tested, by a node that can come first on some branch, and neither by an optional step, which
    may be shed; a range has its low end first; nothing optional stands inside an optional step, nor that inside an
    optional for-each; optional visits have no given order; nested repeats do not multiply beyond ``MAX_ROUNDS``. With
    capabilities: each of those readings measures the quantity that is tested.
    """
    nodes = {node.id: node for node in walk(task.composition.plan)}
    problems = [*_ids(task), *_frames(task, nodes), *_endless(task.composition.plan)]
    problems.extend(_twice_optional(task.composition.plan))
    problems.extend(_ordered_optional(task.composition.plan))
    _visit(task.composition.plan, _Known(), _Found(problems=problems, capabilities=capabilities))
    return tuple(problems)


def _ids(task: Task) -> Iterator[str]:
    counts = Counter(node.id for node in walk(task.composition.plan))
    for name, count in counts.items():
        if not name:
            yield f"{count} nodes of the plan have no id"
        elif count > 1:
            yield f"{count} nodes of the plan have the id {name!r}"
    for name, count in Counter(goal.id for goal in task.command.goals).items():
        if count > 1:
            yield f"{count} goals have the id {name!r}"


def _frames(task: Task, nodes: Mapping[str, Node]) -> Iterator[str]:
    for goal in task.command.goals:
        act = nodes[goal.node].act if goal.node in nodes else None
        if act is None:
            yield f"goal {goal.id!r} names {goal.node!r}, which is no action of the plan"
        elif act.action != goal.action:
            yield f"goal {goal.id!r} counts {goal.action!r}, but its node {goal.node!r} does {act.action!r}"
    for variable in task.command.variables:
        act = nodes[variable.node].act if variable.node in nodes else None
        if act is None:
            yield f"state variable {variable.name!r} names {variable.node!r}, which is no action of the plan"
        elif act.reading != variable.name:
            yield f"state variable {variable.name!r} is not the reading that {variable.node!r} binds"


#: Rounds of nested repeats, multiplied: more than a robot makes in any mission.
MAX_ROUNDS = 100_000


def _endless(plan: Node, around: int = 1) -> Iterator[str]:
    """Repeats whose rounds multiply beyond all use; of nested ones the outermost at which they do."""
    rounds = around * (1 if plan.rounds is None else plan.rounds)
    if rounds > MAX_ROUNDS:
        yield f"node {plan.id!r} comes to {rounds:,} rounds, with the loops around it; {MAX_ROUNDS:,} is the most"
        return
    for child in plan.children:
        yield from _endless(child, rounds)


def _twice_optional(node: Node, around: Node | None = None) -> Iterator[str]:
    """Optional steps in, or around, what is optional: which of the two the guard would weigh is not said."""
    if around is not None and node.is_optional and (node.is_optional_step or around.is_optional_step):
        yield f"node {node.id!r} is optional inside {around.id!r}, which is optional as a whole; make one of them plain"
    for child in node.children:
        yield from _twice_optional(child, node if node.is_optional else around)


def _ordered_optional(plan: Node) -> Iterator[str]:
    """Optional visits in a given order: the solver chooses which are made, and in which order."""
    for node in walk(plan):
        if node.is_optional and node.visits_each and not node.in_any_order:
            yield (
                f"node {node.id!r} is optional and has a given order, which optional visits cannot keep: as many are"
                " made as fit, in the order that drives least; let a 'top' or 'take' choose which places, or leave out"
                " 'order'"
            )


@dataclass(frozen=True, kw_only=True)
class _Known:
    """What may be bound when a node is reached: labels, and for each reading the actions that may have taken it."""

    labels: frozenset[str] = frozenset()
    readings: Mapping[str, frozenset[str]] = field(default_factory=dict)

    def label(self, name: str) -> _Known:
        return _Known(labels=self.labels | {name}, readings=self.readings) if name else self

    def reading(self, name: str, action: str) -> _Known:
        """A reading taken anew replaces what was bound before."""
        return _Known(labels=self.labels, readings={**self.readings, name: frozenset({action})}) if name else self

    def within(self, names: _Known) -> _Known:
        """What is left of it where only names that were bound before count."""
        readings = {name: actions for name, actions in self.readings.items() if name in names.readings}
        return _Known(labels=self.labels & names.labels, readings=readings)

    def __or__(self, other: _Known) -> _Known:
        names = self.readings.keys() | other.readings.keys()
        none: frozenset[str] = frozenset()
        merged = {n: self.readings.get(n, none) | other.readings.get(n, none) for n in names}
        return _Known(labels=self.labels | other.labels, readings=merged)


@dataclass(frozen=True, kw_only=True)
class _Found:
    problems: list[str]
    capabilities: Capabilities | None
    #: Names that optional steps bind: nobody outside can count on them.
    shed: set[str] = field(default_factory=set)

    def add(self, problem: str) -> None:
        """Add a problem, once."""
        if problem not in self.problems:
            self.problems.append(problem)


def _visit(node: Node, known: _Known, found: _Found) -> _Known:
    """Check a node given what may be bound before it; returns what may be bound after it."""
    _check_places(node, known, found)
    known = known.label(node.label)
    if node.act is not None:
        known = known.reading(node.reading, node.act.action)
    after = node.flow(
        known,
        lambda child, before: _visit(child, before, found),
        lambda tester, before: _check_condition(tester, before, found),
    )
    if not node.is_optional_step:
        return after
    found.shed.update((after.labels | after.readings.keys()) - (known.labels | known.readings.keys()))
    return after.within(known)


_NOTHING_BINDS, _NOTHING_TAKES = "nothing before it binds", "nothing before it takes"


def _check_places(node: Node, known: _Known, found: _Found) -> None:
    selector = node.selector
    for part in selector.walk() if selector is not None else ():
        if isinstance(part, Bound) and part.label not in known.labels:
            by = "only an optional step binds: name it inside that" if part.label in found.shed else _NOTHING_BINDS
            found.add(f"node {node.id!r} names the place {part.label!r}, which {by}")


def _check_condition(node: Node, known: _Known, found: _Found) -> None:
    condition: Condition | None = node.tested
    for part in conditions.walk(condition) if condition is not None else ():
        if isinstance(part, Between) and part.low > part.high:
            found.add(
                f"node {node.id!r} tests whether the {part.quantity} is between {part.low:g} and {part.high:g}, which "
                "it never is: the low end comes first"
            )
        if not isinstance(part, Compare | Between | Level):
            continue
        actions = known.readings.get(part.reading)
        if actions is None:
            by = "only an optional step takes: test it inside that" if part.reading in found.shed else _NOTHING_TAKES
            found.add(f"node {node.id!r} tests the reading {part.reading!r}, which {by}")
            continue
        for action in sorted(actions) if found.capabilities else ():
            able = found.capabilities.actions.get(action) if found.capabilities else None
            if able is None or part.quantity not in able.measures:
                found.add(
                    f"node {node.id!r} tests the {part.quantity} of the reading {part.reading!r}, "
                    f"but {action} does not measure it"
                )
