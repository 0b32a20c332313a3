"""A tree by its id."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language.words import say_tree
from fieldhand.places.noun_phrase import NounPhrase, one
from fieldhand.places.place_errors import no_such_tree
from fieldhand.places.selector import Selector

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class TreeIs(Selector):
    """The tree with this id: the file's own, else its position in the file from 1."""

    tree: str

    @classmethod
    def example(cls, site: Site) -> TreeIs:
        return cls(tree=site.trees[len(site.trees) // 2].place.id)

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        site = resolution.site
        if self.tree not in site.by_id:
            raise no_such_tree(site, self.tree)
        return resolution.group(site.by_id[self.tree].place)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return one(say_tree(self.tree))

    def aside(self, phrase: str) -> str:
        return ""

    @property
    def single(self) -> bool:
        return True

    @property
    def named_tree(self) -> str:
        return self.tree
