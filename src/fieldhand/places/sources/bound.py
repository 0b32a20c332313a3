"""Places that a node of the Task has bound to a label."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.places.noun_phrase import NounPhrase, one
from fieldhand.places.selector import DependsOn, Selector
from fieldhand.site.names import listed, short

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site

#: The label that an example uses.
EXAMPLE_LABEL = "seen"


@dataclass(frozen=True, kw_only=True)
class Bound(Selector):
    """The place or places that a node of this Task bound to ``label``."""

    label: str

    @classmethod
    def example(cls, site: Site) -> Bound:
        return cls(label=EXAMPLE_LABEL)

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        bound = resolution.context.bound
        places = bound.get(self.label, ())
        if not places:
            known = listed(list(bound)) or message("nothing yet")
            raise PlaceError(
                message("no place is named '{label}' at this point", label=short(self.label)),
                advice=message("named so far: {known}", known=known),
            )
        return resolution.group(*(replace(place, side="") for place in places))

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return one(wording.names.get(self.label) or message("the place called “{label}”", label=self.label))

    @property
    def keeps_order(self) -> bool:
        return True

    @property
    def depends_on(self) -> DependsOn:
        return "mission"
