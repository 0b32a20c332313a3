"""A date and time of day that a test sets."""

from __future__ import annotations

from datetime import datetime, timedelta

from fieldhand.compatibility import UTC

__all__ = ["FixedClock"]


class FixedClock:
    """A date and time that changes only when it is advanced: a :class:`~fieldhand.clock.WallClock` and a callable.

    Args:
        moment: Initial date and time, with time zone.
    """

    def __init__(self, moment: datetime = datetime(2026, 5, 1, 8, tzinfo=UTC)) -> None:
        if moment.tzinfo is None:
            raise ValueError(f"{moment} has no time zone")
        self.moment = moment

    def now(self) -> float:
        """Return the seconds since 1970-01-01 00:00 UTC."""
        return self.moment.timestamp()

    def __call__(self) -> datetime:
        """Return the date and time."""
        return self.moment

    def advance(self, seconds: float) -> None:
        """Advance the clock; a negative number sets it back."""
        self.moment += timedelta(seconds=seconds)
