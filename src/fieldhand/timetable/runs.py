"""Runs of a mission: when each is due, and until when it may begin."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import date, datetime, timedelta, tzinfo

from fieldhand.compatibility import UTC
from fieldhand.errors import TaskError
from fieldhand.language import message
from fieldhand.task.timing import WEEKDAYS, DayTime, Schedule, StartTime
from fieldhand.timetable.day_times import Locality, instant, zone_of
from fieldhand.timetable.days import day_of

#: Minutes within which a mission begins that is to begin at a time.
PUNCTUAL_MIN = 15
#: Days after which the search for another run ends: no sun for half a year, or a date in a later year.
_SEARCHED_DAYS = 400
#: Days from the first day of a part of a year to its last one, at most.
_YEAR_DAYS = 364
_MIDNIGHT = DayTime(clock="00:00")


@dataclass(frozen=True, kw_only=True, order=True)
class DueRun:
    """A run of a mission.

    Attributes:
        due: Instant at which it begins, in UTC.
        latest: Instant until which it may begin.
        done_by: Instant by which it has to be done; None for no such limit.
    """

    due: datetime
    latest: datetime
    done_by: datetime | None = None


@dataclass(frozen=True, kw_only=True)
class Calendar:
    """The calendar of a mission that was approved.

    Attributes:
        approved: Time of approval, with time zone.
        expires: Time after which no run begins.
        zone: Time zone of the robot, for Tasks that state none.
        lat, lon: Position of the site in degrees, WGS 84.
        lasts_s: Seconds that a run takes; an upper estimate.
    """

    approved: datetime
    expires: datetime
    zone: tzinfo
    lat: float
    lon: float
    lasts_s: float = 0.0

    def runs(self, timing: StartTime | Schedule, after: datetime) -> Iterator[DueRun]:
        """Yield the runs that are due after an instant, in order.

        Args:
            timing: Times of the Task.
            after: Runs due at this instant or earlier are left out.

        Raises:
            TaskError: A day, a time or the time zone does not exist, or the schedule never ends a day.
        """
        locality = Locality(zone=zone_of(timing.time_zone, self.zone), lat=self.lat, lon=self.lon)
        every = (
            self._once(timing, locality) if isinstance(timing, StartTime) else self._standing(timing, locality, after)
        )
        for run in every:
            if run.due > self.expires:
                return
            if run.due > after:
                yield run

    def _once(self, start: StartTime, locality: Locality) -> Iterator[DueRun]:
        approved = self.approved.astimezone(locality.zone).date()
        days = (
            [day_of(start.day, approved)]
            if start.day
            else [approved + timedelta(days=n) for n in range(_SEARCHED_DAYS)]
        )
        for day in days:
            run = self._window(start, day, locality)
            if run is not None and run.latest >= self.approved:
                yield replace(run, due=max(run.due, self.approved))
                return

    def _window(self, start: StartTime, day: date, locality: Locality) -> DueRun | None:
        """Return the run of a day; None on a day that lacks an event of the sun."""
        wanted = (start.not_before, start.not_after, start.done_by)
        before, after, done = (None if at is None else instant(at, day, locality) for at in wanted)
        if any(at is not None and found is None for at, found in zip(wanted, (before, after, done), strict=True)):
            return None
        # A window that goes over midnight ends on the next day.
        after, done = _later(after, before), _later(done, after or before)
        ends = [end for end in (after, done and done - timedelta(seconds=self.lasts_s)) if end is not None]
        midnight = instant(_MIDNIGHT, day + timedelta(days=1), locality)
        latest = min(ends) if ends else midnight
        if latest is None:
            return None
        begins = before
        if begins is None:
            begins = instant(_MIDNIGHT, day, locality) if done is None else latest - timedelta(minutes=PUNCTUAL_MIN)
        return None if begins is None else DueRun(due=begins, latest=max(begins, latest), done_by=done)

    def _standing(self, schedule: Schedule, locality: Locality, after: datetime) -> Iterator[DueRun]:
        approved = self.approved.astimezone(locality.zone).date()
        first, last = _first_and_last(schedule, approved)
        if schedule.every_days < 1 or schedule.every_min < 0:
            raise TaskError(
                message(
                    "a schedule of every {days} days, every {minutes} minutes has no runs",
                    days=schedule.every_days,
                    minutes=schedule.every_min,
                ),
                advice=message("give at least one day, and no negative minutes"),
            )
        # A run is dated by its day, but may be due after midnight: the day before ``after`` may still have one.
        day = max(first, after.astimezone(locality.zone).date() - timedelta(days=1))
        idle = 0
        while day <= last and idle < _SEARCHED_DAYS:
            found = self._of_day(schedule, day, locality) if _is_day(schedule, day, first) else ()
            idle = 0 if found else idle + 1
            yield from (run for run in found if run.due >= self.approved)
            day += timedelta(days=1)

    def _of_day(self, schedule: Schedule, day: date, locality: Locality) -> tuple[DueRun, ...]:
        dues = _clock_times(schedule, day, locality)
        end = None if schedule.done_by is None else instant(schedule.done_by, day, locality)
        if end is None and schedule.done_by is not None:
            return ()
        return tuple(self._due(schedule, due, end) for due in dues)

    def _due(self, schedule: Schedule, due: datetime, end: datetime | None) -> DueRun:
        """Return the run of an instant; it may begin as long as it can be done by the end of its day."""
        latest = due + timedelta(minutes=schedule.late_min)
        ends = [due + timedelta(minutes=schedule.done_by_min)] if schedule.done_by_min else []
        if (done := _later(end, due)) is not None:
            ends.append(done)
            latest = max(due, min(latest, done - timedelta(seconds=self.lasts_s)))
        return DueRun(due=due, latest=latest, done_by=min(ends, default=None))


def _first_and_last(schedule: Schedule, approved: date) -> tuple[date, date]:
    """Return the first and the last day; of a part of each year the part that is under way, or else the next one."""
    if schedule.first_day.startswith("--") and schedule.last_day.startswith("--"):
        last = day_of(schedule.last_day, approved)
        return day_of(schedule.first_day, last - timedelta(days=_YEAR_DAYS)), last
    first = day_of(schedule.first_day, approved)
    return first, day_of(schedule.last_day, max(first, approved)) if schedule.last_day else date.max


def _clock_times(schedule: Schedule, day: date, locality: Locality) -> list[datetime]:
    """Return the instants of a day at which a run is due, in order; by the clock, also when it is changed."""
    found = [instant(at, day, locality) for at in schedule.at or (_MIDNIGHT,)]
    first = min((at for at in found if at is not None), default=None)
    if first is None:
        return []
    again = _again(schedule, first, locality) if schedule.every_min else ()
    return sorted({at for at in (*found, *again) if at is not None})


def _again(schedule: Schedule, first: datetime, locality: Locality) -> Iterator[datetime]:
    """Yield the instants of the day after a first one at which the clock shows further times of a schedule."""
    local = first.astimezone(locality.zone)
    until = None if schedule.until is None else instant(schedule.until, local.date(), locality)
    # Seconds of an event of the sun are kept, so that "every hour from sunrise on" is evenly spaced.
    rest = timedelta(seconds=local.second, microseconds=local.microsecond)
    begin = local.hour * 60 + local.minute
    for minutes in range(begin + schedule.every_min, 24 * 60, schedule.every_min):
        clock = DayTime(clock=f"{minutes // 60:02d}:{minutes % 60:02d}")
        at = instant(clock, local.date(), locality)
        if at is None or (until is not None and at + rest > until):
            return
        yield at + rest


def _is_day(schedule: Schedule, day: date, first: date) -> bool:
    weekday = not schedule.weekdays or WEEKDAYS[day.weekday()] in schedule.weekdays
    return weekday and (day - first).days % schedule.every_days == 0


def _later(end: datetime | None, begin: datetime | None) -> datetime | None:
    """Return the end of a window, a day later if it lies before its beginning."""
    if end is None or begin is None or end >= begin:
        return end
    return (end + timedelta(days=1)).astimezone(UTC)
