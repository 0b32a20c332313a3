"""Plans while they are made: their parts by path, changed copies of them, and the finished plan."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import count
from typing import Any, cast

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.faults import NotComposed
from fieldhand.planning.grammar.meaning import wait_seconds
from fieldhand.planning.selections import as_random, swapped
from fieldhand.robot.model import RobotProfile
from fieldhand.task import plan as p

#: Steps from the plan's root to a node: indices of steps, and the names of the fields that hold the inner nodes.
Path = tuple[int | str, ...]

#: Seed of a draw that is to be the one before it.
_AGAIN = -1
#: Block without steps.
EMPTY = p.InOrder(id="", steps=())


def node_at(plan: p.InOrder, path: Path) -> p.Node:
    """Return the node at a path."""
    node: Any = plan
    for step in path:
        node = node.steps[step] if isinstance(step, int) else getattr(node, step)
    return cast(p.Node, node)


def block_at(plan: p.InOrder, path: Path) -> p.InOrder:
    """Return the block at a path.

    Raises:
        NotComposed: The node there is no block.
    """
    block = node_at(plan, path)
    if not isinstance(block, p.InOrder):
        raise NotComposed(message("it is not clear to which steps this belongs", context="fault"))
    return block


def for_each_at(plan: p.InOrder, path: Path) -> p.ForEach:
    """Return the for-each at a path.

    Raises:
        NotComposed: The node there is no for-each.
    """
    loop = as_for_each(node_at(plan, path))
    if loop is None:
        raise NotComposed(message("it is not clear to which places this belongs", context="fault"))
    return loop


def as_for_each(node: p.Node) -> p.ForEach | None:
    """Return the node if it is a for-each, None otherwise."""
    return node if isinstance(node, p.ForEach) else None


def as_choice(node: p.Node) -> p.If | None:
    """Return the node if it is a condition, None otherwise."""
    return node if isinstance(node, p.If) else None


def with_node(plan: p.InOrder, path: Path, made: p.Node) -> p.InOrder:
    """Return a plan with another node at a path."""
    return cast(p.InOrder, _changed(plan, path, made))


def _changed(node: Any, path: Path, made: p.Node) -> Any:
    """Return a node with another one at a path inside it."""
    if not path:
        return made
    step, *rest = path
    if isinstance(step, int):
        steps = list(node.steps)
        steps[step] = _changed(steps[step], tuple(rest), made)
        return replace(node, steps=tuple(steps))
    return replace(node, **{step: _changed(getattr(node, step), tuple(rest), made)})


def walk(node: p.Node, path: Path = ()) -> Iterator[tuple[Path, p.Node]]:
    """Yield this node and all nodes inside it with their paths, outermost first."""
    yield path, node
    if isinstance(node, p.InOrder):
        for k, step in enumerate(node.steps):
            yield from walk(step, (*path, k))
        return
    for name in ("body", "then", "otherwise"):
        inner = getattr(node, name, None)
        if isinstance(inner, p.Node):
            yield from walk(inner, (*path, name))


def last_capture(plan: p.InOrder) -> Path | None:
    """Return the path of the last capture of a plan; None if it has none."""
    found = [path for path, node in walk(plan) if node.act is not None and wait_seconds(node.act.action) is None]
    return found[-1] if found else None


def is_inside(path: Path, outer: Path) -> bool:
    """Return True if a path leads to a node or to one inside it."""
    return path[: len(outer)] == outer


def is_conditional(path: Path) -> bool:
    """Return True if a path leads into one of the cases of a condition."""
    return "then" in path or "otherwise" in path


def captures_at_last_place(steps: Sequence[p.Node]) -> list[p.Act]:
    """Return the captures since the last place, if there was nothing but captures."""
    found: list[p.Act] = []
    for step in reversed(steps):
        if step.act is not None and step.act.at is None and wait_seconds(step.act.action) is not None:
            continue
        if step.act is None:
            if step.only_drives:
                return found
            return _captures_of_visits(step) if step.visits_each and not found else []
        found.insert(0, step.act)
        if step.act.at is not None:
            return found
    return found


def _captures_of_visits(loop: p.Node) -> list[p.Act]:
    """Return the captures of a for-each that does nothing else at its places."""
    steps = [step for block in loop.children for step in block.children]
    acts = [step.act for step in steps if step.act is not None]
    return acts if len(acts) == len(steps) else []


def whole_plan(plan: p.InOrder) -> p.Node:
    """Return the plan of a request: without a stop at its end, and without blocks of one step."""
    steps = plan.steps
    while len(steps) > 1 and steps[-1].ends_plan:
        steps = steps[:-1]
    return with_seeds(finished(cast(p.InOrder, with_waits(replace(plan, steps=steps)))), count())


def measured(robot: RobotProfile, action: str) -> tuple[str, ...]:
    """Return what an action measures; nothing for a wait."""
    known = robot.action.get(action)
    return () if known is None else known.measures


def with_waits(node: p.Node) -> p.Node:
    """Return a plan with waits in place of the captures as which they were read."""
    seconds = None if node.act is None else wait_seconds(node.act.action)
    if node.act is not None and seconds is not None:
        return _wait(node.act, seconds)
    if isinstance(node, p.InOrder):
        steps: list[p.Node] = []
        for step in node.steps:
            made = with_waits(step)
            steps.extend(made.children if step.act is not None and made.is_series else (made,))
        return replace(node, steps=tuple(steps))
    return node.with_children([with_waits(child) for child in node.children])


def _wait(act: p.Act, seconds: float) -> p.Node:
    wait = p.Wait(id="", seconds=seconds * act.count, said=act.said)
    if act.at is None:
        return wait
    return p.InOrder(id="", steps=(p.GoTo(id="", place=act.at, label=act.label, said=act.at_said), wait))


def with_selector(node: p.Node, selector: s.Selector) -> p.Node:
    """Return a step with another place."""
    changed: Any = node
    names = [name for name in node.__dataclass_fields__ if getattr(node, name) is node.selector]
    made: p.Node = replace(changed, **dict.fromkeys(names, selector))
    return made


def is_idle_case(node: p.Node) -> bool:
    """Return True for a condition on which nothing depends ("if it is low, leave it")."""
    case = as_choice(node)
    return case is not None and case.then == EMPTY and case.otherwise is None


def without_idle_cases(plan: p.InOrder) -> p.InOrder:
    """Return a plan without conditions on which nothing depends."""
    return cast(p.InOrder, _without_idle(plan))


def _without_idle(node: p.Node) -> p.Node:
    """Return a node without the conditions inside it on which nothing depends."""
    if isinstance(node, p.InOrder):
        return replace(node, steps=tuple(_without_idle(step) for step in node.steps if not is_idle_case(step)))
    return node.with_children([_without_idle(child) for child in node.children])


def with_seeds(node: p.Node, seeds: Iterator[int], known: dict[s.Selector, int] | None = None) -> p.Node:
    """Return a plan in which each draw at random has a seed of its own, so that two draws are independent.

    Args:
        node: The plan.
        seeds: Seeds that are not taken yet.
        known: Seeds of the draws before it, which those that are :func:`drawn_again` get.
    """
    known = {} if known is None else known
    selector = node.selector
    if selector is not None:
        drawn = selector
        for part in selector.walk():
            if (sample := as_random(part)) is not None:
                fresh = replace(sample, seed=0)
                if sample.seed != _AGAIN or fresh not in known:
                    known[fresh] = next(seeds)
                drawn = swapped(drawn, sample, replace(sample, seed=known[fresh]))
        node = with_selector(node, drawn)
    return node.with_children([with_seeds(child, seeds, known) for child in node.children])


def drawn_again(selector: s.Selector) -> s.Selector:
    """Return places that were drawn before, as the same ones."""
    for part in selector.walk():
        if (sample := as_random(part)) is not None:
            selector = swapped(selector, sample, replace(sample, seed=_AGAIN))
    return selector


def finished(node: p.Node) -> p.Node:
    """Return a plan without blocks of one step; a place that is only visited is driven to."""
    inner = [finished(child) for child in node.children]
    if isinstance(node, p.InOrder):
        return inner[0] if len(inner) == 1 else node.with_children(inner)
    if node.visits_each and node.children == (EMPTY,):
        return node.with_children([p.GoTo(id="", place=s.Here(), said=node.said)])
    visits = as_for_each(inner[0]) if node.is_optional_step else None
    if visits is not None and visits.optional:  # one by one, so they need not be optional as a whole
        return replace(visits, said=(*node.said, *visits.said))
    return node.with_children(inner)
