"""Places whose readings of earlier missions pass a test."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldhand.places.count_range import CountRange, at_most
from fieldhand.places.earlier.from_records import FromRecords
from fieldhand.places.earlier.period import EVER, Period
from fieldhand.places.earlier.recorded_work import EarlierStatistic
from fieldhand.places.earlier.wording import doubt_without_reading, say_passed
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.reading_series import EXAMPLE_QUANTITY
from fieldhand.places.selector import Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import Test

if TYPE_CHECKING:
    from fieldhand.places.earlier.recorded_work import Work
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.earlier_missions import EarlierMissions
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class WhereEarlier(FromRecords):
    """Places of ``of`` whose reading of earlier missions in ``period`` passes a test with ``value``, in the profile's
    unit.

    Several readings at one place count by ``statistic``.
    """

    quantity: str
    test: Test
    value: float
    unit: str
    statistic: EarlierStatistic = "latest"
    period: Period = EVER
    of: Selector = Trees()

    reference_rule = "group"

    @classmethod
    def example(cls, site: Site) -> WhereEarlier:
        return cls(quantity=EXAMPLE_QUANTITY, test="gt", value=30.0, unit="degC")

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.earlier.recorded_work import note_without_reading, one_value, readings_at
        from fieldhand.places.filters.attributes import COMPARISONS

        readings = readings_at(of, resolution, self.quantity, self.unit, self.period)
        values = np.array([one_value(self.statistic, some) for some in readings])
        known = ~np.isnan(values)
        note_without_reading(int((~known).sum()), self.quantity, notes)
        passed = known & COMPARISONS[self.test](values, self.value)
        return of.keep(passed)

    def used(self, records: EarlierMissions) -> tuple[Work, ...]:
        from fieldhand.places.earlier.recorded_work import readings_used

        return readings_used(records, self.quantity, self.period, self.statistic)

    def doubt(self, found: int, site: Site) -> str:
        return "" if found else doubt_without_reading(self, self.quantity, self.period, site)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return wording.phrase(self.of).keeping(after=say_passed(self))

    @property
    def size(self) -> CountRange:
        return at_most(self.of.size)
