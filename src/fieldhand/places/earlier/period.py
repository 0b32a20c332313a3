"""A period of time in which earlier missions count, relative to the time at which their summary was drawn up."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date, datetime, timedelta
from typing import Literal

from fieldhand.compatibility import date_from_iso
from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.site.names import short

#: A period of the calendar. A weekday is the latest one before the day on which the summary was drawn up.
CalendarPeriod = Literal[
    "ever",
    "today",
    "yesterday",
    "this_week",
    "last_week",
    "this_month",
    "last_month",
    "this_year",
    "last_year",
    "mon",
    "tue",
    "wed",
    "thu",
    "fri",
    "sat",
    "sun",
]

_WEEKDAYS = ("mon", "tue", "wed", "thu", "fri", "sat", "sun")
_DAY = timedelta(days=1)
#: Largest number of hours, days, months or missions.
_MOST = 100_000


@dataclass(frozen=True, kw_only=True)
class Period:
    """A period before the plan was made, in local time; weeks begin on Monday. At most one of the parts is given.

    Attributes:
        calendar: ``mon`` is the latest Monday before today.
        last_missions: The last so many missions that did what is asked for; 1 is the last time.
        last_hours, last_days, last_months: So long before now; 14 days for two weeks.
        first_day, last_day: Days from the first to the last, both inclusive: an ISO 8601 date (``2026-11-01``), its
            latest occurrence without a year (``--11-01``), or a weekday; one of them may be empty.
    """

    calendar: CalendarPeriod = "ever"
    last_missions: int | None = None
    last_hours: int | None = None
    last_days: int | None = None
    last_months: int | None = None
    first_day: str = ""
    last_day: str = ""

    @property
    def counts(self) -> tuple[int, ...]:
        """The numbers of missions, hours, days and months that are given."""
        given = (self.last_missions, self.last_hours, self.last_days, self.last_months)
        return tuple(count for count in given if count is not None)

    def require(self, now: datetime) -> None:
        """Check that the period is a possible one.

        Raises:
            PlaceError: It has several parts, a number that is not positive, or a day that is none.
        """
        parts = len(self.counts) + (self.calendar != "ever") + bool(self.first_day or self.last_day)
        if parts > 1:
            raise PlaceError(
                message("a period has several parts that exclude each other"),
                advice=message("give one of calendar, last-missions, last-hours, last-days, last-months, or days"),
            )
        if any(not 1 <= count <= _MOST for count in self.counts):
            raise PlaceError(
                message("a period of the last {count} is not possible", count=self.counts[0]),
                advice=message("give a number from 1 to {most}", most=_MOST),
            )
        first, last = self.days(now)
        if first is not None and last is not None and last < first:
            raise PlaceError(
                message("the period ends on {last}, before it begins on {first}", first=str(first), last=str(last)),
                advice=message("exchange the two days"),
            )

    def days(self, now: datetime) -> tuple[date | None, date | None]:
        """Return the first and the last day, both inclusive; None where the period has no such bound.

        Args:
            now: Local time at which the summary was drawn up.

        Raises:
            PlaceError: A day is none.
        """
        today = now.date()
        if self.calendar in _WEEKDAYS:
            day = _latest_weekday(self.calendar, today - _DAY)
            return day, day
        match self.calendar:
            case "today":
                return today, today
            case "yesterday":
                return today - _DAY, today - _DAY
            case "this_week" | "last_week":
                monday = today - today.weekday() * _DAY
                return (monday, today) if self.calendar == "this_week" else (monday - 7 * _DAY, monday - _DAY)
            case "this_month" | "last_month":
                first = today.replace(day=1)
                return (first, today) if self.calendar == "this_month" else _month_before(first)
            case "this_year":
                return date(today.year, 1, 1), today
            case "last_year":
                return date(today.year - 1, 1, 1), date(today.year - 1, 12, 31)
            case _:
                pass
        first_day = _day(self.first_day, today) if self.first_day else None
        if not self.last_day:
            return first_day, None
        return first_day, _day(self.last_day, today, first_day)

    def covers(self, at: datetime, now: datetime) -> bool:
        """Return True if a time is in the period; the last missions are counted by the caller.

        Args:
            at: Local time of a capture.
            now: Local time at which the summary was drawn up.
        """
        if at > now:
            return False
        if self.last_hours is not None:
            return at > now - timedelta(hours=self.last_hours)
        if self.last_days is not None:
            return at > now - timedelta(days=self.last_days)
        if self.last_months is not None:
            return at.replace(tzinfo=None) > _months_before(now.replace(tzinfo=None), self.last_months)
        first, last = self.days(now)
        return (first is None or at.date() >= first) and (last is None or at.date() <= last)


#: The period without bounds.
EVER = Period()


def _latest_weekday(name: str, until: date) -> date:
    return until - ((until.weekday() - _WEEKDAYS.index(name)) % 7) * _DAY


def _month_before(first: date) -> tuple[date, date]:
    last = first - _DAY
    return last.replace(day=1), last


def _months_before(now: datetime, months: int) -> datetime:
    """Return the same time of the same day so many months ago, or of the last day of that month."""
    count = now.year * 12 + now.month - 1 - months
    if count < 12:
        return datetime(1, 1, 1)
    year, month = divmod(count, 12)
    following = date(year + (month == 11), (month + 1) % 12 + 1, 1)
    return now.replace(year=year, month=month + 1, day=min(now.day, (following - _DAY).day))


def _day(text: str, today: date, first: date | None = None) -> date:
    """Return the day that a text states: without a year the latest one, or the first one from ``first`` on.

    Raises:
        PlaceError: It states no day.
    """
    if text in _WEEKDAYS:
        day = _latest_weekday(text, today)
        return day if first is None or day >= first else _latest_weekday(text, first + 6 * _DAY)
    try:
        if not text.startswith("--"):
            return date_from_iso(text)
        years = range(today.year, today.year - 9, -1)
        if first is not None:
            return next(d for d in _yearly(text, range(first.year, first.year + 9)) if d >= first)
        return next(d for d in _yearly(text, years) if d <= today)
    except (ValueError, StopIteration):
        raise PlaceError(
            message("“{day}” is not a day", day=short(text)),
            advice=message("write a day as 2026-11-01, --11-01 or mon"),
        ) from None


def _yearly(text: str, years: range) -> list[date]:
    """Return the day of a month in each of some years in which it exists.

    Raises:
        ValueError: It exists in none.
    """
    month, day = (int(part) for part in text.removeprefix("--").split("-"))
    found = []
    for year in years:
        try:
            found.append(date(year, month, day))
        except ValueError:
            continue
    if not found:
        raise ValueError(text)
    return found
