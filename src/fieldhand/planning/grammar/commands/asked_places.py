"""Constructions of questions that the site's file answers, about what is visited next: "which tree is the oldest?"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import CaptureCommand, DriveCommand, Nominal, PlaceMeaning
from fieldhand.planning.selections import as_top, is_by_value

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction(
    "asked_place: WHICHONE [n=count] inner=nominal IS [DET] rank=ranking [ONE]",
    "asked_place: WHICHONE [n=count] inner=nominal SHOWING [DET] rank=ranking",
    cost=0.2,
)
def which_is_most(inner: Nominal, rank: tuple[str, bool], n: int | None = None) -> PlaceMeaning | None:
    """Compose "which pumpkin is the tallest" and "which three trees are the oldest"."""
    if not rank[0] or inner.single or inner.complete or inner.pronoun:
        return None
    number = n or 1
    if (number > 1) != inner.plural and not inner.unmarked:
        return None
    best = s.Top(attribute=rank[0], count=number, lowest=rank[1], of=inner.selector)
    return PlaceMeaning(best, "one" if number == 1 else "several", count=number if number > 1 else None)


@construction("asked_place: WHICHONE IS place=place", cost=0.3)
def which_is_that(place: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "which is the tallest pumpkin"."""
    ranked = all(as_top(part) is not None for part in place.selector.members)
    return place if ranked and place.shape in ("one", "several") and place.like is None else None


@construction("asked_place: first=asked_place [COMMA] AND second=asked_place", cost=0.1)
def which_and_which(first: PlaceMeaning, second: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "which pepper is the driest and which basil is the wettest"."""
    parts = (*first.selector.members, *second.selector.members)
    counts = [1 if one.shape == "one" else one.count or 0 for one in (first, second)]
    return PlaceMeaning(s.UnionOf(parts=parts), "several", count=sum(counts)) if len({*parts}) == len(parts) else None


@construction(
    "asked_place: ONRECORD [COMMA] place=asked_place", "asked_place: place=asked_place [COMMA] ONRECORD", cost=0.1
)
def on_record(place: PlaceMeaning) -> PlaceMeaning:
    """Compose "according to the map, which pepper is the driest"."""
    return place


@construction("drive: place=asked_place", cost=0.3)
def answered_by_file(place: PlaceMeaning, used: int) -> DriveCommand:
    """Compose "which tree is the oldest?" before what is done there."""
    return DriveCommand(place, used, picks=True)


@construction("capture: ONRECORD [COMMA] act=capture", "capture: act=capture [COMMA] ONRECORD", cost=0.3)
def captured_on_record(act: CaptureCommand, used: int) -> CaptureCommand | None:
    """Compose "according to the map, check the soil moisture at the driest pepper", which the file knows."""
    parts = () if act.place is None else act.place.selector.walk()
    return replace(act, used=used) if any(as_top(part) is not None or is_by_value(part) for part in parts) else None
