"""The nearest to places, and those next to them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.selection_phrase import picked_phrase, the_most
from fieldhand.places.selector import Counted, DependsOn, Selector
from fieldhand.places.sources.here import Here
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import AnySide, Side

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Nearest(Counted):
    """The ``count`` trees of ``of`` nearest to ``to`` that are not ``to``, nearest first.

    ``adjacent`` asks for neighbours ("next to"): the same row is preferred. ``fresh`` passes over trees that were
    visited already ("nearby"). ``side`` keeps those that lie in that direction from ``to`` ("its neighbour
    on the east"). :class:`InZone` as ``to``, ``origin`` or ``near`` is the zone itself ("nearest to
    the pond").
    """

    to: Selector
    count: int = 1
    adjacent: bool = False
    fresh: bool = False
    side: AnySide = "any"
    of: Selector = Trees()

    @classmethod
    def example(cls, site: Site) -> Nearest:
        return cls(to=Here(), count=5, adjacent=True)

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.neighbours.distances import apart_from, distance_to, next_to, on_side
        from fieldhand.places.ranks import rank

        to = resolution.origin(self.to)
        candidates = apart_from(of, to).once(self.count if self.count > 1 else len(of))
        if self.fresh:
            candidates = candidates.without(resolution.visited())
        if self.side != "any":
            candidates = on_side(candidates, to, self.side, next_to=self.adjacent)
        notes.candidates = len(candidates)
        self.need(candidates, resolution)
        if self.adjacent and self.side == "any":
            notes.rule = "of the nearest ones those in the same row come first"
            return next_to(candidates, to, self.count)
        return rank(candidates, distance_to(candidates, to), self.count, notes, the_most("nearest"))

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        place = self.to.as_origin(wording)
        there: str = (
            message("next to {place}", place=place) if self.adjacent else message("nearest to {place}", place=place)
        )
        if self.side != "any":
            there = _on_side(there, self.side)
        if self.fresh:
            there = message("{near} and not visited yet", near=there)
        return picked_phrase(wording.phrase(self.of), self.count, there)

    @property
    def sides(self) -> tuple[Side, ...]:
        return (self.side,) if self.side != "any" else ()

    @property
    def depends_on(self) -> DependsOn:
        return "mission" if self.fresh else "site"

    @property
    def measured_from(self) -> Selector:
        return self.to


def _on_side(near: str, side: Side) -> str:
    """Return "next to tree 4, on its east side"."""
    match side:
        case "north":
            return message("{near}, on its north side", near=near)
        case "east":
            return message("{near}, on its east side", near=near)
        case "south":
            return message("{near}, on its south side", near=near)
        case "west":
            return message("{near}, on its west side", near=near)
