"""Places where earlier missions did something."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.places.count_range import CountRange, at_most
from fieldhand.places.earlier.from_records import FromRecords
from fieldhand.places.earlier.period import EVER, Period
from fieldhand.places.earlier.wording import say_done, say_not_done, say_nothing_done
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.selector import Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.site.earlier_missions import EarlierCapture, EarlierMissions, EarlierOutcome

if TYPE_CHECKING:
    from fieldhand.places.earlier.recorded_work import Work
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class DoneEarlier(FromRecords):
    """Places of ``of`` where earlier missions did ``action`` in ``period``; without an action anything.

    With ``measured``, where they measured that quantity. ``outcome`` ``failed``: where it failed and was not done in
    the period; ``left_out``: places that were planned and not reached. ``at_least`` counts missions.
    """

    action: str = ""
    measured: str = ""
    outcome: EarlierOutcome = "done"
    at_least: int = 1
    period: Period = EVER
    of: Selector = Trees()

    reference_rule = "of"

    @classmethod
    def example(cls, site: Site) -> DoneEarlier:
        return cls(action="take_thermal_picture", period=Period(calendar="this_month"))

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.earlier.recorded_work import (
            WorkByPlace,
            nothing_done,
            records_of,
            require_at_least,
        )

        require_at_least(self.at_least)
        records = records_of(resolution)
        by_place = WorkByPlace.of(self._work(records)).each(of)
        later_done = WorkByPlace.of(self._done(records)).each(of) if self.outcome != "done" else ((),) * len(of)
        enough = [
            len({mission.id for mission, _ in some}) >= self.at_least and not done
            for some, done in zip(by_place, later_done, strict=True)
        ]
        if not any(enough):
            raise nothing_done(resolution.site, self, records)
        return of.keep(enough)

    def used(self, records: EarlierMissions) -> tuple[Work, ...]:
        from fieldhand.places.earlier.recorded_work import latest_of_each

        work = self._work(records)
        if self.outcome != "done":
            return (*work, *self._done(records))
        return work if self.at_least > 1 else latest_of_each(work, self.period)

    def doubt(self, found: int, site: Site) -> str:
        return "" if found or site.earlier is None else say_nothing_done(self, site.earlier, site)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return wording.phrase(self.of).keeping(after=say_done(self))

    def left_out(self, wording: SelectorWording) -> str:
        if self.of == Trees():
            return say_not_done(self) or super().left_out(wording)
        return super().left_out(wording)

    @property
    def size(self) -> CountRange:
        return at_most(self.of.size)

    def _work(self, records: EarlierMissions) -> tuple[Work, ...]:
        from fieldhand.places.earlier.recorded_work import work_in

        return work_in(records, self.period, lambda capture: capture.outcome == self.outcome and self._asked(capture))

    def _done(self, records: EarlierMissions) -> tuple[Work, ...]:
        from fieldhand.places.earlier.recorded_work import work_in

        return work_in(records, self.period, lambda capture: capture.outcome == "done" and self._asked(capture))

    def _asked(self, capture: EarlierCapture) -> bool:
        if capture.outcome == "left_out":
            return True
        if self.action and capture.action != self.action:
            return False
        return not self.measured or capture.outcome == "failed" or capture.value_of(self.measured) is not None
