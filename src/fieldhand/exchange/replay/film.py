"""State of a mission over time for a replay: robot position, captures, charge, and log lines."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import InputError
from fieldhand.exchange.broken_off import driven_part
from fieldhand.exchange.incidents import LatLon, incidents, known, position_of
from fieldhand.site.model import Site
from fieldhand.task.exceeded import say_status
from fieldhand.task.results import (
    Acted,
    Arrived,
    Driving,
    Ended,
    Event,
    InDoubt,
    Paused,
    Resumed,
    Started,
    Worked,
    Working,
)

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class ReplayCapture:
    """A capture: time, position in metres, and readings with their units."""

    t: float
    x: float
    y: float
    place: str
    action: str
    good: bool
    readings: Mapping[str, float] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Sign:
    """An incident: time, position in metres, and description.

    Attributes:
        mark: Character for the kind of incident, from :data:`SIGNS`.
        blocked: Areas blocked from then on, as corners; None if they did not change.
        beside: Number of other signs already drawn at this position.
    """

    t: float
    x: float
    y: float
    mark: str
    words: str
    beside: int = 0
    blocked: tuple[Floats, ...] | None = None


#: Distance in metres below which signs are drawn side by side.
_TOGETHER_M = 1.5
#: Sign and legend of each event. The end of a pause appears only among the lines.
SIGNS = {
    "obstacle": ("!", "way blocked"),
    "strayed": ("L", "left the way"),
    "in_doubt": ("?", "capture in doubt"),
    "wait": ("W", "waited"),
    "fault": ("F", "fault"),
    "paused": ("P", "paused"),
    "resumed": ("R", "went on after a power cut"),
    "clock": ("C", "clock set"),
}


@dataclass(frozen=True, kw_only=True)
class Film:
    """A mission over time, in seconds from its start and in the metres of the site.

    Attributes:
        track: Corners of the route with their times: columns t, x, y, with non-decreasing t.
        charge: Columns t and percent of a full battery.
        lines: Descriptions of events, with their times.
        quantities: Measured quantities, the most frequent first.
        signs: Faults, uncertain captures, pauses and power cuts.
    """

    title: str
    seconds: float
    track: Floats
    charge: Floats
    captures: tuple[ReplayCapture, ...]
    lines: tuple[tuple[float, str], ...]
    quantities: tuple[str, ...]
    signs: tuple[Sign, ...] = ()

    def blocked_at(self, t: float) -> tuple[Floats, ...]:
        """Return the areas blocked at a time."""
        return next((s.blocked for s in reversed(self.signs) if s.t <= t and s.blocked is not None), ())

    def at(self, t: float) -> tuple[float, float]:
        """Return the robot position at a time, in metres."""
        return (float(np.interp(t, self.track[:, 0], self.track[:, 1])), self._second(t))

    def until(self, t: float) -> Floats:
        """Return the route driven up to a time, shape (n, 2), ending at the robot position."""
        passed = self.track[self.track[:, 0] <= t, 1:]
        return np.vstack([passed, self.at(t)])

    def charge_at(self, t: float) -> float:
        """Return the charge at a time, in percent of a full battery."""
        return float(np.interp(t, self.charge[:, 0], self.charge[:, 1]))

    def _second(self, t: float) -> float:
        return float(np.interp(t, self.track[:, 0], self.track[:, 2]))


def film_of(events: Sequence[Event], site: Site, *, tell: Callable[[Event], str | None] = lambda _: None) -> Film:
    """Return the replay of an event log on its site.

    Args:
        events: Event log; a truncated one is shown as far as it goes.
        site: Site of the mission.
        tell: Returns the description of an event, or None if it needs no line.

    Raises:
        InputError: The log contains no robot position.
    """
    track, charge = _Track(site), []
    captures: list[ReplayCapture] = []
    lines: list[tuple[float, str]] = []
    for event in events:
        if not math.isfinite(event.t):
            continue
        words = tell(event)
        if words is not None:
            lines.append((event.t, " ".join(words.split())))
        match event:
            case Driving() | Working():
                track.begin(event)
            case Paused():
                track.stop(event.t)
            case Acted() if known((event.lat, event.lon)):
                captures.append(_capture(event, site))
            case _:
                at = position_of(event)
                if at is not None:
                    track.come(event.t, at, whole=_is_whole(event))
        if isinstance(event, Started | Arrived | Acted | Worked | InDoubt | Resumed | Ended) and math.isfinite(
            event.charge_percent
        ):
            charge.append((event.t, event.charge_percent))
    if not track.corners:
        what = "the log does not record where the robot was"
        raise InputError(what, advice="give a log that fieldhand run --events or --mcap wrote")
    count = Counter(q for c in captures if c.good for q in c.readings)
    found = np.array(track.corners, dtype=np.float64)
    far = float(np.abs(found[:, 1:]).max())
    if far > 100_000:
        raise InputError("the mission took place on another site", advice="give the site of the mission")
    return Film(
        signs=_signs(events, site, tell, found),
        title=_title(events),
        seconds=max(float(found[-1, 0]), max((c.t for c in captures), default=0.0), 1.0),
        track=found,
        charge=np.array(charge or [(0.0, 100.0)], dtype=np.float64),
        captures=tuple(captures),
        lines=tuple(lines),
        quantities=tuple(q for q, _ in count.most_common()),
    )


def _is_whole(event: Event) -> bool:
    """Return True if a drive ended at its destination."""
    return isinstance(event, Arrived) or (isinstance(event, Worked) and event.status == "success")


class _Track:
    """Corners with non-decreasing times; a clock that was set back is held."""

    def __init__(self, site: Site) -> None:
        self.corners: list[tuple[float, float, float]] = []
        self._site = site
        self._drive: Driving | Working | None = None
        self._until = math.inf

    def begin(self, drive: Driving | Working) -> None:
        """Start a drive; an earlier drive that did not arrive ends at its start."""
        if len(drive.path) < 2 or not all(map(known, drive.path)):
            self._drive = None
            return
        if self._drive is not None and self.corners:
            self.come(min(self._until, drive.t), drive.path[0])
        self._drive, self._until = drive, math.inf

    def stop(self, t: float) -> None:
        """Record the time at which the robot stops on the current drive."""
        self._until = min(self._until, t)

    def come(self, t: float, at: LatLon, *, whole: bool = False) -> None:
        """Record the robot position, which ends the current drive; ``whole`` adds its complete path."""
        drive, self._drive = self._drive, None
        if drive is not None:
            path = drive.path if whole else driven_part(drive.path, at)
            self._along(np.asarray(path, dtype=np.float64), drive.t, min(t, self._until))
        self.add(t, self._site.projection.metres(*at))

    def add(self, t: float, xy: Floats) -> None:
        for x, y in xy:
            latest = self.corners[-1][0] if self.corners else t
            self.corners.append((max(t, latest), float(x), float(y)))

    def _along(self, degrees: Floats, since: float, until: float) -> None:
        """Append the corners of a drive at constant speed."""
        xy = self._site.projection.metres(degrees[:, 0], degrees[:, 1])
        lengths = np.hypot(*np.diff(xy, axis=0).T)
        parts = np.concatenate([[0.0], np.cumsum(lengths)]) / max(float(lengths.sum()), 1e-9)
        for part, point in zip(parts, xy, strict=True):
            self.add(since + float(part) * (until - since), point.reshape(1, 2))


def _signs(events: Sequence[Event], site: Site, tell: Callable[[Event], str | None], track: Floats) -> tuple[Sign, ...]:
    found: list[Sign] = []
    for one in incidents([e for e in events if math.isfinite(e.t)], tell):
        if one.event not in SIGNS:
            continue
        at = [float(np.interp(one.t, track[:, 0], track[:, k])) for k in (1, 2)]
        # An uncertain capture is shown at its place, every other incident at the robot position.
        if one.event == "in_doubt" and one.at is not None:
            at = site.projection.metres(*one.at)[0].tolist()
        blocked = None if one.blocked is None else tuple(_ring(area, site) for area in one.blocked if len(area) > 2)
        mark = SIGNS[one.event][0]
        there = {s.mark for s in found if math.dist((s.x, s.y), at) < _TOGETHER_M} - {mark}
        found.append(Sign(t=one.t, x=at[0], y=at[1], mark=mark, words=one.words, blocked=blocked, beside=len(there)))
    return tuple(found)


def _ring(area: Sequence[LatLon], site: Site) -> Floats:
    degrees = np.array([corner for corner in area if known(corner)], dtype=np.float64).reshape(-1, 2)
    return site.projection.metres(degrees[:, 0], degrees[:, 1])


def _capture(event: Acted, site: Site) -> ReplayCapture:
    x, y = site.projection.metres(event.lat, event.lon)[0]
    good = event.status == "success"
    readings = {q: v for q, v in event.readings.items() if good and math.isfinite(v)}
    return ReplayCapture(
        t=event.t, x=float(x), y=float(y), place=event.place, action=event.action, good=good,
        readings=readings, units=event.units,
    )  # fmt: skip


def _title(events: Sequence[Event]) -> str:
    started = next((e for e in events if isinstance(e, Started)), None)
    ended = next((e for e in reversed(events) if isinstance(e, Ended)), None)
    who = f"{started.robot} on {started.site}" if started is not None else "Mission"
    return f"{who}: {say_status(ended.status) if ended is not None else 'cut off'}"
