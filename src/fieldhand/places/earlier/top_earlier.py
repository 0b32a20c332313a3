"""The places with the highest or lowest readings of earlier missions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldhand.language import message
from fieldhand.places.count_range import CountRange
from fieldhand.places.earlier.from_records import FromRecords
from fieldhand.places.earlier.period import EVER, Period
from fieldhand.places.earlier.recorded_work import EarlierStatistic
from fieldhand.places.earlier.wording import doubt_without_reading, say_period, say_statistic_of
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.reading_series import EXAMPLE_QUANTITY
from fieldhand.places.selection_phrase import picked_phrase
from fieldhand.places.selector import Selector
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.earlier.recorded_work import Work
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.earlier_missions import EarlierMissions
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class TopEarlier(FromRecords):
    """The ``count`` places of ``of`` with the highest (or ``lowest``) readings of earlier missions in ``period``, most
    extreme first.

    Several readings at one place count by ``statistic``. Fewer places if fewer were read.
    """

    quantity: str
    count: int = 1
    lowest: bool = False
    statistic: EarlierStatistic = "latest"
    period: Period = EVER
    of: Selector = Trees()

    reference_rule = "pick"

    @classmethod
    def example(cls, site: Site) -> TopEarlier:
        return cls(quantity=EXAMPLE_QUANTITY, count=10, period=Period(calendar="last_week"))

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.earlier.recorded_work import (
            note_without_reading,
            one_value,
            readings_at,
            require_at_least,
        )
        from fieldhand.places.ranks import rank

        require_at_least(self.count)
        readings = readings_at(of, resolution, self.quantity, "", self.period)
        values = np.array([one_value(self.statistic, some) for some in readings])
        known = ~np.isnan(values)
        note_without_reading(int((~known).sum()), self.quantity, notes)
        group, values = of.keep(known), values[known]
        notes.candidates = len(group)
        if not len(group):
            return group
        return rank(group, values if self.lowest else -values, min(self.count, len(group)), notes, self._most())

    def used(self, records: EarlierMissions) -> tuple[Work, ...]:
        from fieldhand.places.earlier.recorded_work import readings_used

        return readings_used(records, self.quantity, self.period, self.statistic)

    def doubt(self, found: int, site: Site) -> str:
        if found >= self.count:
            return ""
        if not found:
            return doubt_without_reading(self, self.quantity, self.period, site)
        return message("{count} were asked for, but only {known} were read", count=self.count, known=found)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        name, when = say_statistic_of(self.statistic, self.quantity), say_period(self.period)
        if self.lowest:
            most = message("with the lowest {name} read {period}", name=name, period=when)
        else:
            most = message("with the highest {name} read {period}", name=name, period=when)
        return picked_phrase(wording.phrase(self.of), self.count, most, that_is=False)

    @property
    def single(self) -> bool:
        return self.count == 1

    @property
    def size(self) -> CountRange:
        return CountRange(low=1, high=self.count)

    @property
    def keeps_order(self) -> bool:
        return True

    def _most(self) -> str:
        name = say_statistic_of(self.statistic, self.quantity)
        if self.lowest:
            return message("the lowest {name}", name=name)
        return message("the highest {name}", name=name)
