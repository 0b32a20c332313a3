"""Decisions that only affect the work at the current place, not where the mission continues."""

from __future__ import annotations

from fieldhand.task import conditions
from fieldhand.task.plan import Node, acts, walk


def local_decisions(root: Node) -> tuple[str, ...]:
    """Return the decisions on which no drive, place, or later reading or label depends.

    At each visit of a loop such a decision is independent of the others, and resource use is highest or lowest if all
    of them have the same answer. So the walks with constant answers cover every place and drive of a mission, and bound
    the resource use of all other branches.

    Returns:
        Ids of nodes with a condition, and for each action inside a ``Try`` its id and ``fails``; in plan order.
    """
    if any(inner.selector is not None for n in walk(root) for body in n.caught for inner in walk(body)):
        # After an abandoned drive the robot first has to return to its place of work.
        return ()
    keys: list[str] = []
    _collect(root, root, keys)
    return tuple(keys)


def _collect(root: Node, node: Node, keys: list[str]) -> None:
    decides = bool(node.caught) or node.tested is not None
    if decides and _on_the_spot(node) and not _used_outside(root, node):
        tried = {act.id for inner in walk(node) for body in inner.caught for act in acts(body)}
        for inner in walk(node):
            if inner.tested is not None:
                keys.append(inner.id)
            elif inner.id in tried:
                keys.append(f"{inner.id} fails")
        return
    for child in node.children:
        _collect(root, child, keys)


def _on_the_spot(node: Node) -> bool:
    return all(_stays(inner) and all(map(_is_straight, inner.caught)) for inner in walk(node))


def _stays(node: Node) -> bool:
    """Return True if the node itself neither moves the robot nor refers to a place nor ends the plan."""
    moves = node.selector is not None or bool(node.label) or node.in_any_order
    return not (moves or node.is_optional or node.ends_plan)


def _is_straight(body: Node) -> bool:
    """Return True if the steps of a body are its actions, each once."""
    return all(step.act is not None for step in (body.children if body.is_series else (body,)))


def _used_outside(root: Node, node: Node) -> bool:
    """Return True if a reading bound in a node is tested elsewhere."""
    inside = {inner.id for inner in walk(node)}
    bound = {inner.reading for inner in walk(node)} - {""}
    for other in walk(root):
        condition = None if other.id in inside else other.tested
        if condition is not None and bound & conditions.readings(condition):
            return True
    return False
