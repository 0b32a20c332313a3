"""Commands at the one of two places that readings decide: a condition with the same command in both cases."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.series import sides_measured
from fieldhand.planning.grammar.dialogue.state import DialogueState, NotComposed, Setting
from fieldhand.planning.grammar.meaning import (
    AllTests,
    CaptureCommand,
    Command,
    LinkedCommand,
    Otherwise,
    PlaceMeaning,
    Subject,
    Test,
    When,
)
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.selections import are_rows, as_zone, is_description


def is_compared(command: Command) -> bool:
    """Return True for captures at the one of two places that has the lower or the higher mean."""
    place = command.place if isinstance(command, CaptureCommand) else None
    return place is not None and place.like is not None and place.like.kind == "compared"


def in_both_cases(setting: Setting, state: DialogueState, clause: LinkedCommand) -> tuple[LinkedCommand, ...]:
    """Return the clauses that say the same: a condition, the captures at one place, and otherwise at the other.

    Raises:
        NotComposed: Readings were not taken at just two places before.
    """
    command = cast(CaptureCommand, clause.command)
    place = cast(PlaceMeaning, command.place)
    sides = sides_measured(setting, state)
    if len(sides) != 2 or place.like is None:
        raise NotComposed(
            message("it is not clear which of them", context="fault"),
            advice=message("take readings at two places before, and say which of them is meant"),
        )
    if all(one.single or len(ids_of(one, setting.site) or ()) == 1 for one in sides):
        raise NotComposed(
            message("it is not clear which of them", context="fault")
        )  # that is where a reading is lowest
    first, second = sides
    if _ground(first) == _ground(second):
        raise NotComposed(message("it is not clear which of them", context="fault"))
    test = Test(
        "", cast(Any, place.like.side), 0.0, place=PlaceMeaning(first, "several"), of="mean",
        than=Subject(place=PlaceMeaning(second, "several")),
    )  # fmt: skip
    said = place.tokens & command.used
    here, there = (
        replace(command, place=_some_of(_ground(one), place.count), used=command.used & ~said)
        for one in (first, second)
    )
    return (
        LinkedCommand(clause.before, When(AllTests((test,)), said)),
        LinkedCommand(None, here),
        LinkedCommand(None, Otherwise(0)),
        LinkedCommand(None, there),
    )


def _some_of(area: PlaceMeaning, count: int | None) -> PlaceMeaning:
    """Return so many trees or points of an area; all of it if no number was said."""
    if count is None:
        return area
    zone = as_zone(area.selector)
    made = s.Take(count=count, of=area.selector) if zone is None else s.PointsIn(zone=zone.zone, count=count)
    return PlaceMeaning(made, "one" if count == 1 else "several", count=count)


def _ground(places: s.Selector) -> PlaceMeaning:
    """Return the area in which places were chosen: the crop of five leeks, the zone of ten points; or the one place."""
    zone = getattr(places, "zone", "")
    if zone and as_zone(places) is None:
        return PlaceMeaning(places, "one") if places.single else PlaceMeaning(s.InZone(zone=zone), "area")
    inner = places
    while not (is_description(inner) or are_rows(inner)):
        of = getattr(inner, "of", None)
        if of is None or of == s.Trees():
            return PlaceMeaning(places, "one" if places.single else "area")
        inner = of
    return PlaceMeaning(inner, "area")
