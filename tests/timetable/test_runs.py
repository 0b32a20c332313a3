"""Instants of the runs of missions: days, the sun, windows, and nights on which the clock is changed."""

from __future__ import annotations

import math
from dataclasses import replace
from datetime import date, datetime, timedelta
from itertools import islice, pairwise
from pathlib import Path
from zoneinfo import ZoneInfo

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.compatibility import UTC
from fieldhand.errors import TaskError
from fieldhand.task.timing import WEEKDAYS, DayTime, Schedule, StartTime
from fieldhand.timetable.day_times import Locality, instant, local_zone
from fieldhand.timetable.days import day_of
from fieldhand.timetable.runs import Calendar, DueRun

ROME = ZoneInfo("Europe/Rome")
ZONES = ("Europe/Rome", "America/Los_Angeles", "Australia/Lord_Howe", "UTC", "Asia/Kathmandu", "Africa/Cairo")


def calendar(approved: datetime, *, days: int = 30, zone: ZoneInfo = ROME, lasts_s: float = 0.0) -> Calendar:
    lat, lon = (43.7, 11.2) if zone == ROME else (37.3, -120.5)
    return Calendar(
        approved=approved, expires=approved + timedelta(days=days), zone=zone, lat=lat, lon=lon, lasts_s=lasts_s
    )


def local_runs(timing: StartTime | Schedule, when: Calendar, count: int, zone: ZoneInfo = ROME) -> list[str]:
    runs = islice(when.runs(timing, when.approved), count)
    return [run.due.astimezone(zone).strftime("%a %d %H:%M") for run in runs]


MONDAY = datetime(2027, 3, 1, 12, 0, tzinfo=ROME)


@pytest.mark.parametrize(
    ("schedule", "runs"),
    [
        (Schedule(at=(DayTime(clock="06:30"),)), ["Tue 02 06:30", "Wed 03 06:30", "Thu 04 06:30"]),
        (Schedule(at=(DayTime(clock="14:00"),)), ["Mon 01 14:00", "Tue 02 14:00"]),
        (Schedule(at=(DayTime(clock="06:30"),), weekdays=("sat", "mon")), ["Sat 06 06:30", "Mon 08 06:30"]),
        (Schedule(at=(DayTime(clock="06:30"),), every_days=2), ["Wed 03 06:30", "Fri 05 06:30"]),
        (Schedule(at=(DayTime(clock="06:30"),), first_day="thu"), ["Thu 04 06:30", "Fri 05 06:30"]),
        (Schedule(at=(DayTime(clock="06:30"),), last_day="wed"), ["Tue 02 06:30", "Wed 03 06:30"]),
        (
            Schedule(at=(DayTime(clock="18:00"), DayTime(clock="06:30"))),
            ["Mon 01 18:00", "Tue 02 06:30", "Tue 02 18:00"],
        ),
        (Schedule(every_min=600), ["Mon 01 20:00", "Tue 02 00:00", "Tue 02 10:00", "Tue 02 20:00"]),
        (
            Schedule(at=(DayTime(clock="08:00"),), every_min=240, until=DayTime(clock="16:00")),
            ["Mon 01 16:00", "Tue 02 08:00", "Tue 02 12:00", "Tue 02 16:00", "Wed 03 08:00"],
        ),
        (
            Schedule(at=(DayTime(clock="06:00"), DayTime(clock="12:00")), done_by=DayTime(sun="sunset")),
            ["Tue 02 06:00", "Tue 02 12:00", "Wed 03 06:00"],
        ),
    ],
)
def test_a_schedule_has_these_runs(schedule: Schedule, runs: list[str]) -> None:
    assert local_runs(schedule, calendar(MONDAY), len(runs)) == runs


def test_a_run_of_a_part_of_the_day_may_begin_as_long_as_it_is_done_by_its_end() -> None:
    morning = Schedule(at=(DayTime(sun="sunrise"),), late_min=24 * 60, done_by=DayTime(clock="12:00"))
    night = Schedule(at=(DayTime(clock="22:00"),), late_min=24 * 60, done_by=DayTime(clock="04:00"))
    soon = replace(night, late_min=30, done_by_min=60)
    found = []
    for schedule in (morning, night, soon):
        run = next(calendar(MONDAY, lasts_s=3600.0).runs(schedule, MONDAY))
        found.append((shown(run.due), shown(run.latest), shown(run.done_by)))
    assert found == [
        ("02 06:51", "02 11:00", "02 12:00"),
        ("01 22:00", "02 03:00", "02 04:00"),
        ("01 22:00", "01 22:30", "01 23:00"),
    ]
    # A run that takes longer than its part of the day has no time to begin late.
    (long,) = islice(calendar(MONDAY, lasts_s=7 * 3600.0).runs(morning, MONDAY), 1)
    assert long.latest == long.due


@pytest.mark.parametrize(
    ("first", "last", "day"),
    [("tomorrow", "today", 2), ("fri", "today", 5), ("+3", "today", 4), ("today", "today", 1), ("--03-09",) * 2 + (9,)],
)
def test_several_runs_of_one_day(first: str, last: str, day: int) -> None:
    at = (DayTime(clock="13:00"), DayTime(clock="18:00"))
    runs = local_runs(Schedule(at=at, first_day=first, last_day=last), calendar(MONDAY), 9)
    assert [run[4:] for run in runs] == [f"{day:02d} 13:00", f"{day:02d} 18:00"]


@pytest.mark.parametrize(
    ("first", "last", "runs"),
    [
        ("--02-01", "--03-03", ["Tue 02 06:00", "Wed 03 06:00"]),  # under way
        ("--03-04", "--03-05", ["Thu 04 06:00", "Fri 05 06:00"]),
        ("--11-01", "--03-02", ["Tue 02 06:00"]),  # over the end of the year
    ],
)
def test_runs_of_a_part_of_each_year_begin_at_once_within_it(first: str, last: str, runs: list[str]) -> None:
    schedule = Schedule(at=(DayTime(clock="06:00"),), first_day=first, last_day=last)
    assert local_runs(schedule, calendar(MONDAY), 9) == runs


def test_a_schedule_ends_with_its_last_day_or_the_approval() -> None:
    daily = Schedule(at=(DayTime(clock="06:00"),), last_day="wed")
    assert len(list(calendar(MONDAY).runs(daily, MONDAY))) == 2
    assert len(list(calendar(MONDAY, days=5).runs(Schedule(at=(DayTime(clock="06:00"),)), MONDAY))) == 5


@pytest.mark.parametrize(
    ("words", "day"),
    [
        ("today", date(2027, 3, 1)),
        ("tomorrow", date(2027, 3, 2)),
        ("mon", date(2027, 3, 8)),
        ("tue", date(2027, 3, 2)),
        ("sun", date(2027, 3, 7)),
        ("--03-01", date(2027, 3, 1)),
        ("--02-28", date(2028, 2, 28)),
        ("--02-29", date(2028, 2, 29)),
        ("2027-12-31", date(2027, 12, 31)),
        ("+10", date(2027, 3, 11)),
    ],
)
def test_words_name_a_day(words: str, day: date) -> None:
    assert day_of(words, date(2027, 3, 1)) == day


@pytest.mark.parametrize("words", ["someday", "+", "+99999999999", "2027-02-30", "--13-01", "--02-30", "7"])
def test_other_words_name_no_day(words: str) -> None:
    with pytest.raises(TaskError, match="is no day"):
        day_of(words, date(2027, 3, 1))


@pytest.mark.parametrize("clock", ["24:00", "6:00", "06:60", "", "noon"])
def test_other_words_are_no_time(clock: str) -> None:
    with pytest.raises(TaskError, match="no time of day"):
        instant(DayTime(clock=clock), date(2027, 3, 1), Locality(zone=ROME, lat=43.7, lon=11.2))


def test_an_unknown_time_zone_is_refused() -> None:
    with pytest.raises(TaskError, match="no time zone"):
        next(calendar(MONDAY).runs(Schedule(time_zone="Europe/Atlantis"), MONDAY))


# --- the sun ------------------------------------------------------------------------------------------------------


def solar_altitude(at: datetime, lat: float, lon: float) -> float:
    """Altitude of the sun in degrees, by the low-precision formulas of the Astronomical Almanac (0.01 degrees)."""
    n = (at - datetime(2000, 1, 1, 12, tzinfo=UTC)).total_seconds() / 86400.0
    anomaly = math.radians(357.528 + 0.9856003 * n)
    ecliptic = math.radians(280.460 + 0.9856474 * n + 1.915 * math.sin(anomaly) + 0.020 * math.sin(2 * anomaly))
    tilt = math.radians(23.439 - 0.0000004 * n)
    ascension = math.atan2(math.cos(tilt) * math.sin(ecliptic), math.cos(ecliptic))
    declination = math.asin(math.sin(tilt) * math.sin(ecliptic))
    sidereal = math.radians((280.46062 + 360.98564737 * n + lon) % 360.0)
    hour_angle = sidereal - ascension
    sine = math.sin(math.radians(lat)) * math.sin(declination)
    cosine = math.cos(math.radians(lat)) * math.cos(declination) * math.cos(hour_angle)
    return math.degrees(math.asin(sine + cosine))


@given(day=st.dates(date(2024, 1, 1), date(2030, 12, 31)), lat=st.floats(-55, 55), lon=st.floats(-180, 180))
def test_the_sun_stands_at_the_horizon(day: date, lat: float, lon: float) -> None:
    where = Locality(zone=UTC, lat=lat, lon=lon)
    for event, altitude in (("sunrise", -0.833), ("sunset", -0.833), ("dawn", -6.0), ("dusk", -6.0)):
        at = instant(DayTime(sun=event), day, where)  # type: ignore[arg-type]  # each is an event of the sun
        assert at is not None
        assert solar_altitude(at, lat, lon) == pytest.approx(altitude, abs=0.1)


@given(
    day=st.dates(date(2024, 1, 1), date(2030, 12, 31)),
    lat=st.floats(-60, 60),
    lon=st.floats(-180, 180),
    minutes=st.floats(-120, 120),
)
def test_the_events_of_the_sun_are_in_order(day: date, lat: float, lon: float, minutes: float) -> None:
    where = Locality(zone=UTC, lat=lat, lon=lon)
    times = [instant(DayTime(sun=event), day, where) for event in ("dawn", "sunrise", "sunset", "dusk")]
    known = [at for at in times if at is not None]
    assert known == sorted(known)
    rise, moved = times[1], instant(DayTime(sun="sunrise", offset_min=minutes), day, where)
    if rise is not None:
        assert moved == rise + timedelta(minutes=minutes)


def test_a_day_without_sunrise_has_no_run() -> None:
    polar = Calendar(
        approved=datetime(2027, 5, 10, tzinfo=UTC),
        expires=datetime(2027, 9, 1, tzinfo=UTC),
        zone=UTC,
        lat=69.6,
        lon=18.9,
    )
    runs = [run.due.date() for run in polar.runs(Schedule(at=(DayTime(sun="sunrise"),)), polar.approved)]
    gap = max(later - earlier for earlier, later in pairwise(runs))
    assert gap > timedelta(days=50)  # the midnight sun of Tromsø


# --- changes of the clock -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("night", "clock", "utc"),
    [
        (date(2027, 3, 28), "02:30", "01:30"),  # skipped: an hour after 01:30 it is 03:30, in summer time
        (date(2027, 10, 31), "02:30", "00:30"),  # twice: the first
        (date(2027, 10, 31), "03:30", "02:30"),
    ],
)
def test_a_time_in_a_night_of_change(night: date, clock: str, utc: str) -> None:
    found = instant(DayTime(clock=clock), night, Locality(zone=ROME, lat=43.7, lon=11.2))
    assert found is not None
    assert found.strftime("%H:%M") == utc


@given(
    zone=st.sampled_from(ZONES),
    start=st.datetimes(datetime(2024, 1, 1), datetime(2029, 1, 1)),
    every=st.sampled_from([0, 30, 60, 90, 120, 480]),
    hour=st.integers(0, 23),
    weekdays=st.sets(st.sampled_from(WEEKDAYS)),
)
def test_every_day_of_a_schedule_has_its_runs_once(
    zone: str, start: datetime, every: int, hour: int, weekdays: set[str]
) -> None:
    approved = start.replace(tzinfo=UTC)
    where = ZoneInfo(zone)
    chosen = tuple(day for day in WEEKDAYS if day in weekdays)
    schedule = Schedule(at=(DayTime(clock=f"{hour:02d}:00"),), every_min=every, weekdays=chosen, time_zone=zone)
    when = calendar(approved, days=9)
    runs = list(when.runs(schedule, approved))
    dues = [run.due for run in runs]
    assert dues == sorted(set(dues))
    assert all(approved < due <= when.expires for due in dues)
    # A day without a change of the clock has one run, or as many as fit until midnight.
    begin = approved.astimezone(where).date()
    for n in range(1, 8):
        day = begin + timedelta(days=n)
        offsets = {datetime(day.year, day.month, day.day, h, tzinfo=where).utcoffset() for h in (0, 12, 23)}
        if len(offsets) > 1:
            continue
        of_day = [due for due in dues if due.astimezone(where).date() == day]
        wanted = 1 if every == 0 else 1 + (24 * 60 - 1 - hour * 60) // every
        assert len(of_day) == (wanted if not chosen or WEEKDAYS[day.weekday()] in chosen else 0)


@given(start=st.datetimes(datetime(2024, 1, 1), datetime(2029, 1, 1)), split=st.integers(0, 20 * 24 * 60))
def test_runs_after_an_instant_are_the_rest(start: datetime, split: int) -> None:
    """No run is lost or repeated when the robot asks again at any time."""
    approved = start.replace(tzinfo=UTC)
    schedule = Schedule(at=(DayTime(clock="01:30"),), every_min=45, until=DayTime(clock="04:00"))
    when = calendar(approved, days=20)
    runs = list(when.runs(schedule, approved))
    at = approved + timedelta(minutes=split)
    assert [run for run in runs if run.due > at] == list(when.runs(schedule, at))


# --- a single start -----------------------------------------------------------------------------------------------


def once(start: StartTime, approved: datetime = MONDAY, lasts_s: float = 0.0) -> DueRun:
    (run,) = calendar(approved, lasts_s=lasts_s).runs(start, approved - timedelta(seconds=1))
    return run


def shown(at: datetime | None) -> str:
    return "" if at is None else at.astimezone(ROME).strftime("%d %H:%M")


@pytest.mark.parametrize(
    ("start", "window"),
    [
        (StartTime(not_before=DayTime(clock="06:00"), not_after=DayTime(clock="06:15")), ("02 06:00", "02 06:15", "")),
        (StartTime(not_before=DayTime(clock="11:00")), ("01 12:00", "02 00:00", "")),
        (StartTime(day="thu", not_before=DayTime(clock="07:00")), ("04 07:00", "05 00:00", "")),
        (StartTime(day="tomorrow"), ("02 00:00", "03 00:00", "")),
        (
            StartTime(not_before=DayTime(clock="06:00"), done_by=DayTime(clock="08:00")),
            ("02 06:00", "02 07:00", "02 08:00"),
        ),
        (StartTime(done_by=DayTime(clock="08:00")), ("02 06:45", "02 07:00", "02 08:00")),
        (
            StartTime(not_before=DayTime(clock="22:00"), done_by=DayTime(clock="02:00")),
            ("01 22:00", "02 01:00", "02 02:00"),
        ),
    ],
)
def test_a_single_mission_begins_in_its_window(start: StartTime, window: tuple[str, str, str]) -> None:
    run = once(start, lasts_s=3600.0)
    assert (shown(run.due), shown(run.latest), shown(run.done_by)) == window


def test_a_window_that_has_passed_has_no_run() -> None:
    past = StartTime(day="today", not_before=DayTime(clock="06:00"), not_after=DayTime(clock="06:15"))
    assert list(calendar(MONDAY).runs(past, MONDAY - timedelta(days=1))) == []


def test_the_zone_of_a_machine_has_its_rules(tmp_path: Path) -> None:
    summer, winter = datetime(2027, 7, 1, tzinfo=UTC), datetime(2027, 1, 1, tzinfo=UTC)
    for environ in ({"TZ": "Europe/Rome"}, {"TZ": ":Europe/Rome"}):
        zone = local_zone(environ)
        assert summer.astimezone(zone).utcoffset() != winter.astimezone(zone).utcoffset()
    assert local_zone({"TZ": "nowhere"}) is UTC
    assert local_zone({}, tmp_path / "missing") is UTC
    (tmp_path / "broken").write_bytes(b"no zone")
    assert local_zone({}, tmp_path / "broken") is UTC
