"""Constructions of times: of the clock and the sun, days and dates, repetition, and their bounds."""

from __future__ import annotations

from calendar import monthrange
from dataclasses import replace
from datetime import date

from fieldhand.compatibility import date_from_iso
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.times.meaning import ROUGHLY_MIN, TimePart
from fieldhand.planning.grammar.times.windows import DAYLIGHT, WINDOWS
from fieldhand.planning.grammar.words import Lex
from fieldhand.task.timing import WEEKDAYS, DayTime

GRAMMAR = Grammar()
construction = GRAMMAR.construction


def _clock(hour: float, minute: float = 0) -> DayTime | None:
    if hour != int(hour) or minute != int(minute) or not 0 <= hour <= 23 or not 0 <= minute <= 59:
        return None
    return DayTime(clock=f"{int(hour):02d}:{int(minute):02d}")


# --- times of day -------------------------------------------------------------------------------------------------


@construction("hours: hour=NUM", "hours: hour=NUM COLON minute=MINUTE", cost=0.0)
def hours(hour: Lex, minute: Lex | None = None) -> tuple[float, float] | None:
    """Compose "6" and "6:30" before "am" or "pm"."""
    return (hour.value, 0 if minute is None else minute.value) if 0 < hour.value <= 12 else None


@construction("clock: at=hours AM", "clock: at=hours [OCLOCK] AM", "clock: at=spoken AM", cost=0.1)
def before_noon(at: tuple[float, float]) -> DayTime | None:
    """Compose "6:30 am" and "six in the morning"."""
    return _clock(at[0] % 12, at[1])


@construction("clock: at=hours PM", "clock: at=hours [OCLOCK] PM", "clock: at=spoken PM", cost=0.1)
def after_noon(at: tuple[float, float]) -> DayTime | None:
    """Compose "6:30 pm"; "12 at night" is midnight only for those who say so."""
    return _clock(at[0] % 12 + 12, at[1])


@construction("clock: hour=NUM COLON minute=MINUTE", "clock: hour=NUM COLON minute=MINUTE HOURS", cost=0.2)
def on_the_clock(hour: Lex, minute: Lex) -> DayTime | None:
    """Compose "18:30"."""
    return _clock(hour.value, minute.value)


@construction("clock: digits=FOURDIGITS HOURS", cost=0.2)
def military(digits: Lex) -> DayTime | None:
    """Compose "0600 hours"."""
    return _clock(digits.value // 100, digits.value % 100)


@construction("clock: hour=NUM OCLOCK", cost=0.3)
def oclock(hour: Lex) -> list[DayTime] | None:
    """Compose "6 o'clock", which is in the morning or in the evening."""
    if not 0 < hour.value <= 12:
        only = _clock(hour.value)
        return None if only is None else [only]
    found = [_clock(hour.value % 12), _clock(hour.value % 12 + 12)]
    return [at for at in found if at is not None]


@construction("spoken: HALF PAST hour=NUM", cost=0.1)
def half_past(hour: Lex) -> tuple[float, float] | None:
    """Compose "half past six"."""
    return (hour.value, 30) if 0 < hour.value <= 12 else None


@construction("spoken: QUARTER PAST hour=NUM", cost=0.1)
def quarter_past(hour: Lex) -> tuple[float, float] | None:
    """Compose "a quarter past six"."""
    return (hour.value, 15) if 0 < hour.value <= 12 else None


@construction("spoken: QUARTER TOHOUR hour=NUM", cost=0.1)
def quarter_to(hour: Lex) -> tuple[float, float] | None:
    """Compose "a quarter to six"."""
    return ((hour.value - 2) % 12 + 1, 45) if 0 < hour.value <= 12 else None


@construction("clock: at=spoken", cost=0.4)
def half_past_either(at: tuple[float, float]) -> list[DayTime]:
    """Compose "half past six", in the morning or in the evening."""
    found = [_clock(at[0] % 12, at[1]), _clock(at[0] % 12 + 12, at[1])]
    return [one for one in found if one is not None]


@construction("clock: named=CLOCKNAME", cost=0.0)
def named_time(named: Lex) -> DayTime:
    """Compose "noon"."""
    return DayTime(clock=named.value)


@construction("daytime: at=clock", cost=0.0)
def by_the_clock(at: DayTime) -> DayTime:
    """Compose a time of the clock."""
    return at


@construction("daytime: sun=SUN", cost=0.0)
def by_the_sun(sun: Lex) -> DayTime:
    """Compose "sunrise"."""
    return DayTime(sun=sun.value)


@construction("minutes: n=NUM MINUTES", cost=0.0)
def some_minutes(n: Lex) -> float:
    """Compose "30 minutes"."""
    return float(n.value)


@construction("minutes: n=NUM HOURS", cost=0.0)
def some_hours(n: Lex) -> float:
    """Compose "2 hours"."""
    return float(n.value) * 60


@construction("minutes: AN HOURS", "minutes: HOURS", cost=0.0)
def one_hour() -> float:
    """Compose "an hour"."""
    return 60.0


@construction("minutes: QUARTER OF AN HOURS", "minutes: QUARTER HOURS", cost=0.0)
def quarter_of_an_hour() -> float:
    """Compose "a quarter of an hour"."""
    return 15.0


@construction("minutes: HALF AN HOURS", "minutes: HALF HOURS", cost=0.0)
def half_an_hour() -> float:
    """Compose "half an hour"."""
    return 30.0


@construction("lasting: FOR by=minutes", "lasting: FOR THE by=minutes", "lasting: by=minutes ALTOGETHER", cost=0.0)
def lasting(by: float) -> float:
    """Compose "for half an hour", which is no time of the mission."""
    return by


@construction("daytime: by=minutes BEFORE sun=SUN", cost=0.1)
def before_the_sun(by: float, sun: Lex) -> DayTime:
    """Compose "an hour before sunrise"."""
    return DayTime(sun=sun.value, offset_min=-by)


@construction("daytime: by=minutes PAST sun=SUN", cost=0.1)
def after_the_sun(by: float, sun: Lex) -> DayTime:
    """Compose "30 minutes after sunset"."""
    return DayTime(sun=sun.value, offset_min=by)


# --- when it begins and ends --------------------------------------------------------------------------------------


@construction("part: AT at=daytime", "part: at=clock", "part: at=exact_sun", cost=0.1)
def at_a_time(at: DayTime) -> TimePart:
    """Compose "at 6 am"."""
    return TimePart(at=(at,))


@construction("exact_sun: by=minutes BEFORE sun=SUN", cost=0.1)
def exactly_before(by: float, sun: Lex) -> DayTime:
    """Compose "an hour before sunrise" without a preposition."""
    return before_the_sun(by, sun)


@construction("exact_sun: by=minutes PAST sun=SUN", cost=0.1)
def exactly_after(by: float, sun: Lex) -> DayTime:
    """Compose "30 minutes after sunset" without a preposition."""
    return after_the_sun(by, sun)


@construction("part: AROUND at=daytime", cost=0.1)
def at_about(at: DayTime) -> TimePart:
    """Compose "around 6 am"."""
    return TimePart(at=(at,), late_min=ROUGHLY_MIN)


@construction("further: [COMMA] AND", "further: [COMMA] ANDAGAIN", "further: COMMA", cost=0.0)
def further() -> str:
    """Compose ", and once more" between times of a day."""
    return "and"


@construction("part: first=part further at=daytime", "part: first=part further then=part", cost=0.2)
@construction("part: first=bare further at=daytime", cost=0.2)
def and_at(first: TimePart, at: DayTime | None = None, then: TimePart | None = None) -> TimePart | None:
    """Compose "at 6 am, noon and 6 pm" and "at 7 in the morning and once more at 2 pm"."""
    return first.joined(TimePart(at=(at,)) if at is not None else then or TimePart())


@construction("part: ANDAGAIN then=part", cost=0.3)
def and_again_at(then: TimePart) -> TimePart | None:
    """Compose "and again at 2 pm" behind what is done at the first time."""
    return replace(then, further=True) if then == TimePart(at=then.at) and then.at else None


@construction("bare: sun=SUN", cost=0.0)
def bare_sun(sun: Lex) -> TimePart:
    """Compose "sunrise" as the first of several times."""
    return TimePart(at=(DayTime(sun=sun.value),))


@construction("hour_list: one=NUM COMMA other=NUM", cost=0.1)
def two_hours(one: Lex, other: Lex) -> tuple[float, ...]:
    """Compose "6, 12" in a list of hours."""
    return (one.value, other.value)


@construction("hour_list: known=hour_list COMMA other=NUM", cost=0.1)
def more_hours(known: tuple[float, ...], other: Lex) -> tuple[float, ...]:
    """Compose longer lists."""
    return (*known, other.value)


@construction("part: AT first=NUM AND last=NUM OCLOCK", "part: AT known=hour_list AND last=NUM OCLOCK", cost=0.1)
@construction("part: AT first=NUM AND last=NUM HOURS", "part: AT known=hour_list AND last=NUM HOURS", cost=0.1)
@construction("part: AT known=hour_list COMMA AND last=NUM OCLOCK", cost=0.1)
def at_hours(last: Lex, first: Lex | None = None, known: tuple[float, ...] = ()) -> TimePart | None:
    """Compose "at 6, 12 and 18 o'clock", by the clock of 24 hours if one of them is."""
    every = (*known, *(() if first is None else (first.value,)), last.value)
    return _at_all(tuple(_clock(hour) for hour in every)) if max(every) > 12 else None


@construction("part: AT first=NUM AND last=NUM AM", "part: AT known=hour_list AND last=NUM AM", cost=0.1)
def at_hours_before_noon(last: Lex, first: Lex | None = None, known: tuple[float, ...] = ()) -> TimePart | None:
    """Compose "at 6 and 8 am"."""
    return _at_all_hours((*known, *(() if first is None else (first.value,)), last.value), 0)


@construction("part: AT first=NUM AND last=NUM PM", "part: AT known=hour_list AND last=NUM PM", cost=0.1)
def at_hours_after_noon(last: Lex, first: Lex | None = None, known: tuple[float, ...] = ()) -> TimePart | None:
    """Compose "at 2, 4 and 6 pm"; "at 10, 12 and 2 pm" begins in the morning, which it does not say."""
    return _at_all_hours((*known, *(() if first is None else (first.value,)), last.value), 12)


def _at_all_hours(every: tuple[float, ...], noon: int) -> TimePart | None:
    hours = [hour % 12 + noon for hour in every]
    if not all(0 < hour <= 12 for hour in every) or hours != sorted(hours):
        return None
    return _at_all(tuple(_clock(hour) for hour in hours))


def _at_all(times: tuple[DayTime | None, ...]) -> TimePart | None:
    """Return several times of a day; None if one is none, or is said twice."""
    known = tuple(at for at in times if at is not None)
    return TimePart(at=known) if len({*known}) == len(times) else None


@construction("part: BEFORE end=daytime", "part: BY end=daytime", "part: [RUN] FINISH BEFORE end=daytime", cost=0.1)
@construction("part: FINISH BY end=daytime", "part: FINISH AT end=daytime", cost=0.0)
def done_before(end: DayTime) -> TimePart:
    """Compose "before sunrise" and "be done by 8 am"."""
    return TimePart(done_by=end)


@construction("part: AFTER begin=daytime", "part: AFTER begin=daytime ON", cost=0.1)
@construction("part: FROM AT begin=daytime", "part: FROM begin=daytime", cost=0.1)
def not_before(begin: DayTime) -> TimePart:
    """Compose "after 8 pm" and "not before sunrise"."""
    return TimePart(not_before=begin)


@construction("part: BETWEEN begin=daytime AND end=daytime", "part: FROM begin=daytime TO end=daytime", cost=0.0)
@construction("part: AFTER begin=daytime TO end=daytime", cost=0.0)
def between(begin: DayTime, end: DayTime) -> TimePart:
    """Compose "between 6 am and 8 am"."""
    return TimePart(not_before=begin, done_by=end)


@construction("part: BETWEEN begin=NUM AND end=clock", "part: FROM begin=NUM TO end=clock", cost=0.1)
@construction("part: AFTER begin=NUM TO end=clock", cost=0.1)
def between_hours(begin: Lex, end: DayTime) -> TimePart | None:
    """Compose "between 6 and 8 am"."""
    hour = int(end.clock[:2])
    noon = 12 if hour > 12 and begin.value < hour - 12 else 0
    first = _clock(begin.value + noon) if 0 < begin.value <= 12 else None
    return None if first is None else TimePart(not_before=first, done_by=end)


@construction("part: ASSOON at=sun_alone", cost=0.1)
def as_soon_as_the_sun(at: DayTime) -> TimePart:
    """Compose "as soon as the sun is up"."""
    return TimePart(at=(at,))


@construction("sun_alone: sun=SUN", cost=0.0)
def sun_alone(sun: Lex) -> DayTime | None:
    """Compose "the sun is up"; "sunrise" is no clause."""
    return DayTime(sun=sun.value) if " " in sun.text else None


@construction("part: WAITUNTIL begin=daytime", "part: WAITUNTIL begin=daytime day=part", cost=0.0)
def wait_until(begin: DayTime, day: TimePart | None = None) -> TimePart | None:
    """Compose "wait until sunset"."""
    first = TimePart(not_before=begin)
    return first if day is None else first & day


@construction("part: WAITUNTIL hour=hour day=part", cost=0.0)
def wait_until_hour(hour: float, day: TimePart) -> TimePart | None:
    """Compose "wait until seven this evening"."""
    return hour_of_day(day, TimePart(hour_after=hour))


@construction("part: UNTIL end=daytime", cost=0.3)
def until_a_time(end: DayTime) -> TimePart:
    """Compose "until 8 pm", of a mission that runs again and again."""
    return TimePart(repeats=True, done_by=end)


# --- hours of the clock of 12 hours, beside a day or a part of it ---------------------------------------------------


@construction("hour: said=HOUR12", "hour: said=HOUR12 OCLOCK", cost=0.0)
def bare_hour(said: Lex) -> float:
    """Compose "nine"."""
    return float(said.value)


@construction("hour: at=spoken", cost=0.0)
def spoken_hour(at: tuple[float, float]) -> float:
    """Compose "half past nine"."""
    return at[0] + at[1] / 60


@construction("hour_part: AT at=hour", "hour_part: SAYABOUT at=hour", cost=0.1)
def at_hour(at: float) -> TimePart:
    """Compose "at nine"."""
    return TimePart(hour_at=at)


@construction("hour_part: AROUND at=hour", "hour_part: AT AROUND at=hour", cost=0.1)
def at_about_hour(at: float) -> TimePart:
    """Compose "at about nine"."""
    return TimePart(hour_at=at, late_min=ROUGHLY_MIN)


@construction("hour_part: AFTER begin=hour", "hour_part: AFTER begin=hour ON", "hour_part: FROM begin=hour", cost=0.1)
@construction("hour_part: FROM begin=hour ONWARDS", "hour_part: FROM AT begin=hour", cost=0.0)
@construction("hour_part: ATEARLIEST [AT] begin=hour", "hour_part: [AT] begin=hour ATEARLIEST", cost=0.0)
def after_hour(begin: float) -> TimePart:
    """Compose "not before nine"."""
    return TimePart(hour_after=begin)


@construction("hour_part: BEFORE end=hour", "hour_part: BY end=hour", "hour_part: FINISH BY end=hour", cost=0.1)
@construction("hour_part: FINISH BEFORE end=hour", "hour_part: FINISH AT end=hour", cost=0.0)
def before_hour(end: float) -> TimePart:
    """Compose "by five"."""
    return TimePart(hour_before=end)


@construction("hour_part: BETWEEN begin=hour AND end=hour", "hour_part: FROM begin=hour TO end=hour", cost=0.0)
def between_bare_hours(begin: float, end: float) -> TimePart:
    """Compose "between two and four"."""
    return TimePart(hour_after=begin, hour_before=end)


@construction("part: day=part hours=hour_part", "part: day=part COMMA hours=hour_part", cost=0.1)
@construction("part: hours=hour_part day=part", "part: hours=hour_part COMMA day=part", cost=0.1)
def hour_of_day(day: TimePart, hours: TimePart) -> TimePart | None:
    """Compose "tomorrow, not before nine"."""
    says_day = day.day or day.weekdays or day.repeats or day.half
    return day & hours if says_day and not day.at else None


# --- days ---------------------------------------------------------------------------------------------------------


@construction("date: n=ORD OF month=MONTH", "date: n=ORD month=MONTH", "date: THE n=ORD OF month=MONTH", cost=0.0)
@construction("date: n=NUM month=MONTH", "date: month=MONTH n=NUM", "date: month=MONTH n=ORD", cost=0.0)
@construction("date: month=MONTH THE n=ORD", cost=0.0)
def day_of_year(n: Lex, month: Lex) -> str | None:
    """Compose "31 December" and "March the 3rd"."""
    try:
        found = date(2000, month.value, int(n.value))
    except ValueError:
        return None
    return f"--{found:%m-%d}" if n.value == int(n.value) else None


@construction("date: day=date year=YEAR", "date: day=date COMMA year=YEAR", cost=0.0)
def day_of_a_year(day: str, year: Lex) -> str | None:
    """Compose "31 December 2027"."""
    if not day.startswith("--"):
        return None
    try:
        return date_from_iso(f"{year.value}-{day[2:]}").isoformat()
    except ValueError:
        return None


@construction("date: day=ISODATE", cost=0.0)
def iso_date(day: Lex) -> str:
    """Compose "2027-03-01"."""
    return str(day.value)


@construction("day: said=DAYNAME", cost=0.0)
def named_day(said: Lex) -> str:
    """Compose "tomorrow"."""
    return str(said.value)


@construction("day: said=WEEKDAY", "day: NEXT said=WEEKDAY", "day: THE said=WEEKDAY", cost=0.0)
def next_weekday(said: Lex) -> str:
    """Compose "Friday" as a single day."""
    return str(said.value)


@construction("day: said=date", "day: THE said=date", cost=0.0)
def on_a_date(said: str) -> str:
    """Compose a date as a day."""
    return said


@construction("day: ENDOF month=MONTH", cost=0.0)
def end_of_a_month(month: Lex) -> str:
    """Compose "the end of June"; that of February is its 28th day."""
    return f"--{month.value:02d}-{monthrange(2001, month.value)[1]:02d}"


@construction("day: STARTOF month=MONTH", cost=0.0)
def start_of_a_month(month: Lex) -> str:
    """Compose "the beginning of June"."""
    return f"--{month.value:02d}-01"


@construction("day: IN n=NUM DAYS", "day: n=NUM DAYS FROMNOW", cost=0.0)
def days_from_now(n: Lex) -> str | None:
    """Compose "in 3 days"."""
    return f"+{int(n.value)}" if n.value == int(n.value) and 0 < n.value <= 366 else None


@construction("day: IN AN WEEKS", cost=0.0)
def week_from_now() -> str:
    """Compose "in a week"."""
    return "+7"


@construction("part: said=DAYNAME", "part: NEXT said=WEEKDAY", cost=0.1)
def some_day(said: Lex) -> TimePart:
    """Compose "tomorrow" and "next Friday"."""
    return TimePart(day=said.value)


@construction("part: ON on=date", "part: ON THE on=date", "part: IN n=NUM DAYS", "part: IN AN WEEKS", cost=0.1)
def on_a_day(on: str = "", n: Lex | None = None) -> TimePart | None:
    """Compose "on 31 December" and "in 3 days"."""
    day = on or (week_from_now() if n is None else days_from_now(n))
    return None if day is None else TimePart(day=day)


@construction("part: said=DAYNAME when=DAYPART", "part: ON said=WEEKDAY when=DAYPART", cost=0.1)
@construction("part: NEXT said=WEEKDAY when=DAYPART", cost=0.1)
def part_of_a_day(said: Lex, when: Lex) -> TimePart:
    """Compose "tomorrow morning"."""
    return replace(_within(when.value), day=said.value)


@construction("part: THISONE when=DAYPART", "part: TONIGHT", cost=0.1)
def part_of_today(when: Lex | None = None) -> TimePart:
    """Compose "this evening" and "tonight"."""
    return replace(_within("night" if when is None else when.value), day="today")


@construction("part: IN THE when=DAYPART", "part: AT when=DAYPART", "part: DURING THE when=DAYPART", cost=0.3)
def in_part_of_day(when: Lex) -> TimePart:
    """Compose "in the morning"."""
    return _within(when.value)


@construction("part: DAYLIGHT", cost=0.2)
def in_daylight() -> TimePart:
    """Compose "during the day"."""
    return TimePart(window=DAYLIGHT)


@construction("part: EARLY day=part", "part: EARLY IN THE when=DAYPART", "part: EARLY IN THE when=DAYPARTS", cost=0.1)
def early(day: TimePart | None = None, when: Lex | None = None) -> TimePart | None:
    """Compose "early tomorrow" and "early in the morning"."""
    return _part_of_a_window("early", day or _of(when))


@construction("part: LATE day=part", "part: LATE IN THE when=DAYPART", "part: LATE IN THE when=DAYPARTS", cost=0.1)
def late(day: TimePart | None = None, when: Lex | None = None) -> TimePart | None:
    """Compose "late in the afternoon" and "late tomorrow morning"."""
    return _part_of_a_window("late", day or _of(when))


def _of(when: Lex | None) -> TimePart:
    if when is None:
        return TimePart()
    return replace(_within(when.value), repeats=when.text.endswith("s"))


def _part_of_a_window(which: str, day: TimePart) -> TimePart | None:
    """Return a part of a day with the beginning or the end of the window that it names; "early" alone is a morning."""
    if day.takes is None:
        return None
    named = "morning" if day.takes == DAYLIGHT and which == "early" else day.takes.part
    found = WINDOWS.get(f"{which} {named}")
    return None if found is None else replace(day, window=found, half=found.half)


def _within(part: str) -> TimePart:
    """Return a part of the day."""
    window = WINDOWS[part]
    return TimePart(window=window, half=window.half)


# --- repetition ---------------------------------------------------------------------------------------------------


@construction("part: DAILY", cost=0.0)
def daily() -> TimePart:
    """Compose "every day"."""
    return TimePart(repeats=True, every_days=1)


@construction("part: EVERY when=DAYPART", "part: IN THE when=DAYPARTS", cost=0.0)
def every_part(when: Lex) -> TimePart:
    """Compose "every morning" and "in the mornings"."""
    return replace(_within(when.value), repeats=True)


@construction("part: TWICEDAILY", "part: n=NUM TIMESDAILY", cost=0.0)
def twice_daily(n: Lex | None = None) -> TimePart | None:
    """Compose "twice a day" and "three times a day", whose times are said beside it."""
    times = 2 if n is None else n.value
    return TimePart(repeats=True, times_a_day=int(times)) if times == int(times) and times > 1 else None


@construction("part: EVERY n=ORD when=DAYPART", "part: EVERY n=NUM when=DAYPARTS", cost=0.0)
def every_third_morning(n: Lex, when: Lex) -> TimePart | None:
    """Compose "every third morning"."""
    if n.value != int(n.value) or not 1 < n.value <= 366:
        return None
    return replace(_within(when.value), repeats=True, every_days=int(n.value))


@construction("part: FIRSTTHING", cost=0.1)
def first_thing() -> TimePart:
    """Compose "first thing" beside a day."""
    return replace(_within("morning"), needs_day=True)


@construction("part: HOURLY", cost=0.0)
def hourly() -> TimePart:
    """Compose "every hour"."""
    return TimePart(repeats=True, every_min=60)


@construction("part: WEEKLY", cost=0.0)
def weekly() -> TimePart:
    """Compose "every week"."""
    return TimePart(repeats=True, every_days=7)


@construction("part: EVERY OTHER DAY", cost=0.0)
def every_other_day() -> TimePart:
    """Compose "every other day"."""
    return TimePart(repeats=True, every_days=2)


@construction("part: EVERY OTHER WEEK", cost=0.0)
def every_other_week() -> TimePart:
    """Compose "every other week"."""
    return TimePart(repeats=True, every_days=14)


@construction("part: EVERY n=NUM DAYS", "part: EVERY n=ORD DAYS", cost=0.0)
def every_days(n: Lex) -> TimePart | None:
    """Compose "every 3 days" and "every third day"."""
    if n.value != int(n.value) or not 0 < n.value <= 366:
        return None
    return TimePart(repeats=True, every_days=int(n.value))


@construction("part: EVERY n=NUM WEEKS", cost=0.0)
def every_weeks(n: Lex) -> TimePart | None:
    """Compose "every 2 weeks"."""
    return TimePart(repeats=True, every_days=7 * int(n.value)) if n.value in range(1, 53) else None


@construction("part: EVERY by=minutes", cost=0.0)
def every_minutes(by: float) -> TimePart | None:
    """Compose "every two hours" and "every 30 minutes"."""
    return TimePart(repeats=True, every_min=int(by)) if by == int(by) and 0 < by < 24 * 60 else None


@construction("part: EVERY OTHER HOUR", cost=0.0)
def every_other_hour() -> TimePart:
    """Compose "every other hour"."""
    return TimePart(repeats=True, every_min=120)


@construction("dayset: day=WEEKDAY", "dayset: day=WEEKDAYS", cost=0.0)
def one_weekday(day: Lex) -> tuple[str, ...]:
    """Compose "Monday" in a list of days."""
    return (day.value,)


@construction("dayset: days=SEVERALDAYS", cost=0.0)
def several_weekdays(days: Lex) -> tuple[str, ...]:
    """Compose "weekdays"."""
    return tuple(days.value)


@construction("dayset: one=dayset AND other=dayset", "dayset: one=dayset COMMA other=dayset", cost=0.1)
@construction("dayset: one=dayset COMMA AND other=dayset", cost=0.1)
def days_and_days(one: tuple[str, ...], other: tuple[str, ...]) -> tuple[str, ...] | None:
    """Compose "Monday, Wednesday and Friday"."""
    both = {*one, *other}
    return tuple(day for day in WEEKDAYS if day in both) if len(both) == len(one) + len(other) else None


@construction("dayset: first=WEEKDAY TO last=WEEKDAY", "dayset: FROM first=WEEKDAY TO last=WEEKDAY", cost=0.1)
def days_to_day(first: Lex, last: Lex) -> tuple[str, ...] | None:
    """Compose "Monday to Friday"."""
    begin, end = WEEKDAYS.index(first.value), WEEKDAYS.index(last.value)
    return WEEKDAYS[begin : end + 1] if begin < end else None


@construction("part: first=WEEKDAY TO last=WEEKDAY", "part: FROM first=WEEKDAY TO last=WEEKDAY", cost=0.3)
def from_weekday_to_weekday(first: Lex, last: Lex) -> TimePart | None:
    """Compose "Monday to Friday" without a preposition."""
    days = days_to_day(first, last)
    return None if days is None else _repeated(days, None)


@construction("part: EVERY days=dayset", "part: EVERY days=dayset when=DAYPART", cost=0.0)
def every_weekday(days: tuple[str, ...], when: Lex | None = None) -> TimePart:
    """Compose "every Monday" and "every Monday morning"."""
    return _repeated(days, when)


@construction("part: ON days=dayset", "part: ON days=dayset when=DAYPART", "part: ONLY days=dayset", cost=0.2)
@construction("part: [ON] days=dayset when=DAYPARTS", cost=0.2)
def on_weekdays(days: tuple[str, ...], when: Lex | None = None) -> TimePart:
    """Compose "on weekdays", "on Mondays and Fridays" and, as a single day, "on Monday"."""
    part = _repeated(days, when)
    return part if len(days) > 1 else replace(part, repeats=False)


@construction("part: ON day=WEEKDAYS", "part: day=WEEKDAYS", "part: ON day=WEEKDAYS when=DAYPART", cost=0.1)
def on_mondays(day: Lex, when: Lex | None = None) -> TimePart:
    """Compose "on Mondays"."""
    return _repeated((day.value,), when)


@construction("part: day=WEEKDAYS AND days=dayset", "part: day=WEEKDAYS COMMA days=dayset", cost=0.2)
def mondays_and_more(day: Lex, days: tuple[str, ...]) -> TimePart:
    """Compose "Mondays and Thursdays" without a preposition."""
    return _repeated((day.value, *days), None)


@construction("part: days=SEVERALDAYS", cost=0.4)
def weekdays(days: Lex) -> TimePart:
    """Compose "weekdays" without a preposition."""
    return _repeated(tuple(days.value), None)


def _repeated(days: tuple[str, ...], when: Lex | None) -> TimePart:
    known = tuple(day for day in WEEKDAYS if day in days)
    return replace(TimePart() if when is None else _within(when.value), repeats=True, weekdays=known)


# --- bounds of the days -------------------------------------------------------------------------------------------


@construction("part: UNTIL end=day", "part: UNTIL THE end=date", cost=0.1)
def until_a_day(end: str) -> TimePart:
    """Compose "until 31 December"."""
    return TimePart(repeats=True, last_day=end)


@construction("part: FROM begin=day", "part: FROM begin=day ON", cost=0.2)
def from_a_day(begin: str) -> TimePart:
    """Compose "starting Monday"."""
    return TimePart(repeats=True, first_day=begin)


@construction("part: FROM begin=day TO end=day", "part: BETWEEN begin=day AND end=day", cost=0.0)
def from_day_to_day(begin: str, end: str) -> TimePart:
    """Compose "from 1 March to 31 May"."""
    return TimePart(repeats=True, first_day=begin, last_day=end)


@construction("months: IN first=MONTH", "months: DURING first=MONTH", "months: IN first=MONTH AND last=MONTH", cost=0.1)
@construction("months: IN first=MONTH COMMA MONTH AND last=MONTH", "months: FROM first=MONTH TO last=MONTH", cost=0.1)
@construction("months: BETWEEN first=MONTH AND last=MONTH", "months: FROM first=MONTH UNTIL last=MONTH", cost=0.1)
def in_months(first: Lex, last: Lex | None = None) -> TimePart | None:
    """Compose "in July" and "from May to September", which limit a mission that runs again and again."""
    end = first if last is None else last
    if last is not None and first.value == last.value:
        return None
    return TimePart(first_day=f"--{first.value:02d}-01", last_day=end_of_a_month(end))


@construction("part: months=months", cost=0.3)
def of_months(months: TimePart) -> TimePart:
    """Compose "in July", beside how often it runs."""
    return months


@construction("part: UNTIL when=DAYPART", "part: UNTIL THE when=DAYPART", cost=0.2)
def until_part_of_day(when: Lex) -> TimePart | None:
    """Compose "until evening", which is until it begins."""
    begin = WINDOWS[when.value].begin
    return None if begin.sun == "sunrise" else until_a_time(begin)


@construction("part: VAGUELY bounds=part", "part: bounds=part VAGUELY", cost=0.1)
@construction("part: VAGUELY bounds=hour_part", "part: bounds=hour_part VAGUELY", cost=0.1)
def every_so_often(bounds: TimePart) -> TimePart | None:
    """Compose "every so often until evening", of which it is asked how often."""
    until = bounds.done_by is not None or bounds.hour_before
    known = bounds.every_min or bounds.every_days or bounds.at or bounds.hour_at
    return replace(bounds, repeats=True, vague=True) if until and not known else None


@construction("part: FOR WEEKS", "part: FOR AN WEEKS", "part: FOR THE NEXT WEEK", cost=0.1)
def for_a_week() -> TimePart:
    """Compose "for a week"."""
    return TimePart(repeats=True, last_day="+6")


@construction("part: FOR AN FORTNIGHT", "part: FOR THE NEXT FORTNIGHT", "part: FOR FORTNIGHT", cost=0.0)
def for_a_fortnight() -> TimePart:
    """Compose "for a fortnight"."""
    return TimePart(repeats=True, last_day="+13")


@construction("part: FOR n=NUM unit=LONG", cost=0.0)
def for_some_weeks(n: Lex, unit: Lex) -> TimePart | None:
    """Compose "for 10 days" and "for the next two weeks", the first of which is the day of approval."""
    days = int(n.value * unit.value)
    return TimePart(repeats=True, last_day=f"+{days - 1}") if n.value == int(n.value) and 1 < days <= 366 else None


# --- several parts ------------------------------------------------------------------------------------------------


@construction("part: RUN [OVER] said=part", "part: RUN [OVER] COMMA said=part", cost=0.0)
def told_by_itself(said: TimePart) -> TimePart:
    """Compose "do this every morning" and "start at 6 am"."""
    return said


@construction("part: one=part other=part", "part: one=part COMMA other=part", "part: one=part AND other=part", cost=0.1)
@construction("part: one=part COLON other=part", cost=0.1)
def both(one: TimePart, other: TimePart) -> TimePart | None:
    """Compose "every day at 6 am until Friday"."""
    if one.at and other.at:
        return None
    return one & other or one.disputing(other)
