"""Points of ground without plants, and the same points of other ground: "do the same on the slope"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.plans import with_selector
from fieldhand.task import plan as p


def ground_of(step: p.Node) -> str | None:
    """Return the zone in which all places of a step are points of ground; None if there are others, or none."""
    found = {
        node.selector.zone if isinstance(node.selector, s.PointsIn | s.Transect | s.Grid) else ""
        for node in p.walk(step)
        if node.selector is not None
    }
    return (found.pop() or None) if len(found) == 1 else None


def on_ground(step: p.Node, zone: str) -> p.Node:
    """Return a step at the points of another zone.

    Args:
        step: Step at points of ground.
        zone: Name of the zone.
    """
    if step.act is not None:
        return step.act if step.act.at is None else replace(step.act, at=_in_zone(step.act.at, zone))
    if step.selector is not None:
        step = with_selector(step, _in_zone(step.selector, zone))
    return step.with_children([on_ground(child, zone) for child in step.children])


def _in_zone(points: s.Selector, zone: str) -> s.Selector:
    return replace(points, zone=zone) if isinstance(points, s.PointsIn | s.Transect | s.Grid) else points
