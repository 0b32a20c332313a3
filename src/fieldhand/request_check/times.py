"""Compare the times that a request names with those of its plan."""

from __future__ import annotations

import re
from collections.abc import Iterator

from fieldhand.request_check import words as w
from fieldhand.task.frames import Task
from fieldhand.task.timing import WEEKDAYS, DayTime, Schedule, StartTime, Timing

_NUMBER = re.compile(r"\d+")
_WEEKDAY = re.compile(r"\b(mon|tues|wednes|thurs|fri|satur|sun)day")


def without_stated_times(request: str, task: Task) -> str:
    """Return a request without the words from which the times of its plan come, if these times are what they say."""
    if task.timing is None:
        return request
    for start, end in task.timing.said:
        words = task.command.request[start:end]
        if states(words.lower(), task.timing):
            request = request.replace(words, " ", 1)
    return request


def states(words: str, timing: Timing) -> bool:
    """Return True if every number and day of the week in some words occurs in a timing.

    Args:
        words: Words of a request about a time or a schedule, in lower case.
        timing: Times of the plan.
    """
    known = set(_numbers(timing))
    numbers = [float(text) for text in _NUMBER.findall(words)]
    numbers += [float(w.NUMBERS[word]) for word in words.split() if word in w.NUMBERS]
    days = {found[:3] for found in _WEEKDAY.findall(words)}
    return known.issuperset(numbers) and days <= set(_weekdays(timing))


def _weekdays(timing: Timing) -> Iterator[str]:
    named = (timing.day,) if isinstance(timing, StartTime) else (timing.first_day, timing.last_day, *timing.weekdays)
    yield from (day for day in named if day in WEEKDAYS)


def _numbers(timing: Timing) -> Iterator[float]:
    """Yield each number by which people may state the times: of a clock of 12 or 24 hours, in minutes and hours."""
    if isinstance(timing, StartTime):
        times: tuple[DayTime | None, ...] = (timing.not_before, timing.not_after, timing.done_by)
        yield from _of_day(timing.day)
    else:
        times = (*timing.at, timing.until, timing.done_by)
        yield from _of_schedule(timing)
    for at in times:
        if at is not None and at.sun is None:
            hour, minute = (float(part) for part in _NUMBER.findall(at.clock)[:2]) if ":" in at.clock else (0.0, 0.0)
            yield from (hour, (hour - 1) % 12 + 1, minute, 100 * hour + minute)
        elif at is not None:
            yield from (abs(at.offset_min), abs(at.offset_min) / 60)


def _of_schedule(schedule: Schedule) -> Iterator[float]:
    yield from (float(schedule.every_min), schedule.every_min / 60)
    yield from (float(schedule.every_days), schedule.every_days / 7)
    yield float(len(schedule.at))  # "three times a day"
    if schedule.done_by_min and len(schedule.at) == 1 and schedule.at[0].sun is None:
        hour, minute = (int(part) for part in _NUMBER.findall(schedule.at[0].clock))
        end = (hour * 60 + minute + schedule.done_by_min) % (24 * 60)
        yield from (float(end // 60), (end // 60 - 1) % 12 + 1.0, float(end % 60))
    for day in (schedule.first_day, schedule.last_day):
        yield from _of_day(day)


def _of_day(day: str) -> Iterator[float]:
    numbers = [float(text) for text in _NUMBER.findall(day)]
    yield from numbers
    if day.startswith("+"):  # "for 10 days" ends 9 days after the first
        yield from (number + 1 for number in numbers)
        yield from ((number + 1) / 7 for number in numbers)
        yield from (number / 7 for number in numbers)
