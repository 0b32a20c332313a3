"""Times of a mission: when it may begin, and when a standing mission runs again.

Times of day are local times of the site. A day on which the clock is changed therefore has its runs at the times that
people read from the clock (RFC 5545, RRULE with local time); :mod:`fieldhand.timetable` computes the instants.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from fieldhand.task.nodes.base import Span

SunEvent = Literal["dawn", "sunrise", "sunset", "dusk"]
Weekday = Literal["mon", "tue", "wed", "thu", "fri", "sat", "sun"]
MissedRule = Literal["skip", "late"]

#: Days of the week from Monday, as :meth:`datetime.date.weekday` counts them.
WEEKDAYS: tuple[Weekday, ...] = ("mon", "tue", "wed", "thu", "fri", "sat", "sun")


@dataclass(frozen=True, kw_only=True)
class DayTime:
    """A time of day: of the clock, or before or after an event of the sun.

    Attributes:
        clock: Local time as ``HH:MM``; empty if ``sun`` is given.
        sun: Event of the sun at the site; dawn and dusk are civil (sun 6° below the horizon).
        offset_min: Minutes after the event of the sun; negative for before.
    """

    clock: str = ""
    sun: SunEvent | None = None
    offset_min: float = 0.0


@dataclass(frozen=True, kw_only=True)
class StartTime:
    """The time at which a mission that runs once begins and is done.

    Attributes:
        day: ``today``, ``tomorrow``, a weekday (``mon``) or a number of days (``+3``), counted from the day of
            approval, or an ISO 8601 date (``2027-03-01``, or ``--03-01`` in the next 12 months); empty for the next day
            on which the times lie ahead.
        not_before: Earliest beginning.
        not_after: Latest beginning.
        done_by: End of the mission, including the way home.
        time_zone: Time zone as in the IANA database (``Europe/Rome``); empty for that of the robot.
        said: Character ranges of the request that state it.
    """

    day: str = ""
    not_before: DayTime | None = None
    not_after: DayTime | None = None
    done_by: DayTime | None = None
    time_zone: str = ""
    said: tuple[Span, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Schedule:
    """The runs of a standing mission.

    A day of a run is one of ``weekdays``, every ``every_days`` days from ``first_day`` on, until ``last_day``. On such
    a day a run is due at ``at``, and with ``every_min`` again after each such number of minutes until ``until``.

    Attributes:
        at: Times of the runs of a day; none for one at midnight.
        every_min: Minutes after the first of these times at which another run is due, again and again; 0 for none.
        until: Latest time of a run of the day; None for the end of the day.
        weekdays: Days of the week; empty for all.
        every_days: 2 for every other day.
        first_day, last_day: First and last day, in the words of :attr:`StartTime.day`; without them the schedule begins
            when it is approved, and ends when the approval expires. ``today`` as last day is the first day.
        late_min: Minutes after a run is due within which it may still begin, if it is done by ``done_by``.
        missed: ``skip`` leaves out a run that could not begin in time; ``late`` makes up for it as soon as possible,
            until the next one is due.
        done_by_min: Minutes after a run is due by which it is done; 0 for no such limit.
        done_by: Time of the day by which a run is done; one earlier than that at which the run is due is meant of the
            next day.
        time_zone: As in :class:`StartTime`.
        said: Character ranges of the request that state it.
    """

    at: tuple[DayTime, ...] = ()
    every_min: int = 0
    until: DayTime | None = None
    weekdays: tuple[Weekday, ...] = ()
    every_days: int = 1
    first_day: str = ""
    last_day: str = ""
    late_min: int = 60
    missed: MissedRule = "skip"
    done_by_min: int = 0
    done_by: DayTime | None = None
    time_zone: str = ""
    said: tuple[Span, ...] = ()


#: Value of :attr:`Schedule.late_min` of a run that may begin late as long as it is done by :attr:`Schedule.done_by`.
ANY_TIME_MIN = 24 * 60

#: When a mission runs.
Timing: TypeAlias = StartTime | Schedule
