"""A time of day that a test sets."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

__all__ = ["FixedClock"]


class FixedClock:
    """A time of day that stands still until it is moved: a :class:`~fieldhand.clock.WallClock`, and a function.

    Args:
        moment: The time of day, with time zone.
    """

    def __init__(self, moment: datetime = datetime(2026, 5, 1, 8, tzinfo=UTC)) -> None:
        if moment.tzinfo is None:
            raise ValueError(f"{moment} has no time zone")
        self.moment = moment

    def now(self) -> float:
        """Return seconds since 1970 began, in UTC."""
        return self.moment.timestamp()

    def __call__(self) -> datetime:
        """Return the time of day."""
        return self.moment

    def advance(self, seconds: float) -> None:
        """Let time pass; a negative number sets the clock back."""
        self.moment += timedelta(seconds=seconds)
