"""Captures whose number is shared out behind them: "two pictures of the oak, one from each end"."""

from __future__ import annotations

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace
from typing import Any, cast

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.those_rows import with_known
from fieldhand.planning.grammar.meaning import (
    LAST_THING,
    THAT_GROUND,
    UNKNOWN_THINGS,
    CaptureCommand,
    Lead,
    LinkedCommand,
    PlaceMeaning,
)

_IT = frozenset({THAT_GROUND})


def shared_out(clauses: Sequence[LinkedCommand]) -> tuple[LinkedCommand, ...]:
    """Return clauses in which captures that are shared out at once among places are made at these only.

    The numbers of the parts add up to that of the whole; else they are further captures.
    """
    made = list(clauses)
    at = 0
    while at < len(made) - 1:
        parts = _parts_of(made[at], made[at + 1 :])
        if len(parts) > 1:
            made[at : at + 1 + len(parts)] = _at_parts(made[at], parts)
        elif in_area := _shared_in_area(made[at], made[at + 1 :]):
            made[at : at + len(in_area)] = in_area
        at += 1
    return tuple(made)


def _shared_in_area(whole: LinkedCommand, following: Sequence[LinkedCommand]) -> list[LinkedCommand]:
    """Return "soil moisture on the slope, one in each corner" as the area, and what is captured in it.

    The result is empty if a number is said of the area, or if nothing is shared out right behind it.
    """
    command = whole.command
    if not isinstance(command, CaptureCommand) or len(command.things) != 1 or command.place is None:
        return []
    (thing,), place = command.things, command.place
    plain = thing.count is None and thing.action not in UNKNOWN_THINGS and command.times == 1
    if not plain or place.shape != "area" or place.per is not None or place.each or command.spacing is not None:
        return []
    parts: list[LinkedCommand] = []
    for one in following:
        joined = one.before is not None and (one.before.bare or (bool(parts) and one.before.both))
        if not joined or not _number_of_part(one):
            break
        part = cast(CaptureCommand, one.command)
        named = replace(thing, count=part.things[0].count, plural=(part.things[0].count or 0) > 1)
        parts.append(LinkedCommand(one.before, replace(part, things=(named,))))
    return [LinkedCommand(whole.before, Lead(place, command.used, things=command.things)), *parts] if parts else []


def _parts_of(whole: LinkedCommand, following: Sequence[LinkedCommand]) -> Sequence[LinkedCommand]:
    """Return the commands right behind captures whose numbers add up to theirs; empty if there are none."""
    command = whole.command
    if not isinstance(command, CaptureCommand) or len(command.things) != 1 or command.times != 1:
        return ()
    count = command.things[0].count or 0
    if count < 2 or command.things[0].action == LAST_THING or (command.place is not None and command.place.each):
        return ()
    left, parts = count, 0
    for one in following:
        number = _number_of_part(one)
        if not number:
            break
        left, parts = left - number, parts + 1
    found = following[:parts] if left == 0 else ()
    return found if command.place is None or all(_are_within(one, command.place) for one in found) else ()


def _are_within(part: LinkedCommand, whole: PlaceMeaning) -> bool:
    """Return True for captures at sides or parts of the zone that all of them are made of."""
    place = part.command.place if isinstance(part.command, CaptureCommand) else None
    named = _zones(whole)
    return place is not None and place.selector != whole.selector and len(named) == 1 and _zones(place) <= named | _IT


def _of_zone(part: CaptureCommand, zones: AbstractSet[str]) -> CaptureCommand:
    """Return captures at a side of "it" as those at that side of the zone that is meant."""

    def known(value: object) -> s.Selector | None:
        if getattr(value, "zone", "") != THAT_GROUND:
            return None
        named: s.Selector = replace(cast(Any, value), zone=next(iter(zones)))
        return named

    moved: CaptureCommand = with_known(part, known)
    return moved


def _zones(place: PlaceMeaning) -> set[str]:
    return {zone for part in place.selector.walk() if (zone := getattr(part, "zone", ""))}


def _number_of_part(clause: LinkedCommand) -> int:
    """Return the number of captures that are not named ("one from the north"), in the same sentence; 0 for others."""
    command = clause.command
    joined = clause.before is None or not clause.before.full
    if not joined or not isinstance(command, CaptureCommand) or len(command.things) != 1 or command.place is None:
        return 0
    thing = command.things[0]
    is_part = thing.action == LAST_THING and not thing.more and not thing.parameters and command.times == 1
    return thing.count or 0 if is_part else 0


def _at_parts(whole: LinkedCommand, parts: Sequence[LinkedCommand]) -> list[LinkedCommand]:
    """Return the parts of captures, as :func:`_parts_of` has found them, named as these are."""
    command = cast(CaptureCommand, whole.command)
    (thing,) = command.things
    made: list[LinkedCommand] = []
    for number, part in enumerate(parts):
        one = cast(CaptureCommand, part.command)
        named = replace(thing, count=one.things[0].count, plural=(one.things[0].count or 0) > 1)
        one = one if command.place is None else _of_zone(one, _zones(command.place))
        said = command.used if number == 0 else 0
        before = whole.before if number == 0 else part.before
        if number == 0 and part.before is not None:
            said |= part.before.used
        made.append(LinkedCommand(before, replace(one, things=(named,), used=one.used | said)))
    return made
