"""Meaning of the phrases that say when a mission runs, and the timing that several of them add up to."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

from fieldhand.planning.grammar.times.windows import DAYLIGHT, DayWindow, Half, contradicts
from fieldhand.task.plan import Span
from fieldhand.task.timing import ANY_TIME_MIN, DayTime, Schedule, StartTime, Timing, Weekday

#: Minutes within which a mission begins that is to begin at a time, and one that is to begin at about a time.
PUNCTUAL_MIN, ROUGHLY_MIN = 15, 30
_DAY_MIN = 24 * 60


@dataclass(frozen=True, kw_only=True, slots=True)
class TimePart:
    """A part of a timing, such as "at 6 am", "every Monday" or "until 31 December".

    Attributes:
        repeats: True if the mission runs again and again.
        day: Day of a mission that runs once.
        weekdays: Days of the week.
        every_days: Number of days from one run to the next, 1 for every day; 0 if not said.
        every_min: Number of minutes from one run to the next; 0 if not said.
        at: Times at which it begins.
        late_min: Minutes after these within which it may begin; 0 if not said.
        choices: Times to choose from, where an hour may be in the morning or in the evening.
        window: Part of the day, where one is named.
        not_before, done_by: Bounds of the time of day.
        first_day, last_day: Bounds of the days.
        hour_at, hour_after, hour_before: Hours of the clock of 12 hours at which it begins, before which it does not,
            and before which it is done; 0 if not said.
        half: Half of the day of these hours, if the phrase says it.
        disputed: True if a time is said that lies in another part of the day than the one that is said.
        needs_day: True if it is no time without a day ("first thing").
        times_a_day: Number of times of the day that must be said ("twice a day"); 0 if not said.
        awaits: True if the request says that the robot waits for the time somewhere ("wait at the gate until 6 pm").
        vague: True if it runs again and again, without saying how often ("every so often until evening").
        further: True for another time of the same day, behind what is done at the first ("and again at 2 pm").
    """

    repeats: bool = False
    day: str = ""
    weekdays: tuple[Weekday, ...] = ()
    every_days: int = 0
    every_min: int = 0
    at: tuple[DayTime, ...] = ()
    late_min: int = 0
    choices: tuple[DayTime, ...] = ()
    window: DayWindow | None = None
    not_before: DayTime | None = None
    done_by: DayTime | None = None
    first_day: str = ""
    last_day: str = ""
    hour_at: float = 0.0
    hour_after: float = 0.0
    hour_before: float = 0.0
    half: Half = ""
    disputed: bool = False
    times_a_day: int = 0
    needs_day: bool = False
    further: bool = False
    awaits: bool = False
    vague: bool = False

    def __and__(self, other: TimePart) -> TimePart | None:
        """Return both parts together; None if they contradict each other."""
        if other.further:
            return self.joined(replace(other, further=False))
        merged: dict[str, object] = {}
        for field in fields(self):
            mine, theirs = getattr(self, field.name), getattr(other, field.name)
            if mine and theirs and mine != theirs:
                return None
            merged[field.name] = mine or theirs
        both = TimePart(**merged)  # type: ignore[arg-type]  # each value is that of its field
        return None if both.is_in_other_half else both

    def disputing(self, other: TimePart) -> TimePart | None:
        """Return both parts together, even if a time of one lies in another part of the day than the other says.

        None if they contradict each other in anything else.
        """
        both = replace(self, window=None, half="") & replace(other, window=None, half="")
        window, half = self.window or other.window, self.half or other.half
        if both is None or window is None or {self.half, other.half} != {"", half} or both._bounds or not both.at:
            return None
        return replace(both, window=window, half=half, disputed=True)

    def joined(self, other: TimePart) -> TimePart | None:
        """Return a part of several times of a day: those of both parts; None if one says another thing.

        The first may say the days, which are those of the second as well.
        """
        first, then = self._at_times(), other._at_times()
        if first is not None and then is not None and first.repeats and not first.weekdays and first.every_days < 2:
            then = replace(
                then, repeats=False, every_days=0 if then.every_days == 1 else then.every_days
            )  # "and every evening at six"
        if first is None or then is None or then != TimePart(at=then.at) or first._bounds or first.every_min:
            return None
        both = (*first.at, *then.at)
        return replace(first, at=both) if len({*both}) == len(both) else None

    def _at_times(self) -> TimePart | None:
        """Return the part with times of the clock, without the part of the day that they are in; None without times."""
        timed = self._on_the_clock()
        if timed is None or not timed.at or timed.disputed or timed.late_min:
            return None
        return replace(timed, window=None, half="")

    @property
    def _bounds(self) -> tuple[DayTime, ...]:
        return tuple(at for at in (self.not_before, self.done_by) if at is not None)

    @property
    def is_in_other_half(self) -> bool:
        """True for "at 17:30 in the morning"."""
        times = [at for at in (*self.at, self.not_before) if at is not None]
        return not self.disputed and any(contradicts(at, self.half) for at in times)

    @property
    def says_how_often(self) -> bool:
        """True for "every day" and "on Mondays", but not for "until Friday"."""
        return self.repeats and bool(self.every_days or self.every_min or self.weekdays or self.window)

    @property
    def _runs_all_night(self) -> bool:
        """True for runs from hour to hour that go on after midnight."""
        return bool(self.every_min) and self.window is not None and self.window.half == "night"

    @property
    def takes(self) -> DayWindow | None:
        """The part of the day in which it takes place, if no time of the day is said."""
        if self._says_a_time:
            return None
        if self.window is not None:
            return self.window
        by_day = self.says_how_often if self.repeats else self.weekdays or self.day not in ("", "today")
        return DAYLIGHT if by_day else None

    @property
    def _says_a_time(self) -> bool:
        return bool(self._hours or self.at or self._bounds or self.every_min or self.choices)

    @property
    def asks(self) -> tuple[DayTime, ...]:
        """The times of day to choose from, if it says no time."""
        if (hours := self._hours) and not (self.half or self._usual_half):
            return (_clock(hours[0], "am"), _clock(hours[0], "pm"))
        if self.every_min and self.done_by is not None and not (self.at or self.not_before or self.window or hours):
            return tuple(at for at in _USUAL if at.clock < (self.done_by.clock or "18:00"))  # "every hour until 6 pm"
        if hours or self.at or self._bounds or self.every_min:
            return ()
        if self.choices or self.takes is not None:
            return self.choices
        return _USUAL if self.repeats else ()

    @property
    def _hours(self) -> tuple[float, ...]:
        """The hours of the clock of 12 hours, in the order of the day."""
        return tuple(hour for hour in (self.hour_at, self.hour_after, self.hour_before) if hour)

    @property
    def assumed_half(self) -> DayTime | None:
        """The time that is assumed for the first hour of 12 if nothing says which half of the day it is in."""
        hours = self._hours
        return _clock(hours[0], self._usual_half) if hours and not self.half and self._usual_half else None

    @property
    def _usual_half(self) -> Half:
        """The half of the day of the first hour that is usual; that of a range from 6 to 8 on is the morning."""
        hours = self._hours
        if len(hours) > 1 and 6.0 <= hours[0] < 9.0:
            return "am"
        return _usual_half(hours[0]) if hours else ""

    def answered(self, at: DayTime) -> TimePart:
        """Return the part with the time that was chosen of those to choose from."""
        if self._hours:
            return replace(self, half="am" if at.clock < "12:00" else "pm")
        return replace(self, at=(at,), choices=())

    def _on_the_clock(self) -> TimePart | None:
        """Return the part with times of the clock of 24 hours; None if it says a time twice."""
        hours = self._hours
        if not hours:
            return self
        half = self.half or self._usual_half
        if (
            not half
            or (self.hour_at and self.at)
            or (self.hour_after and self.not_before)
            or (self.hour_before and self.done_by)
        ):
            return None
        first = _clock(hours[0], half)
        last = _clock(hours[-1], half)
        if half == "night" and self._is_of_a_day and any(_clock(hour, half).clock < "12:00" for hour in hours[:1]):
            return None  # "tonight at two" is on the next day
        if len(hours) > 1 and half != "night" and last.clock <= first.clock:
            last = _clock(hours[-1], "pm" if half == "am" else "am")
        return replace(
            self,
            at=(first,) if self.hour_at else self.at,
            not_before=first if self.hour_after else self.not_before,
            done_by=last if self.hour_before else self.done_by,
            hour_at=0.0, hour_after=0.0, hour_before=0.0, choices=(),
        )  # fmt: skip

    def timing(self, said: tuple[Span, ...], zone: str) -> Timing | None:
        """Return the timing; None if it is none that a Task can hold.

        Args:
            said: Ranges of the request that say it.
            zone: Time zone of the site; empty if it states none.
        """
        whole = self._resolved()
        if whole is None:
            return None
        if whole.day and (len(whole.at) > 1 or whole.every_min) and not (whole.first_day or whole.last_day):
            last = whole.day if whole.day[:1] in "-2" else "today"  # which counts from the first day
            whole = replace(whole, repeats=True, day="", first_day=whole.day, last_day=last)
        return whole._standing(said, zone) if whole.repeats else whole._once(said, zone)

    def _resolved(self) -> TimePart | None:
        """Return the part with a day of the week as a single day, or as days of a standing mission."""
        timed = self._on_the_clock()
        return None if timed is None or timed.disputed or timed._runs_all_night else timed._in_its_window()._on_days()

    def _in_its_window(self) -> TimePart:
        """Return the part with the bounds of the part of the day that it names, or of daylight."""
        if (window := self.takes) is not None:
            return replace(self, not_before=window.begin, done_by=window.end, late_min=self.late_min or ANY_TIME_MIN)
        if self.every_min and self.window is not None and not (self.at or self._bounds):
            return replace(self, not_before=self.window.begin, done_by=self.window.end)
        if self.repeats and self.window is not None and self.done_by is not None and not (self.at or self.not_before):
            shorter = self.window.until(self.done_by)  # "every morning before 9"
            return self if shorter is None else replace(self, not_before=shorter.begin, late_min=ANY_TIME_MIN)
        return self

    def _on_days(self) -> TimePart | None:
        if self.times_a_day not in (0, len(self.at)) or (self.needs_day and not (self.day or self.weekdays)):
            return None
        if not self.repeats and self.weekdays:
            if len(self.weekdays) > 1:
                return replace(self, repeats=True)
            return None if self.day else replace(self, day=self.weekdays[0], weekdays=())
        return self

    @property
    def _is_of_a_day(self) -> bool:
        return bool(self.day or self.weekdays)

    def _once(self, said: tuple[Span, ...], zone: str) -> Timing | None:
        if len(self.at) > 1 or self.first_day or self.last_day or self.every_days or self.every_min:
            return None
        begin = self.at[0] if self.at else self.not_before
        latest = _later(self.at[0], self.late_min or PUNCTUAL_MIN) if self.at else None
        return StartTime(
            day=self.day, not_before=begin, not_after=latest, done_by=self.done_by, time_zone=zone, said=said
        )

    def _standing(self, said: tuple[Span, ...], zone: str) -> Schedule | None:
        at = self.at or (() if self.not_before is None else (self.not_before,))
        within, done_by = 0, None
        if self.done_by is not None and not self.every_min:
            length = None if len(at) != 1 else _minutes_between(at[0], self.done_by)
            if not at:
                return None
            if length is None or self.late_min == ANY_TIME_MIN:
                done_by = self.done_by
            else:
                within = length
        if self.day:
            return None
        late = ANY_TIME_MIN if done_by is not None and not self.at else 60
        return Schedule(
            at=at,
            every_min=self.every_min,
            until=self.done_by if self.every_min else None,
            weekdays=self.weekdays,
            every_days=self.every_days or 1,
            first_day=self.first_day,
            last_day=self.last_day,
            late_min=self.late_min or (min(60, self.every_min) if self.every_min else late),
            done_by_min=within,
            done_by=done_by,
            time_zone=zone,
            said=said,
        )


#: Times to choose from where a day or a repetition names none.
_USUAL = (DayTime(clock="06:00"), DayTime(clock="08:00"), DayTime(clock="12:00"), DayTime(sun="sunrise"))


def _usual_half(hour: float) -> Half:
    """Return the half of the day in which people work at an hour of 12; empty if they may in both."""
    if hour >= 12.0 or hour < 6.0:
        return "pm"
    return "am" if hour >= 9.0 else ""


def _clock(hour: float, half: str) -> DayTime:
    """Return an hour of the clock of 12 hours, such as 9.5, as a time of the day; at night, those from 6 on are p.m."""
    late = half == "pm" or (half == "night" and 6.0 <= hour < 12.0)
    minutes = round((hour % 12) * 60) + (720 if late else 0)
    return DayTime(clock=f"{minutes // 60:02d}:{minutes % 60:02d}")


def _later(at: DayTime, minutes: int) -> DayTime:
    """Return a time some minutes later."""
    if at.sun is not None:
        return replace(at, offset_min=at.offset_min + minutes)
    hour, minute = (int(part) for part in at.clock.split(":"))
    hour, minute = divmod((hour * 60 + minute + minutes) % _DAY_MIN, 60)
    return DayTime(clock=f"{hour:02d}:{minute:02d}")


def _minutes_between(begin: DayTime, end: DayTime) -> int | None:
    """Return the minutes between two times; None if they depend on the day."""
    if begin.sun is not None and begin.sun == end.sun:
        return max(0, round(end.offset_min - begin.offset_min)) or None
    if begin.sun is not None or end.sun is not None:
        return None
    first, last = (int(at.clock[:2]) * 60 + int(at.clock[3:]) for at in (begin, end))
    return (last - first) % _DAY_MIN or None
