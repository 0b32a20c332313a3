"""Selector of the trees of the row or block with the highest or lowest readings of this mission."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from fieldhand.language import message
from fieldhand.language.words import say_name
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.reading_series import EXAMPLE_QUANTITY, EXAMPLE_READING
from fieldhand.places.selector import DependsOn, FromGroup, Selector
from fieldhand.places.series_statistics import Statistic, statistic
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class GroupByReading(FromGroup):
    """The trees of the row or block (``group``) whose readings have the highest (or ``lowest``) ``statistic``."""

    group: Literal["row", "block"]
    reading: str
    quantity: str
    statistic: Statistic = "mean"
    lowest: bool = False
    of: Selector = Trees()

    reference_rule = "region"

    @classmethod
    def example(cls, site: Site) -> GroupByReading:
        return cls(group="row", reading=EXAMPLE_READING, quantity=EXAMPLE_QUANTITY)

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        """Return the trees of that row or block; in a forecast, which has no values, of the one with the most trees."""
        from fieldhand.places.taken_readings import groups_of, places_read, values_by_place

        read = places_read(resolution, self.reading, self.quantity)
        values = values_by_place(resolution, self.reading, self.quantity)
        inside = groups_of(of, self.group)
        by_group: dict[int, list[float]] = {}
        for place, group in zip(read.places, groups_of(read, self.group).tolist(), strict=True):
            if group >= 0 and (inside == group).any():
                by_group.setdefault(group, []).extend(values.get((place.kind, place.id), (float("nan"),)))
        if not by_group:
            return of.keep(np.zeros(len(of), dtype=bool))
        notes.candidates = len(by_group)
        if any(np.isnan(some).any() for some in by_group.values()):
            best = max(by_group, key=lambda g: (int((inside == g).sum()), -g))
        else:
            sign = -1.0 if self.lowest else 1.0
            best = max(by_group, key=lambda g: (sign * statistic(self.statistic, by_group[g]), -g))
        return of.keep(inside == best)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        name = say_name(self.quantity)
        which = _extreme(self.statistic, name, lowest=self.lowest)
        group = wording.phrase(self.of)
        if self.group == "row":
            return group.keeping(after=message("in the row with {extreme}", extreme=which))
        return group.keeping(after=message("in the block with {extreme}", extreme=which))

    @property
    def depends_on(self) -> DependsOn:
        return "readings"

    @property
    def by_series(self) -> tuple[str, str]:
        return self.reading, self.quantity


def _extreme(of: Statistic, name: str, *, lowest: bool) -> str:
    """Return a superlative of a statistic: "the highest mean temperature"."""
    match of, lowest:
        case "mean", False:
            return message("the highest mean {name}", name=name)
        case "mean", True:
            return message("the lowest mean {name}", name=name)
        case "median", False:
            return message("the highest median {name}", name=name)
        case "median", True:
            return message("the lowest median {name}", name=name)
        case "range", False:
            return message("the largest range of {name}", name=name)
        case "range", True:
            return message("the smallest range of {name}", name=name)
        case "minimum", False:
            return message("the highest minimum of {name}", name=name)
        case "minimum", True:
            return message("the lowest {name}", name=name)
        case "maximum", True:
            return message("the lowest maximum of {name}", name=name)
    return message("the highest {name}", name=name)
