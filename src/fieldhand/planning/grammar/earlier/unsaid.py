"""Quantities that a phrase about earlier missions leaves to the plan: "where it was high last time"."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.earlier.work import SAME_MEASURE
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
    names = (getattr(selector, "quantity", ""), getattr(selector, "measured", ""))
    return next((name for name in names if name.startswith((_BY_UNIT, SAME_MEASURE))), "")


def _settled(node: p.Node, robot: RobotProfile) -> p.Node:
    measured = {
        name
        for one in p.walk(node)
        if one.act is not None and one.act.action in robot.action
        for name in robot.action[one.act.action].measures
    }
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
