"""The start, the end and the charger of a site."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.language.words import say_marker
from fieldhand.places.noun_phrase import NounPhrase, one
from fieldhand.places.selector import Selector
from fieldhand.terms import MarkerName

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Place, Site


@dataclass(frozen=True, kw_only=True)
class Marker(Selector):
    """A marker of the site: where the robot starts, ends or charges."""

    name: MarkerName

    @classmethod
    def example(cls, site: Site) -> Marker:
        return cls(name="start")

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        return resolution.group(self._place(resolution))

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return one(say_marker(self.name))

    def aside(self, phrase: str) -> str:
        return ""

    @property
    def single(self) -> bool:
        return True

    @property
    def named_marker(self) -> MarkerName:
        return self.name

    def _place(self, resolution: Resolution) -> Place:
        """Return the marker; the first tree replaces a missing start, the start a missing end, nothing a charger."""
        site = resolution.site
        if self.name in site.markers:
            return site.markers[self.name]
        if self.name == "charger":
            raise PlaceError(
                message("the site has no charger"),
                where=site.name,
                advice=message('add a point of "kind": "charger" to its file'),
            )
        return site.start if self.name == "start" else site.home("return_to_end", resolution.context.here)
