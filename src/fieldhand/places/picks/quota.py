"""Selector of a number, or a share, of each group of trees: 5 of each variety, 10 % of each row."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from fieldhand.language import counted, message
from fieldhand.language.words import say_name, say_number
from fieldhand.places.count_range import CountRange, at_most
from fieldhand.places.filters.attribute_words import say_attribute
from fieldhand.places.noun_phrase import NounPhrase, many
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.site.feature_kinds import phrase as words_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Place, Site

#: Choice of the trees within each group.
Manner = Literal["spread", "random", "first", "last", "highest", "lowest"]


@dataclass(frozen=True, kw_only=True)
class Quota(FromGroup):
    """``count`` trees, or ``percent`` of the trees, of each ``per`` group of ``of``; of all of ``of`` if ``per`` is
    empty.

    Attributes:
        per: ``row``, ``block``, ``zone``, or an attribute: a group for each of its values.
        how: ``spread`` evenly, drawn at ``random`` by ``seed``, ``first`` or ``last`` of each group, ``highest`` or
            ``lowest`` by the attribute ``by``.
    """

    per: str = ""
    count: int = 0
    percent: float = 0.0
    how: Manner = "spread"
    by: str = ""
    seed: int = 0
    of: Selector = Trees()

    reference_rule = "of"

    @classmethod
    def example(cls, site: Site) -> Quota:
        return cls(per="row", count=2)

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        """Return the chosen trees, group by group; a group with fewer trees than ``count`` gives all of them.

        Raises:
            PlaceError: The site lacks the rows, blocks, zones or the attribute, or the quota is not possible.
        """
        from fieldhand.places.filters.zones import outside_keep_outs
        from fieldhand.places.picks.quotas import of_each_group

        return of_each_group(outside_keep_outs(of, notes), self, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return many(message("{trees}, {chosen}", trees=self._amount(wording.phrase(self.of)), chosen=self._chosen))

    def say_groups(self, places: Sequence[Place], site: Site) -> str:
        from fieldhand.places.picks.quotas import say_each_group
        from fieldhand.places.place_group import PlaceGroup

        return say_each_group(PlaceGroup.of(site, places), self.per) if self.per else ""

    def _amount(self, group: NounPhrase) -> str:
        """Return how many of which trees, without how they are chosen."""
        if self.percent:
            percent = say_number(self.percent)
            if self.per:
                return message(
                    "{percent} % of {trees} per {group}", percent=percent, trees=group.group(), group=self._group
                )
            return message("{percent} % of {trees}", percent=percent, trees=group.group())
        if not self.per:
            return message("{count} of {trees}", count=self.count, trees=group.group())
        each = counted("{count} tree per {group}", "{count} trees per {group}", self.count, group=self._group)
        return each if group.plain else message("{each}, of {trees}", each=each, trees=group.group())

    @property
    def size(self) -> CountRange:
        return at_most(self.of.size)

    @property
    def keeps_order(self) -> bool:
        return False

    @property
    def _group(self) -> str:
        match self.per:
            case "row":
                return message("row")
            case "block":
                return message("block")
            case "zone":
                return message("zone")
        return say_attribute(self.per)[0]

    @property
    def _chosen(self) -> str:
        name = say_name(words_of(self.by))
        match self.how:
            case "random":
                return message("drawn at random (seed {seed})", seed=self.seed)
            case "first":
                return message("the first ones")
            case "last":
                return message("the last ones")
            case "highest":
                return message("those with the highest {name}", name=name)
            case "lowest":
                return message("those with the lowest {name}", name=name)
        return message("spread evenly")
