"""Points of ground without plants, the same points of other ground ("do the same on the slope"), and its corners."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.plans import with_selector
from fieldhand.planning.grammar.places.sampling import bare_zone
from fieldhand.planning.selections import as_corners, swapped
from fieldhand.site.model import Site
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


def with_bare_corners(step: p.Node, site: Site) -> p.Node:
    """Return a step at the corners of ground itself where a selector means those of ground without plants."""
    if step.act is not None:
        return step.act if step.act.at is None else replace(step.act, at=_in_bare_corners(step.act.at, site))
    if step.selector is not None:
        step = with_selector(step, _in_bare_corners(step.selector, site))
    return step.with_children([with_bare_corners(child, site) for child in step.children])


def _in_bare_corners(places: s.Selector, site: Site) -> s.Selector:
    for part in tuple(places.walk()):
        corners = as_corners(part)
        zone = "" if corners is None or corners.zone else _bare_ground(corners.of, site)
        if corners is not None and zone:
            places = swapped(places, part, s.Corners(which=corners.which, zone=zone))
    return places


def _bare_ground(area: s.Selector, site: Site) -> str:
    """Return the name of ground without plants; empty for other places."""
    if area != s.Trees():
        return bare_zone(area, site)
    bounds = [zone.name for zone in site.zones_of("boundary")]
    return bounds[0] if not site.trees and len(bounds) == 1 else ""
