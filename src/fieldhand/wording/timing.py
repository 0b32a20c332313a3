"""Words for the times of a mission: its window, or the schedule of a standing mission."""

from __future__ import annotations

from collections.abc import Iterator

from fieldhand.compatibility import date_from_iso
from fieldhand.language import Number, counted, message
from fieldhand.language.words import listed, say_duration, say_number
from fieldhand.task.timing import ANY_TIME_MIN, DayTime, Schedule, StartTime, Weekday

_EVENTS = {
    "dawn": message("dawn"),
    "sunrise": message("sunrise"),
    "sunset": message("sunset"),
    "dusk": message("dusk"),
}
_ON_WEEKDAYS: dict[Weekday, str] = {
    "mon": message("Mondays"),
    "tue": message("Tuesdays"),
    "wed": message("Wednesdays"),
    "thu": message("Thursdays"),
    "fri": message("Fridays"),
    "sat": message("Saturdays"),
    "sun": message("Sundays"),
}
_WEEKDAYS: dict[str, str] = {
    "mon": message("Monday"),
    "tue": message("Tuesday"),
    "wed": message("Wednesday"),
    "thu": message("Thursday"),
    "fri": message("Friday"),
    "sat": message("Saturday"),
    "sun": message("Sunday"),
}
_MINUTE_S = 60.0


def say_timing(timing: StartTime | Schedule) -> tuple[str, ...]:
    """Return the times of a mission as sentences."""
    sentences = _start(timing) if isinstance(timing, StartTime) else _schedule(timing)
    zone = (
        message("Times are those of the time zone {zone}.", zone=timing.time_zone)
        if timing.time_zone
        else message("Times are those of the robot's time zone.")
    )
    return (*sentences, zone)


def say_day_time(at: DayTime) -> str:
    """Return a time of day: "06:30", "sunrise", "30 min before sunset"."""
    if at.sun is None:
        return Number(at.clock)
    event = _EVENTS[at.sun]
    if at.offset_min == 0:
        return event
    lasting = say_duration(abs(at.offset_min) * _MINUTE_S)
    if at.offset_min < 0:
        return message("{duration} before {event}", duration=lasting, event=event)
    return message("{duration} after {event}", duration=lasting, event=event)


def say_day(words: str) -> str:
    """Return a day in the form that follows "Begins": "tomorrow", "on Monday", "on 2027-03-01"."""
    match words:
        case "today":
            return message("on the day of approval")
        case "tomorrow":
            return message("on the day after approval")
    if words.startswith("+") and words[1:].isdecimal():
        return counted("on the day after approval", "{count} days after approval", int(words[1:]))
    if words in _WEEKDAYS:
        return message("on the next {weekday} after approval", weekday=_WEEKDAYS[words])
    return message("on {date}", date=_date(words))


def _date(words: str) -> str:
    """Return a date; one without a year as month and day."""
    yearly = words.removeprefix("--")
    try:
        date_from_iso(words if yearly == words else f"2000-{yearly}")
    except ValueError:
        return words
    return Number(yearly)


def _start(start: StartTime) -> Iterator[str]:
    day = say_day(start.day) if start.day else message("at the next such time")
    before, after = (None if at is None else say_day_time(at) for at in (start.not_before, start.not_after))
    if before is not None and after is not None:
        yield message("Begins {day}, between {first} and {last}.", day=day, first=before, last=after)
    elif before is not None:
        yield message("Begins {day}, not before {time}.", day=day, time=before)
    elif after is not None:
        yield message("Begins {day}, at {time} at the latest.", day=day, time=after)
    elif start.day:
        yield message("Begins {day}.", day=day)
    if start.done_by is not None:
        yield message("Is done by {time}, including the way home.", time=say_day_time(start.done_by))


def _schedule(schedule: Schedule) -> Iterator[str]:
    only_day = _is_one_day(schedule)
    days = say_day(schedule.first_day) if only_day else _days(schedule)
    yield message("Runs {days}, {times}.", days=days, times=_times(schedule))
    if only_day:
        pass
    elif schedule.first_day and schedule.last_day:
        yield message(
            "The first run is {first}, the last {last}.",
            first=say_day(schedule.first_day),
            last=say_day(schedule.last_day),
        )
    elif schedule.first_day:
        yield message("The first run is {first}.", first=say_day(schedule.first_day))
    elif schedule.last_day:
        yield message("The last run is {last}.", last=say_day(schedule.last_day))
    late = say_duration(schedule.late_min * _MINUTE_S)
    if schedule.done_by is not None:
        yield message("Each run is done by {time}, including the way home.", time=say_day_time(schedule.done_by))
    if schedule.done_by is not None and schedule.late_min >= ANY_TIME_MIN and schedule.missed == "skip":
        yield message("A run that cannot begin in time for that is left out.")
    elif schedule.missed == "late":
        yield message(
            "A run that cannot begin within {time} begins as soon as it can, until the next one is due.", time=late
        )
    else:
        yield message("A run that cannot begin within {time} is left out.", time=late)
    if schedule.done_by_min:
        done = say_duration(schedule.done_by_min * _MINUTE_S)
        yield message("Each run is done {time} after it is due, including the way home.", time=done)
    if not schedule.last_day:
        yield message("No run begins after the approval has expired.")


def _is_one_day(schedule: Schedule) -> bool:
    """Return True if the last day, which counts from the first one, is the first one."""
    first, last = schedule.first_day, schedule.last_day
    return bool(first) and (last == "today" or (first == last and first[:1] in "-0123456789"))


def _days(schedule: Schedule) -> str:
    if schedule.weekdays:
        on = message("on {weekdays}", weekdays=listed([_ON_WEEKDAYS[day] for day in schedule.weekdays]))
        if schedule.every_days == 1:
            return on
        return message("{weekdays}, every {count} days", weekdays=on, count=say_number(schedule.every_days))
    return counted("every day", "every {count} days", schedule.every_days)


def _times(schedule: Schedule) -> str:
    at = listed([say_day_time(one) for one in schedule.at]) if schedule.at else message("midnight")
    if not schedule.every_min:
        return message("at {time}", time=at)
    every = say_duration(schedule.every_min * _MINUTE_S)
    if schedule.until is None:
        return message("every {duration} from {time} on", duration=every, time=at)
    return message(
        "every {duration} from {first} until {last}", duration=every, first=at, last=say_day_time(schedule.until)
    )
