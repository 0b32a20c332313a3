"""Resolve on the site what a mission keeps away from, as ground that is closed to its drives."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.language.words import say_gate, say_number, say_zone
from fieldhand.places.context import Context
from fieldhand.places.wording import SelectorWording
from fieldhand.site.model import Site

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

    from fieldhand.places.selector import Selector
    from fieldhand.site.closed_ground import ClosedGround
    from fieldhand.site.drives import Drives
    from fieldhand.task.frames import Constraints
    from fieldhand.task.ways import Avoid


def closed_ground(constraints: Constraints, drives: Drives) -> tuple[ClosedGround, ...]:
    """Return the ground that the constraints of a mission close to its drives.

    Args:
        constraints: Constraints of the mission.
        drives: Drives of the robot on the site without them.

    Raises:
        PlaceError: A selector finds nothing, needs a position of the robot, or names places without an extent.
    """
    from fieldhand.site.closed_ground import ClosedGround, opening_of

    found = [avoided(one, drives) for one in constraints.avoid]
    allowed = {_gate(one.gate, drives.site) for one in constraints.only_gates}
    if allowed:
        found.extend(
            ClosedGround(
                rule=message("not pass {gate}", gate=say_gate(gate.place.id)),
                inside=message("at {gate}", gate=say_gate(gate.place.id)),
                shape=opening_of(gate),
            )
            for gate in drives.site.gates
            if gate.place.id not in allowed
        )
    return tuple(found)


def avoided(avoid: Avoid, drives: Drives) -> ClosedGround:
    """Return the ground of one avoidance.

    Raises:
        PlaceError: As :func:`closed_ground`.
    """
    return ground_of(avoid.places, avoid.distance_m, drives)


def ground_of(places: Selector, distance_m: float, drives: Drives) -> ClosedGround:
    """Return the ground of places, or within a distance of them, with the rule that closes it.

    Raises:
        PlaceError: As :func:`closed_ground`.
    """
    from fieldhand.site.closed_ground import ClosedGround, at_distance

    if places.relative:
        raise PlaceError(
            message("what is avoided depends on where the robot is: {places}", places=say_avoided(places)),
            advice=message("name rows, a zone, a marker or a tree"),
        )
    shape, trees = _shape(places, distance_m, drives)
    metres = distance_m + _margin_m(places)
    if not metres:
        inside = message("in {place}", place=say_avoided(places))
    else:
        inside = message("within {distance} m of {place}", distance=say_number(metres), place=say_avoided(places))
    return ClosedGround(rule=_rule(places, metres), inside=inside, shape=at_distance(shape, metres), trees=trees)


def say_avoidance(avoid: Avoid) -> str:
    """Return an avoidance in words that follow "must": "keep out of row 10", "keep 5 m from the pond"."""
    return _rule(avoid.places, avoid.distance_m + _margin_m(avoid.places))


def _rule(places: Selector, metres: float) -> str:
    if not metres:
        return message("keep out of {place}", place=say_avoided(places))
    return message("keep {distance} m from {place}", distance=say_number(metres), place=say_avoided(places))


def say_avoided(places: Selector) -> str:
    """Return what the robot keeps away from, in words: "row 10", "the wet corner"."""
    zone = _zone(places)
    if zone:
        return say_zone(zone)
    phrase = SelectorWording({}).phrase(places)
    if phrase.bare and phrase.rows_and_block:
        return phrase.rows_and_block
    return phrase.say()


def _zone(places: Selector) -> str:
    """Return the zone that is meant itself, with or without a margin; empty for trees and other places."""
    from fieldhand.places.filters.in_zone import InZone
    from fieldhand.places.sources.trees import Trees

    if isinstance(places, InZone) and places.of == Trees() and not places.outside:
        return places.zone
    return ""


def _margin_m(places: Selector) -> float:
    """Return the distance from a zone that the selector itself adds."""
    margin_m: float = getattr(places, "margin_m", 0.0) if _zone(places) else 0.0
    return margin_m


def _shape(places: Selector, distance_m: float, drives: Drives) -> tuple[BaseGeometry, frozenset[int]]:
    """Return the outline of places before a distance is added, and the trees that it lies beside."""
    import shapely

    from fieldhand.places.filters.zones import zones_called
    from fieldhand.places.resolution import Resolution
    from fieldhand.site.closed_ground import along_trees, beside_trees, between_rows, opening_of

    site = drives.site
    if zones := zones_called(site, _zone(places)):
        return shapely.union_all(zones), frozenset()
    group = Resolution(site, Context(here=site.start)).spots(places)
    trees = [site.by_id[place.id].index for place in group.places if place.kind == "tree"]
    gates = {gate.place.xy: gate for gate in site.gates}
    if distance_m <= 0.0 and all(place.xy in gates for place in group.places):
        return shapely.union_all([opening_of(gates[place.xy]) for place in group.places]), frozenset()
    points = [shapely.Point(place.xy) for place in group.places if place.kind != "tree"]
    if points and distance_m <= 0.0:
        raise PlaceError(
            message("it is not said how far to keep from {place}", place=say_avoided(places)),
            advice=message("give a distance: 'keep 5 m from it'"),
        )
    if distance_m <= 0.0:
        return beside_trees(site, drives.layout, trees, drives.standoff_m), frozenset(trees)
    lines = [along_trees(site, trees), between_rows(site, drives.layout, trees)] if trees else []
    return shapely.union_all([*lines, *points]), frozenset()


def _gate(name: str, site: Site) -> str:
    """Return the gate of a name, as the site's file writes it.

    Raises:
        PlaceError: There is none.
    """
    from fieldhand.places.resolution import resolve_one
    from fieldhand.places.sources.gate_is import GateIs

    return resolve_one(GateIs(gate=name), site, Context(here=site.start)).id
