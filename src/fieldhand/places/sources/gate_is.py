"""A gate by its name."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language.words import say_gate
from fieldhand.places.noun_phrase import NounPhrase, one
from fieldhand.places.place_errors import no_such_gate
from fieldhand.places.selector import Selector
from fieldhand.site.feature_kinds import phrase as same_words

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class GateIs(Selector):
    """The gate with this name."""

    gate: str

    @classmethod
    def example(cls, site: Site) -> GateIs:
        return cls(gate=site.gates[0].place.id if site.gates else "")

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        """Return the gate of that name, ignoring case, hyphens and underscores."""
        site = resolution.site
        alike = [g.place for g in site.gates if same_words(g.place.id) == same_words(self.gate)]
        exact = [place for place in alike if place.id == self.gate]
        if not alike:
            raise no_such_gate(site, self.gate)
        return resolution.group((exact or alike)[0])

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return one(say_gate(self.gate))

    @property
    def single(self) -> bool:
        return True
