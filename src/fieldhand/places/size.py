"""The number of places that the form of a selector fixes."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Range:
    """A number between ``low`` and ``high`` (None: no bound)."""

    low: int
    high: int | None

    @property
    def exact(self) -> int | None:
        """The number, where there is only one."""
        return self.low if self.low == self.high else None

    def times(self, other: Range) -> Range:
        """So many of so many."""
        high = None if self.high is None or other.high is None else self.high * other.high
        return Range(low=self.low * other.low, high=high)


ONE = Range(low=1, high=1)
ANY = Range(low=0, high=None)


def exactly(number: int) -> Range:
    """Return the range of one number."""
    return Range(low=number, high=number)


def at_most(size: Range) -> Range:
    """Return the range of what is left of so many places after some of them were taken out."""
    return Range(low=0, high=size.high)
