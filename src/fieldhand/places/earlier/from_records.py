"""The base class of selectors by what earlier missions did."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.places.selector import FromGroup

if TYPE_CHECKING:
    from fieldhand.places.earlier.recorded_work import Work
    from fieldhand.site.earlier_missions import EarlierMissions
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class FromRecords(FromGroup):
    """The base class of selectors whose places follow from the records of earlier missions on the site."""

    @abstractmethod
    def used(self, records: EarlierMissions) -> tuple[Work, ...]:
        """Return the captures of the records that its places depend on.

        Raises:
            PlaceError: Its period is not a possible one.
        """

    def doubt(self, found: int, site: Site) -> str:
        """Return a sentence to confirm if fewer places were found than a person expects; empty if there is none.

        Args:
            found: Number of places found.
            site: The site, with the earlier missions.
        """
        del found, site
        return ""

    @property
    def uses_records(self) -> bool:
        return True
