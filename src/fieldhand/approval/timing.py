"""Checks of the times of a mission that can be made before it is approved."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from datetime import datetime, timedelta, timezone
from itertools import islice

from fieldhand.approval.problem import PlanProblem
from fieldhand.compatibility import UTC
from fieldhand.errors import TaskError
from fieldhand.forecast.estimate import Estimate
from fieldhand.language import message
from fieldhand.language.words import say_duration
from fieldhand.site.model import Site
from fieldhand.task.frames import Task
from fieldhand.task.timing import Schedule, StartTime
from fieldhand.timetable.runs import Calendar, DueRun

#: Any day will do: a Task with a wrong time is wrong on every day. The approval's own dates are not known yet.
_SOME_DAY = datetime(2027, 3, 1, tzinfo=UTC)
#: Runs that are looked at: those of some days, since the sun's times change slowly.
_LOOKED_AT = 60


def timing_problems(task: Task, site: Site, estimate: Estimate) -> Iterator[PlanProblem]:
    """Yield the problems of the times of a Task.

    Args:
        task: The Task.
        site: Its site.
        estimate: Forecast of one run.
    """
    timing = task.timing
    if timing is None:
        return
    lasts_s = max(branch.seconds.p90 for branch in estimate.branches)
    calendar = Calendar(
        approved=_SOME_DAY,
        expires=_SOME_DAY + timedelta(days=366),
        # Without a time zone, the sun and the clock are those of the site's longitude.
        zone=timezone(timedelta(hours=round(site.start.lon / 15.0))),
        lat=site.start.lat,
        lon=site.start.lon,
    )
    where = message("times")
    try:
        runs = list(islice(calendar.runs(timing, calendar.approved - timedelta(seconds=1)), _LOOKED_AT))
    except TaskError as error:
        yield PlanProblem(where=where, what=error.what, advice=error.advice)
        return
    if not runs and not _dated(timing):
        yield PlanProblem(
            where=where, what=message("there is no day with such a run"), advice=message("change the times")
        )
        return
    if isinstance(timing, StartTime):
        yield from _too_short(timing, lasts_s, calendar)
        return
    yield from _too_often(timing, lasts_s)
    yield from _too_long(timing, lasts_s, runs)


def _dated(timing: StartTime | Schedule) -> bool:
    """Return True if a date decides whether there is a run."""
    return bool(timing.day if isinstance(timing, StartTime) else timing.first_day or timing.last_day)


def _too_short(start: StartTime, lasts_s: float, calendar: Calendar) -> Iterator[PlanProblem]:
    for run in calendar.runs(start, calendar.approved - timedelta(seconds=1)):
        if run.done_by is None or start.not_before is None:
            continue
        yield from _between(run, lasts_s)


def _too_long(schedule: Schedule, lasts_s: float, runs: Sequence[DueRun]) -> Iterator[PlanProblem]:
    """Yield a problem if no run of a schedule can be done by its time of the day."""
    if schedule.done_by is None:
        return
    longest = max(runs, key=lambda run: (run.done_by or run.due) - run.due, default=None)
    if longest is not None:
        yield from _between(longest, lasts_s)


def _between(run: DueRun, lasts_s: float) -> Iterator[PlanProblem]:
    window_s = 0.0 if run.done_by is None else (run.done_by - run.due).total_seconds()
    if run.done_by is not None and 0 <= window_s < lasts_s:
        yield PlanProblem(
            where=message("times"),
            what=message(
                "the mission takes up to {time}, but between its first and its last moment are only {window}",
                time=say_duration(lasts_s),
                window=say_duration(window_s),
            ),
            advice=message("visit fewer places, or give it more time"),
        )


def _too_often(schedule: Schedule, lasts_s: float) -> Iterator[PlanProblem]:
    if schedule.done_by_min and schedule.done_by_min * 60 < lasts_s:
        yield PlanProblem(
            where=message("times"),
            what=message(
                "a run takes up to {time}, but has to be done after {window}",
                time=say_duration(lasts_s),
                window=say_duration(schedule.done_by_min * 60),
            ),
            advice=message("visit fewer places, or give it more time"),
        )
    if 0 < schedule.every_min * 60 < lasts_s:
        yield PlanProblem(
            where=message("times"),
            what=message(
                "a run takes up to {time}, but one is due every {every}",
                time=say_duration(lasts_s),
                every=say_duration(schedule.every_min * 60),
            ),
            advice=message("runs that are due in the meantime begin late or are left out"),
            severity="warning",
        )
