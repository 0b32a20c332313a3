"""Lists of what a robot can do and what a site contains, to offer in place of what was requested."""

from __future__ import annotations

from collections.abc import Iterator

from fieldhand.language import Message, Number, joined, message
from fieldhand.language.words import listed, say_action, say_gate, say_marker, say_zone, some_names
from fieldhand.planning.english.wishes import Offers
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.terms import Value
from fieldhand.wording.watches import say_event

#: Longest lists of places and of values that are shown.
_MOST_PLACES, _MOST_VALUES = 8, 4
#: An attribute with more different texts than this is a name or an id.
_MOST_TEXTS = 50


def say_offers(kind: Offers, site: Site, robot: RobotProfile) -> str:
    """Return what the robot or the site has of a kind; empty if it has nothing."""
    match kind:
        case "actions":
            return listed([say_action(action.name) for action in robot.actions], "or")
        case "places":
            return some_names(list(say_places(site)), _MOST_PLACES)
        case "events":
            return listed([say_event(event.name, robot) for event in robot.events]) or message("nothing")
        case "properties":
            return some_names(list(_properties(site)), _MOST_PLACES)
        case "":
            return ""


def say_places(site: Site) -> Iterator[str]:
    """Yield the places of a site that requests can name: gates, markers, zones, blocks and rows."""
    yield from (say_gate(gate.place.id) for gate in site.gates)
    yield from (say_marker(name) for name in site.markers)
    yield from (say_zone(zone.name) for zone in site.zones if zone.kind != "boundary")
    planting = site.planting
    if len(planting.blocks) > 1:
        yield from (message("block {name}", name=block.name) for block in planting.blocks)
    if planting.rows:
        yield message("row {there}", there=some_names([row.name for row in planting.blocks[0].rows], 3))
    yield message("tree {id}", id=site.trees[0].place.id)


def _properties(site: Site) -> Iterator[Message]:
    """Yield the attributes of the trees with their values."""
    for name, values in site.attributes.items():
        if name in ("id", "row") or len(values) < 2:
            continue
        text = _say_values(values)
        if text:
            yield message("{name} ({values})", name=name, values=text)


def _say_values(values: tuple[Value, ...]) -> str:
    texts = [value for value in values if isinstance(value, str)]
    numbers = [value for value in values if isinstance(value, float | int) and not isinstance(value, bool)]
    if texts and len(texts) <= _MOST_TEXTS:
        return some_names(texts, _MOST_VALUES)
    if numbers and not texts:
        low, high = min(numbers), max(numbers)
        return message("{low} to {high}", low=Number(f"{low:g}"), high=Number(f"{high:g}"))
    return joined("", ())
