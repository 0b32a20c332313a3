"""Selector of the current place."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.noun_phrase import NounPhrase, one
from fieldhand.places.selector import DependsOn, Selector

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Here(Selector):
    """The current place."""

    @classmethod
    def example(cls, site: Site) -> Here:
        return cls()

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        return resolution.group(replace(resolution.context.here, side=""))

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return one(message("the place reached before"))

    @property
    def single(self) -> bool:
        return True

    @property
    def depends_on(self) -> DependsOn:
        return "mission"

    def it(self, wording: SelectorWording) -> str:
        """Return "that place", because "next to there" is not English."""
        return message("that place")

    def from_it(self, wording: SelectorWording) -> str:
        return ""
