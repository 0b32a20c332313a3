"""Constructions of where plants are counted from, behind what is done there: "and count from the north end"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.clauses import Adjunct
from fieldhand.planning.grammar.meaning import CaptureCommand
from fieldhand.planning.grammar.places.compass import SIDES
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_every_nth, as_in_row, swapped
from fieldhand.terms import Side

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction(
    "counting: COUNTED [DET] side=DIR [FINISH]", "counting: COUNTED [DET] side=DIR SIDE",
    "counting: COUNTED [DET] FINISH in_ [DET] side=DIR", cost=0.0,
)  # fmt: skip
def counting(side: Lex) -> Side | None:
    """Compose "counting from the north end"."""
    return side.value if side.value in SIDES else None


@construction(
    "adjunct: [and_or_but] side=counting",
    "adjunct: [and_or_but] side=counting INEACHCASE",
    "adjunct: [and_or_but] side=counting INEACH",
    "adjunct: [and_or_but] side=counting in_ EACH ROW",
    "adjunct: [and_or_but] side=counting in_ EACH OF IT",
    "adjunct: [and_or_but] side=counting OF EACH ROW",
    "adjunct: [and_or_but] side=counting PER ROW",
    cost=0.3,
)
def counted(side: Side) -> Adjunct:
    """Compose "and count from the north end each time"."""
    return Adjunct(_counted, side, of_place=True, is_sentence=True)


def _counted(command: CaptureCommand, side: Side) -> CaptureCommand | None:
    """Return a command at places that are counted from a side; None if none of them is counted, or from elsewhere."""
    place = command.place
    if place is None:
        return None
    selectors = [place.selector] if place.per is None else [place.selector, place.per]
    counted = [one for selector in selectors for one in selector.walk() if as_every_nth(one) or as_in_row(one)]
    if not counted or any(getattr(one, "counted_from", "") != "usual" for one in counted):
        return None
    made = place.selector
    for one in counted:
        made = swapped(made, one, _from_side(one, side))
    return None if made == place.selector else replace(command, place=replace(place, selector=made))


@construction("adjunct: [and_or_but] start=begin_with", cost=0.3)
def beginning_with(start: int) -> Adjunct:
    """Compose "Begin with the second one." behind every third tree."""
    return Adjunct(_begun, start, of_place=True, is_sentence=True)


def _begun(command: CaptureCommand, start: int) -> CaptureCommand | None:
    """Return a command at every n-th tree from another one on; None if none is counted so, or from elsewhere."""
    place = command.place
    every = () if place is None else tuple(one for one in map(as_every_nth, place.selector.walk()) if one is not None)
    if place is None or len(every) != 1 or every[0].start != 1:
        return None
    return replace(
        command, place=replace(place, selector=swapped(place.selector, every[0], replace(every[0], start=start)))
    )


def _from_side(one: s.Selector, side: Side) -> s.Selector:
    """Return every n-th tree, or trees by their numbers in the row, counted from a side."""
    known = as_every_nth(one) or as_in_row(one)
    return one if known is None else replace(known, counted_from=side)
