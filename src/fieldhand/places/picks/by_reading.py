"""Selector of the places with the highest or lowest readings of this mission."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldhand.language import counted, message
from fieldhand.language.words import say_name
from fieldhand.places.count_range import CountRange
from fieldhand.places.noun_phrase import NounPhrase, many, one
from fieldhand.places.reading_series import EXAMPLE_QUANTITY, EXAMPLE_READING
from fieldhand.places.selector import DependsOn, Selector

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class ByReading(Selector):
    """The ``count`` places where this mission read the highest (or ``lowest``) values, most extreme first.

    Fewer if fewer were read. Several readings at one place count with their mean.
    """

    reading: str
    quantity: str
    count: int = 1
    lowest: bool = False

    @classmethod
    def example(cls, site: Site) -> ByReading:
        return cls(reading=EXAMPLE_READING, quantity=EXAMPLE_QUANTITY)

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        """Return the places in the order of their readings; in a forecast, which has no values, the farthest."""
        from fieldhand.places.ranks import rank
        from fieldhand.places.taken_readings import mean_values, places_read

        group = places_read(resolution, self.reading, self.quantity)
        notes.candidates = len(group)
        count = min(self.count, len(group))
        values = mean_values(group, resolution, self.reading, self.quantity)
        if np.isnan(values).any():
            away = np.hypot(*(group.xy - np.asarray(resolution.context.here.xy)).T)
            return group.ranked(-away, count)
        name = say_name(self.quantity)
        most = message("the lowest {name}", name=name) if self.lowest else message("the highest {name}", name=name)
        return rank(group, values if self.lowest else -values, count, notes, most)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        name = say_name(self.quantity)
        if self.lowest:
            return (one if self.single else many)(
                counted(
                    "the place where the {name} read was lowest",
                    "the {count} places where the {name} read was lowest",
                    self.count,
                    name=name,
                )
            )
        return (one if self.single else many)(
            counted(
                "the place where the {name} read was highest",
                "the {count} places where the {name} read was highest",
                self.count,
                name=name,
            )
        )

    @property
    def single(self) -> bool:
        return self.count == 1

    @property
    def size(self) -> CountRange:
        return CountRange(low=1, high=self.count)

    @property
    def keeps_order(self) -> bool:
        return True

    @property
    def depends_on(self) -> DependsOn:
        return "readings"

    @property
    def by_series(self) -> tuple[str, str]:
        return self.reading, self.quantity
