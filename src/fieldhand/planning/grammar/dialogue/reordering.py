"""Steps in an order that is said behind them: "the other way round", "tree 9 first"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.faults import NotComposed
from fieldhand.planning.grammar.meaning import (
    CaptureCommand,
    Connective,
    Lead,
    LinkedCommand,
    PlaceMeaning,
    Reordered,
)
from fieldhand.planning.selections import named_places


def reordered(clauses: Sequence[LinkedCommand], order: Reordered) -> list[LinkedCommand]:
    """Return the clauses of two captures, or of one at several places, in another order.

    Raises:
        NotComposed: They are not two captures at places of their own, or none of them is at the place that comes first.
    """
    found = [_as_capture(clauses, number) for number in range(len(clauses))]
    places = [None if one is None or not _is_at_its_own(one.place) else one.place for one in found]
    acts = [one for one, place in zip(found, places, strict=True) if one is not None and place is not None]
    if len(acts) == len(clauses) == 1 and acts[0].place is not None:
        visits = _visits_reordered(acts[0].place, order)
        return [replace(clauses[0], command=replace(acts[0], place=visits, used=acts[0].used | order.used))]
    if len(acts) != 2 or len(clauses) != 2:
        raise _unclear(order)
    one, other = acts
    if _comes_first([act.place.selector for act in acts if act.place is not None], order):
        joint = clauses[1].before
        then = Connective(True, True, 0 if joint is None else joint.used)
        return [LinkedCommand(None, replace(other, used=other.used | order.used)), LinkedCommand(then, one)]
    return [replace(clauses[0], command=replace(one, used=one.used | order.used)), replace(clauses[1], command=other)]


def _unclear(order: Reordered) -> NotComposed:
    return NotComposed(message("it is not clear in which order", context="fault"), order.used)


def _as_capture(clauses: Sequence[LinkedCommand], number: int) -> CaptureCommand | None:
    """Return the capture of a clause; for one that only names a place that of the clause before it, there."""
    command, before = clauses[number].command, clauses[number - 1].command if number else None
    if isinstance(command, Lead) and not command.things and isinstance(before, CaptureCommand):
        return replace(before, place=command.place, used=command.used)  # "photograph tree 4, then tree 9"
    return command if isinstance(command, CaptureCommand) else None


def _is_at_its_own(place: PlaceMeaning | None) -> bool:
    """Return True for places that a phrase names by themselves."""
    if place is None or place.shape not in ("one", "several", "area") or place.like is not None or place.beside:
        return False
    return not place.selector.relative


def _comes_first(places: Sequence[s.Selector], order: Reordered) -> int:
    """Return the index of the one of some places that comes first; the second of two if none is named.

    Raises:
        NotComposed: It is none of them, or it is not clear which.
    """
    first, found = order.first, [1] if len(places) == 2 else []
    if first is not None and first.like is not None and first.like.number:
        found = [first.like.number % len(places) if first.like.number < 0 else first.like.number - 1]
    elif first is not None:
        found = [number for number, place in enumerate(places) if first.selector in place.walk()]
    if order.then is not None and (len(places) != 2 or order.then.selector != places[1 - found[0] if found else 0]):
        raise _unclear(order)
    if len(found) != 1 or found[0] >= len(places) or (order.swapped and found == [0]):
        raise _unclear(order)
    return found[0]


def _visits_reordered(place: PlaceMeaning, order: Reordered) -> PlaceMeaning:
    """Return several named places of which another one is visited first.

    Raises:
        NotComposed: They are not named one by one.
    """
    named = list(named_places(place.selector))
    if len(named) < 2 or not all(one.single for one in named):
        raise _unclear(order)
    named.insert(0, named.pop(_comes_first(named, order)))
    return replace(place, selector=s.UnionOf(parts=tuple(named)), in_order=True)
