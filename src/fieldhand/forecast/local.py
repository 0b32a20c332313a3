"""Conditions that only decide what is done on the spot: wherever they lead, the mission goes on from the same place."""

from __future__ import annotations

from fieldhand.task import conditions, plan
from fieldhand.task.plan import Act, If, Node, Repeat, Sequence, Try


def local_decisions(root: Node) -> tuple[str, ...]:
    """What is decided by work alone: no drive, no place, no reading or label that is used later hangs on it.

    At each visit of a loop such a decision can be made by itself, and the same answer at all of them takes most, or
    least. So the walks on which each of them is answered alike have every place and drive of a mission, and between
    them lies what any other takes.

    Returns:
        Ids of nodes with a condition, and for each action that is tried its id and ``fails``; in the plan's order.
    """
    if any(isinstance(n, Try) and any(map(_drives, plan.walk(n.body))) for n in plan.walk(root)):
        # After a drive that was given up the robot first has to come back to where it works.
        return ()
    found: list[str] = []
    _collect(root, root, found)
    return tuple(found)


def _collect(root: Node, node: Node, found: list[str]) -> None:
    decides = isinstance(node, Try) or plan.condition_of(node) is not None
    if decides and _on_the_spot(node) and not _used_outside(root, node):
        tried = {a.id for t in plan.walk(node) if isinstance(t, Try) for a in plan.walk(t.body) if isinstance(a, Act)}
        for inner in plan.walk(node):
            if plan.condition_of(inner) is not None:
                found.append(inner.id)
            elif inner.id in tried:
                found.append(f"{inner.id} fails")
        return
    for child in plan.children(node):
        _collect(root, child, found)


def _on_the_spot(node: Node) -> bool:
    match node:
        case Act():
            return node.at is None and not node.label
        case Sequence() | If() | Repeat():
            return all(map(_on_the_spot, plan.children(node)))
        case Try(body=body, otherwise=otherwise):
            steps = body.steps if isinstance(body, Sequence) else (body,)
            return all(isinstance(s, Act) and _on_the_spot(s) for s in steps) and _on_the_spot(otherwise)
        case _:
            return False


def _used_outside(root: Node, node: Node) -> bool:
    """Whether a reading that is bound in a node is tested anywhere else."""
    inside = {inner.id for inner in plan.walk(node)}
    bound = {inner.reading for inner in plan.walk(node) if isinstance(inner, Act) and inner.reading}
    for other in plan.walk(root):
        condition = None if other.id in inside else plan.condition_of(other)
        if condition is not None and bound & conditions.readings(condition):
            return True
    return False


def _drives(node: Node) -> bool:
    return plan.selector_of(node) is not None
