"""Quantities that a phrase about earlier missions leaves to the plan: "where it was high last time"."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import fields, replace
from typing import Any

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.earlier.work import OPEN_TIME, SAME_MEASURE
from fieldhand.planning.selections import swapped
from fieldhand.robot.model import RobotProfile
from fieldhand.task import plan as p

#: Beginning of the name of a quantity that the words do not name: only its unit is said, or nothing.
_BY_UNIT, _BY_NOTHING = "?", "??"


def unsaid(quantity: str, *, unit_said: bool = True) -> str:
    """Return the name of a quantity that a phrase may mean without naming it.

    Args:
        quantity: Quantity of the robot.
        unit_said: True if the words tell its unit.
    """
    return f"{_BY_UNIT if unit_said else _BY_NOTHING}{quantity}"


def tells_earlier_missions(plan: p.Node, robot: RobotProfile) -> bool:
    """Return True if clauses without a period ("already visited", "where CO2 was high") are about earlier missions.

    Behind work of this mission, what was done may be that work, and so may be readings behind those of the quantity.
    """
    nodes = list(p.walk(plan))
    for number, node in enumerate(nodes):
        for part in _parts_of(node):
            done, read = getattr(part, "action", ""), getattr(part, "quantity", "")
            if read.startswith(OPEN_TIME) and _name_of(read) in _measured(nodes[:number], robot):
                return False
            before = [list(_parts_of(one)) for one in nodes[:number] if one.selector is not None]
            if done.startswith(OPEN_TIME) and not all(part in parts for parts in before):
                return False
    return True


def _parts_of(node: p.Node) -> Iterator[s.Selector]:
    if node.selector is not None:
        yield from node.selector.walk()


def _name_of(quantity: str) -> str:
    return quantity.lstrip(f"{OPEN_TIME}{_BY_UNIT}")


def _measured(nodes: Iterable[p.Node], robot: RobotProfile) -> set[str]:
    """Return the quantities that the acts among some nodes measure."""
    acts = (node.act for node in nodes if node.act is not None)
    return {name for act in acts if act.action in robot.action for name in robot.action[act.action].measures}


def with_quantities(plan: p.Node, robot: RobotProfile) -> p.Node | None:
    """Return a plan with the quantities that its words leave unsaid; None if they mean others.

    Where the plan measures a quantity that may be meant, that one is meant.
    """
    if not any(_is_open(part) for node in p.walk(plan) if node.selector is not None for part in node.selector.walk()):
        return plan
    try:
        return _settled(plan, robot)
    except _MeansAnother:
        return None


class _MeansAnother(Exception):
    """The words mean another quantity."""


def _is_open(selector: s.Selector) -> bool:
    return _open_name(selector) != ""


def _open_name(selector: s.Selector) -> str:
    """Return the name of a quantity that is left open; empty if there is none."""
    names = [getattr(selector, field, "") for field in ("action", "quantity", "measured")]
    return next((name for name in names if name.startswith((_BY_UNIT, SAME_MEASURE, OPEN_TIME))), "")


def _settled(node: p.Node, robot: RobotProfile) -> p.Node:
    measured = _measured(p.walk(node), robot)
    children = node.children
    made = node.with_children([_settled(child, robot) for child in children]) if children else node
    selector = made.selector
    if selector is None or not any(map(_is_open, selector.walk())):
        return made
    settled = selector
    while (part := next((one for one in reversed(list(settled.walk())) if _is_open(one)), None)) is not None:
        settled = swapped(settled, part, _named(part, measured, robot))
    holders = [field.name for field in fields(made) if getattr(made, field.name) == selector]
    outer: Any = made
    changed: p.Node = replace(outer, **dict.fromkeys(holders, settled))
    return changed


def _named(selector: s.Selector, measured: set[str], robot: RobotProfile) -> s.Selector:
    """Return a selector with its quantity.

    Args:
        selector: Selector, whose quantity may be open.
        measured: Quantities that the step measures.
        robot: The robot.

    Raises:
        _MeansAnother: Another quantity is meant.
    """
    name = _open_name(selector)
    outer: Any = selector
    if not name:
        return selector
    if name.startswith(OPEN_TIME):
        field = "action" if getattr(selector, "action", "") == name else "quantity"
        settled: s.Selector = replace(outer, **{field: name.removeprefix(OPEN_TIME)})
        return settled
    if name == SAME_MEASURE:
        return _measured_so(outer, measured, robot)
    quantity = name.lstrip(_BY_UNIT)
    alike = measured if name.startswith(_BY_NOTHING) else _of_unit(measured, robot.quantity[quantity].unit, robot)
    if alike and quantity not in alike:
        raise _MeansAnother
    made: s.Selector = replace(outer, quantity=quantity)
    return made


def _of_unit(names: set[str], unit: str, robot: RobotProfile) -> set[str]:
    return {name for name in names if robot.quantity[name].unit == unit}


def _measured_so(selector: Any, measured: set[str], robot: RobotProfile) -> s.Selector:
    """Return places that were measured: what the step measures, or anything if it measures nothing."""
    if len(measured) > 1 or (not measured and selector.at_least > 1):
        raise _MeansAnother
    names = sorted(measured) or [quantity.name for quantity in robot.quantities]
    parts: tuple[s.Selector, ...] = tuple(replace(selector, measured=name) for name in names)
    return parts[0] if len(parts) == 1 else s.UnionOf(parts=parts)
