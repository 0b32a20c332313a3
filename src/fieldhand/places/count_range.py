"""Number of places that the form of a selector guarantees."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class CountRange:
    """A number between ``low`` and ``high`` (None: unbounded)."""

    low: int
    high: int | None

    @property
    def exact(self) -> int | None:
        """The only number in the range, or None."""
        return self.low if self.low == self.high else None

    def times(self, other: CountRange) -> CountRange:
        """Return the range of the product of two numbers."""
        high = None if self.high is None or other.high is None else self.high * other.high
        return CountRange(low=self.low * other.low, high=high)


ONE = CountRange(low=1, high=1)
ANY = CountRange(low=0, high=None)


def exactly(number: int) -> CountRange:
    """Return the range of one number."""
    return CountRange(low=number, high=number)


def at_most(size: CountRange) -> CountRange:
    """Return the range after some of the places were removed."""
    return CountRange(low=0, high=size.high)
