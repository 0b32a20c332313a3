"""Trees of one row, one after the other."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.language import joined, message
from fieldhand.places.noun_phrase import NounPhrase, many
from fieldhand.places.place_errors import too_few
from fieldhand.places.selection_phrase import picked_phrase
from fieldhand.places.selector import Counted, Selector
from fieldhand.places.sources.here import Here
from fieldhand.places.sources.marker import Marker
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Successive(Counted):
    """``count`` trees of one row, one after the other: of the nearest row that has as many those nearest to ``near``,
    from their nearer end."""

    count: int
    near: Selector = Here()
    of: Selector = Trees()

    reference_rule = "pick"
    counts_from_a_side = True

    @classmethod
    def example(cls, site: Site) -> Successive:
        return cls(count=4)

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.rows.along_and_across import longest_run, successive

        near = resolution.origin(self.near)
        self.need(of, resolution)
        found = successive(of, near, self.count, notes)
        if len(found) < self.count:
            raise too_few(resolution.site, self, self.count, longest_run(of))
        return found

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        group = wording.phrase(self.of)
        near, count = self.near.as_origin(wording), self.count
        if count == 1:
            return picked_phrase(group, 1, message("nearest to {place}", place=near))
        if group.bare:
            each = "" if group.one_row else message("of one row")
            where = joined(" ", [part for part in (each, group.of_what) if part])
            return many(
                message(
                    "{count} successive trees {of_row}, as near to {place} as there are",
                    count=count,
                    of_row=where,
                    place=near,
                )
            )
        return many(
            message(
                "{count} of {trees} that follow each other in one row, as near to {place} as there are",
                count=count,
                trees=group.group(),
                place=near,
            )
        )

    @property
    def measured_from(self) -> Selector:
        return self.near

    @property
    def from_start(self) -> Selector:
        return replace(self, near=Marker(name="start")) if self.near == Here() else self
