"""Instants of a time of day: of the clock in a time zone, or of the sun at a position."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import date, datetime, timedelta, timezone, tzinfo
from pathlib import Path
from zoneinfo import ZoneInfo

from fieldhand.compatibility import UTC
from fieldhand.errors import TaskError
from fieldhand.language import message
from fieldhand.task.timing import DayTime

_CLOCK = re.compile(r"([01]\d|2[0-3]):([0-5]\d)")


@dataclass(frozen=True, kw_only=True)
class Locality:
    """The time zone and the position that local times refer to.

    Attributes:
        zone: Time zone.
        lat, lon: Position in degrees, WGS 84.
    """

    zone: tzinfo
    lat: float
    lon: float


def zone_of(name: str, otherwise: tzinfo) -> tzinfo:
    """Return the time zone of a name of the IANA database.

    Args:
        name: The name; empty for ``otherwise``.
        otherwise: Time zone of the robot.

    Raises:
        TaskError: There is no such time zone.
    """
    if not name:
        return otherwise
    try:
        return ZoneInfo(name)
    except (KeyError, OSError, ValueError):  # unknown, unreadable, or no name at all
        raise TaskError(
            message("there is no time zone {name}", name=repr(name)),
            advice=message("use a name such as Europe/Rome or America/Los_Angeles"),
        ) from None


def local_zone(environ: Mapping[str, str], settings: Path = Path("/etc/localtime")) -> tzinfo:
    """Return the time zone of this machine with its rules for summer time: of ``TZ``, else of the system, else UTC.

    Args:
        environ: Environment variables.
        settings: The system's file of its time zone.
    """
    name = environ.get("TZ", "").removeprefix(":")
    try:
        if name:
            return ZoneInfo(name)
        with settings.open("rb") as file:
            return ZoneInfo.from_file(file)
    except (KeyError, OSError, ValueError):
        return UTC


def instant(at: DayTime, day: date, locality: Locality) -> datetime | None:
    """Return the instant of a time on a day, in UTC.

    A time of the clock that a day has twice is the first of the two; one that it skips is as long after the change as
    the clock would have shown.

    Args:
        at: Time of day.
        day: Day in the time zone of the locality.
        locality: Time zone and position.

    Returns:
        The instant; None on a day without that event of the sun (in polar regions).

    Raises:
        TaskError: The time of day is not one.
    """
    if at.sun is None:
        found = _CLOCK.fullmatch(at.clock)
        if found is None:
            raise TaskError(
                message("{time} is no time of day", time=repr(at.clock)), advice=message("write it as HH:MM")
            )
        hour, minute = (int(part) for part in found.groups())
        local = datetime(day.year, day.month, day.day, hour, minute, tzinfo=locality.zone)
        return local.astimezone(UTC)
    return _sun(at, day, locality)


def _sun(at: DayTime, day: date, locality: Locality) -> datetime | None:
    """Return the instant of an event of the sun.

    The event is searched for on the day of the local mean solar time, and dated by that: at the edges of a time zone
    the clock may show another day.
    """
    from astral import Observer, sun

    solar = timezone(timedelta(hours=round(locality.lon / 15.0)))
    observer = Observer(latitude=locality.lat, longitude=locality.lon)
    of_event: dict[str, Callable[..., datetime]] = {
        "dawn": sun.dawn,
        "sunrise": sun.sunrise,
        "sunset": sun.sunset,
        "dusk": sun.dusk,
    }
    try:
        found = of_event[at.sun or "sunrise"](observer, date=day, tzinfo=solar)
    except ValueError:
        return None
    return found.astimezone(UTC) + timedelta(minutes=at.offset_min)
