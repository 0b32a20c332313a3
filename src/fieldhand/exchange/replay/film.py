"""What is seen of a mission over time: where the robot is, what it captured, its charge, and what it said."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import InputError
from fieldhand.exchange.broken_off import driven_part
from fieldhand.site.model import Site
from fieldhand.task.results import Acted, Arrived, Driving, Ended, Event, Started

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Capture:
    """One capture: when and where (metres), and its readings with their units."""

    t: float
    x: float
    y: float
    place: str
    action: str
    good: bool
    readings: Mapping[str, float] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Film:
    """A mission over time. Seconds count from its beginning; metres are the site's.

    Attributes:
        track: Corners of the way with their times: columns t, x, y, times never falling.
        charge: Columns t and percent of a full battery.
        lines: What happened, in words, with its time.
        quantities: What was read, the most often read first.
    """

    title: str
    seconds: float
    track: Floats
    charge: Floats
    captures: tuple[Capture, ...]
    lines: tuple[tuple[float, str], ...]
    quantities: tuple[str, ...]

    def at(self, t: float) -> tuple[float, float]:
        """Where the robot is, in metres."""
        return (float(np.interp(t, self.track[:, 0], self.track[:, 1])), self._second(t))

    def until(self, t: float) -> Floats:
        """The way driven by then, shape (n, 2), its last point where the robot is."""
        passed = self.track[self.track[:, 0] <= t, 1:]
        return np.vstack([passed, self.at(t)])

    def charge_at(self, t: float) -> float:
        """Percent of a full battery."""
        return float(np.interp(t, self.charge[:, 0], self.charge[:, 1]))

    def _second(self, t: float) -> float:
        return float(np.interp(t, self.track[:, 0], self.track[:, 2]))


def film_of(events: Sequence[Event], site: Site, *, tell: Callable[[Event], str | None] = lambda _: None) -> Film:
    """The film of an event log on its site.

    Args:
        events: The log; one that was cut off is shown as far as it goes.
        site: Where it happened.
        tell: Says an event in words, or None where it is not worth a line.

    Raises:
        InputError: The log does not say where the robot was.
    """
    track, charge = _Track(), []
    captures: list[Capture] = []
    lines: list[tuple[float, str]] = []
    drive: Driving | None = None
    for event in events:
        if not math.isfinite(event.t):
            continue
        words = tell(event)
        if words is not None:
            lines.append((event.t, " ".join(words.split())))
        match event:
            case Driving():
                if drive is not None and event.path and track.corners:
                    track.drive(drive, event.t, site, ended_at=event.path[0])
                drive = event
            case Started() | Arrived() | Ended() if _known(event.lat, event.lon):
                if drive is not None:
                    ended_at = None if isinstance(event, Arrived) else (event.lat, event.lon)
                    track.drive(drive, event.t, site, ended_at=ended_at)
                track.add(event.t, site.projection.metres(event.lat, event.lon))
                drive = None
            case Acted() if _known(event.lat, event.lon):
                captures.append(_capture(event, site))
        if isinstance(event, Started | Arrived | Acted | Ended) and math.isfinite(event.charge_percent):
            charge.append((event.t, event.charge_percent))
    if not track.corners:
        what = "the log does not say where the robot was"
        raise InputError(what, advice="give a log that fieldhand run --events or --mcap wrote")
    count = Counter(q for c in captures if c.good for q in c.readings)
    found = np.array(track.corners, dtype=np.float64)
    far = float(np.abs(found[:, 1:]).max())
    if far > 100_000:
        raise InputError("the mission was on another site than this one", advice="give the site that it was driven on")
    return Film(
        title=_title(events),
        seconds=max(float(found[-1, 0]), max((c.t for c in captures), default=0.0), 1.0),
        track=found,
        charge=np.array(charge or [(0.0, 100.0)], dtype=np.float64),
        captures=tuple(captures),
        lines=tuple(lines),
        quantities=tuple(q for q, _ in count.most_common()),
    )


class _Track:
    """Corners with their times, which never fall: a clock that was set back stands still."""

    def __init__(self) -> None:
        self.corners: list[tuple[float, float, float]] = []

    def add(self, t: float, xy: Floats) -> None:
        for x, y in xy:
            latest = self.corners[-1][0] if self.corners else t
            self.corners.append((max(t, latest), float(x), float(y)))

    def drive(self, drive: Driving, until: float, site: Site, *, ended_at: tuple[float, float] | None) -> None:
        """A drive that went evenly along its way, to its end or to where it was broken off."""
        degrees = np.asarray(drive.path, dtype=np.float64).reshape(-1, 2)
        if len(degrees) < 2 or not np.isfinite(degrees).all():
            return
        if ended_at is not None:
            if not _known(*ended_at):
                return
            degrees = np.asarray(driven_part(drive.path, ended_at), dtype=np.float64)
        xy = site.projection.metres(degrees[:, 0], degrees[:, 1])
        lengths = np.hypot(*np.diff(xy, axis=0).T)
        parts = np.concatenate([[0.0], np.cumsum(lengths)]) / max(float(lengths.sum()), 1e-9)
        for part, point in zip(parts, xy, strict=True):
            self.add(drive.t + float(part) * (until - drive.t), point.reshape(1, 2))


def _capture(event: Acted, site: Site) -> Capture:
    x, y = site.projection.metres(event.lat, event.lon)[0]
    good = event.status == "success"
    readings = {q: v for q, v in event.readings.items() if good and math.isfinite(v)}
    return Capture(
        t=event.t, x=float(x), y=float(y), place=event.place, action=event.action, good=good,
        readings=readings, units=event.units,
    )  # fmt: skip


def _title(events: Sequence[Event]) -> str:
    started = next((e for e in events if isinstance(e, Started)), None)
    ended = next((e for e in reversed(events) if isinstance(e, Ended)), None)
    who = f"{started.robot} on {started.site}" if started is not None else "Mission"
    return f"{who}: {ended.status if ended is not None else 'cut off'}"


def _known(lat: float, lon: float) -> bool:
    return math.isfinite(lat) and math.isfinite(lon) and abs(lat) <= 90 and abs(lon) <= 180
