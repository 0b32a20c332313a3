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
    found = {zone_of_points(node.selector) for node in p.walk(step) if node.selector is not None}
    return (found.pop() or None) if len(found) == 1 else None


def zone_of_points(places: s.Selector) -> str:
    """Return the zone of which places are points of ground; empty if there are others, or of several zones."""
    found = {one.zone if isinstance(one, s.PointsIn | s.Transect | s.Grid) else "" for one in places.members}
    return found.pop() if len(found) == 1 else ""


def on_ground(step: p.Node, zone: str) -> p.Node:
    """Return a step at the points of another zone.

    Args:
        step: Step at points of ground.
        zone: Name of the zone.
    """
    if step.act is not None:
        return step.act if step.act.at is None else replace(step.act, at=in_zone(step.act.at, zone))
    if step.selector is not None:
        step = with_selector(step, in_zone(step.selector, zone))
    return step.with_children([on_ground(child, zone) for child in step.children])


def in_zone(points: s.Selector, zone: str) -> s.Selector:
    """Return points of ground as those of another zone; a point at the edge of one is in the middle of the other."""
    if isinstance(points, s.UnionOf):
        return replace(points, parts=tuple(in_zone(one, zone) for one in points.parts))
    if isinstance(points, s.Transect) and points == s.Transect(
        count=1, shape="edge", zone=points.zone, off_m=points.off_m
    ):
        return s.PointsIn(zone=zone, count=1)
    return replace(points, zone=zone) if isinstance(points, s.PointsIn | s.Transect | s.Grid) else points


def with_bare_corners(plan: p.Node, site: Site) -> p.Node:
    """Return a plan at the corners of ground itself where its selectors mean those of ground without plants.

    On a site without plants, corners of nothing are those of the site, unless the plan names other ground.
    """
    bounds = [zone.name for zone in site.zones_of("boundary")]
    places = [node.selector for node in p.walk(plan) if node.selector is not None]
    named = any(getattr(part, "zone", "") for place in places for part in place.walk())
    return _with_bare_corners(plan, site, bounds[0] if len(bounds) == 1 and not site.trees and not named else "")


def _with_bare_corners(step: p.Node, site: Site, whole: str) -> p.Node:
    if step.act is not None:
        return step.act if step.act.at is None else replace(step.act, at=_in_bare_corners(step.act.at, site, whole))
    if step.selector is not None:
        step = with_selector(step, _in_bare_corners(step.selector, site, whole))
    return step.with_children([_with_bare_corners(child, site, whole) for child in step.children])


def _in_bare_corners(places: s.Selector, site: Site, whole: str) -> s.Selector:
    for part in tuple(places.walk()):
        corners = as_corners(part)
        if corners is None or corners.zone:
            continue
        zone = whole if corners.of == s.Trees() else bare_zone(corners.of, site)
        if zone:
            places = swapped(places, part, s.Corners(which=corners.which, zone=zone))
    return places
