"""Constructions of lists of single spots and bare zones: "at the gate, at the trough and in the wet corner"."""

from __future__ import annotations

from dataclasses import dataclass

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import PlaceMeaning
from fieldhand.planning.grammar.places.sampling import bare_points, is_keep_out
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@dataclass(frozen=True, slots=True)
class SpotList:
    """Single places in the order in which they were named.

    Attributes:
        parts: The places.
        grounds: The zones without plants among them, of which the middles are meant.
    """

    parts: tuple[s.Selector, ...]
    grounds: tuple[s.Selector, ...] = ()


@construction("spot_item: place=place", "spot_item: word=relation place=place", cost=0.1, given=("site",))
def spot_item(place: PlaceMeaning, site: Site, word: str = "at") -> SpotList | None:
    """Compose "in the wet corner" and "at the gate" of a list."""
    if word not in ("at", "of") or place.per is not None or place.refers_back or place.beside:
        return None
    if place.shape == "one" and place.selector.single and not place.selector.relative:
        return SpotList((place.selector,))
    if is_keep_out(place.selector, site):
        return None  # "at the pond": at its edge
    free = bare_points(place.selector, site, 1) if place.shape == "area" else None
    return None if free is None else SpotList((free,), (place.selector,))


@construction("spot_list: first=spot_item", "spot_list: first=spot_list COMMA second=spot_item", cost=0.1)
def spot_list(first: SpotList, second: SpotList | None = None) -> SpotList | None:
    """Compose "at the gate, at the trough"."""
    if second is None:
        return first
    return None if {*first.parts} & {*second.parts} else _both(first, second)


@construction("place: first=spot_list [COMMA] AND last=spot_item", cost=0.2)
def spots_listed(first: SpotList, last: SpotList) -> PlaceMeaning | None:
    """Compose "at the gate, at the trough and in the wet corner"."""
    made = _both(first, last)
    if not made.grounds or {*first.parts} & {*last.parts}:
        return None
    if len(made.grounds) == len(made.parts) and not any(one in made.parts for one in made.grounds):
        return PlaceMeaning(s.UnionOf(parts=made.grounds), "area")
    return PlaceMeaning(s.UnionOf(parts=made.parts), "several", count=len(made.parts), each=True)


def _both(first: SpotList, second: SpotList) -> SpotList:
    """Return two lists as one."""
    return SpotList((*first.parts, *second.parts), (*first.grounds, *second.grounds))
