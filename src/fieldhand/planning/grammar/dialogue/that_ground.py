"""Ground that was spoken of before: "mow it", "drive round it"."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, TypeVar

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.state import DialogueState, NotComposed
from fieldhand.planning.grammar.dialogue.those_rows import with_known
from fieldhand.planning.grammar.meaning import THAT_GROUND
from fieldhand.planning.selections import are_rows, as_zone, is_one_row, parts
from fieldhand.task import plan as p

T = TypeVar("T")


def with_that_ground(state: DialogueState, command: T) -> tuple[DialogueState, T]:
    """Return a command with the ground that it calls "it", and the state, in which it was driven to.

    Raises:
        NotComposed: No zone was named before it, or several were.
    """
    ground = ground_spoken_of(state)
    zone = None if ground is None else as_zone(ground)

    def known(value: Any) -> s.Selector | None:
        if isinstance(value, s.PointAt) and value.origin == s.InZone(zone=THAT_GROUND):
            return replace(value, origin=_named_last(state))
        if isinstance(value, s.Beside) and value.of == s.InZone(zone=THAT_GROUND):
            return replace(value, of=_tree_named_last(state))
        if value == s.Middle(of=s.InZone(zone=THAT_GROUND)) and zone is not None:
            return s.PointsIn(zone=zone.zone)
        if value == s.InZone(zone=THAT_GROUND) and ground is not None:
            return ground
        if getattr(value, "zone", "") != THAT_GROUND:
            return None
        if zone is None:
            raise NotComposed(
                message("it is not clear which area is meant", context="fault"), advice=message("say its name")
            )
        named: s.Selector = replace(value, zone=zone.zone)
        return named

    changed: T = with_known(command, known)
    area = state.area or state.lead
    if changed is command or changed == command or area is None or area.place.selector != ground:
        return state, changed
    both: Any = changed
    return replace(state, area=None, lead=None), replace(both, used=both.used | area.used)


def _named_last(state: DialogueState) -> s.Selector:
    """Return what "it" is in "10 m west of it": the place named last, or that from which a point was measured.

    Raises:
        NotComposed: None was named, or several were.
    """
    last = state.lead or state.area
    nodes = [node for node in p.walk(state.plan) if node.selector is not None]
    place = last.place.selector if last is not None else nodes[-1].selector if nodes else None
    while place is not None and isinstance(point := place.members[0], s.PointAt):
        place = point.origin
    zone = getattr(place, "zone", "")
    if place is not None and zone and getattr(place, "part", "all") == "all":
        return s.InZone(zone=zone)
    if place is None or not place.single or place.relative:
        raise NotComposed(
            message("it is not clear which place is meant", context="fault"), advice=message("say its name")
        )
    return place


def _tree_named_last(state: DialogueState) -> s.Selector:
    """Return the tree named last, of which "then from the north" is another side.

    Raises:
        NotComposed: It was no tree.
    """
    found = _named_last(state)
    if not found.named_tree:
        raise NotComposed(message("it is not clear of what this is a side", context="fault"))
    return found.of if isinstance(found, s.Beside) else found


def ground_spoken_of(state: DialogueState) -> s.Selector | None:
    """Return the zone or the row of the last place; None if there is none, or several."""
    last = state.lead or state.area
    if last is not None:
        return _ground_of(last.place.selector)
    tested = next((test.place for test in state.decided.tests if test.place), None) if state.decided else None
    if state.open and tested is not None:
        return _ground_of(tested.selector)  # "if the warm one is hotter, ... in its middle"
    nodes = [node for node in p.walk(state.plan) if node.selector is not None and not node.selector.named_marker]
    return None if not nodes or nodes[-1].selector is None else _ground_of(nodes[-1].selector)


def _ground_of(selector: s.Selector) -> s.Selector | None:
    found = set(_grounds_in(selector))
    return found.pop() if len(found) == 1 else None


def _grounds_in(selector: s.Selector) -> Iterator[s.Selector]:
    """Yield the zones and the single rows in a selector; of a half of one it yields nothing."""
    zone = as_zone(selector)
    if zone is not None and not zone.outside and not zone.margin_m:
        yield s.InZone(zone=zone.zone)
        return
    if are_rows(selector) and is_one_row(selector) and not selector.relative:
        yield selector
        return
    name = getattr(selector, "zone", "")
    of_all = getattr(selector, "part", "all") == "all" or getattr(selector, "shape", "") == "edge"
    if name and zone is None and of_all:
        yield s.InZone(zone=name)
    for part in parts(selector):
        yield from _grounds_in(part)
