"""Mission incidents other than drives and captures: faults, uncertain captures, pauses, power cuts, with locations."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from fieldhand.task.results import (
    Arrived,
    ClockSet,
    Continued,
    Driving,
    Ended,
    Event,
    Faulted,
    InDoubt,
    LimitCrossed,
    Obstructed,
    Paused,
    Resumed,
    Started,
    Strayed,
    Waited,
    Worked,
)

LatLon = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class Incident:
    """An incident of a mission.

    Attributes:
        event: Name of the event in the event log.
        at: Position of the robot or of the uncertain capture; None if the log does not contain it.
        place: Destination or work place; empty if there is none.
        words: Description of the incident.
        blocked: All areas blocked from then on, as corners; None if they did not change.
        unreachable: Trees that can no longer be reached.
    """

    t: float
    event: str
    node: str
    at: LatLon | None
    place: str
    words: str
    blocked: tuple[tuple[LatLon, ...], ...] | None = None
    unreachable: tuple[str, ...] = ()


def incidents(events: Sequence[Event], tell: Callable[[Event], str | None]) -> tuple[Incident, ...]:
    """Return the incidents of a log, in order.

    Args:
        events: Event log.
        tell: Returns the description of an event, preceded by its time, or None.
    """
    found: list[Incident] = []
    here: LatLon | None = None
    for k, event in enumerate(events):
        here = position_of(event) or here
        match event:
            case Obstructed():
                found.append(_incident(event, here, tell, event.place, event.blocked, event.unreachable))
            case InDoubt():
                at = (event.lat, event.lon)
                found.append(_incident(event, at if known(at) else here, tell, event.place))
            case Strayed():
                found.append(_incident(event, here, tell, event.place))
            case Resumed() | Paused() | Continued() | Waited() | LimitCrossed() | ClockSet() | Faulted():
                stood = position_of(event) or _stood(events, k) or here
                found.append(_incident(event, stood, tell, ""))
            case _:
                pass
    return tuple(found)


def position_of(event: Event) -> LatLon | None:
    """Return the robot position recorded in an event."""
    if isinstance(event, Started | Arrived | Worked | Resumed | Obstructed | Strayed | LimitCrossed | Ended):
        return (event.lat, event.lon) if known((event.lat, event.lon)) else None
    return None


def known(at: Sequence[float]) -> bool:
    """Return True if the coordinates are a valid position on the earth."""
    return math.isfinite(at[0]) and math.isfinite(at[1]) and abs(at[0]) <= 90 and abs(at[1]) <= 180


def _incident(
    event: Event,
    at: LatLon | None,
    tell: Callable[[Event], str | None],
    place: str,
    blocked: tuple[tuple[LatLon, ...], ...] | None = None,
    unreachable: tuple[str, ...] = (),
) -> Incident:
    words = " ".join((tell(event) or "").split()[1:]) or event.event
    return Incident(
        t=event.t, event=event.event, node=event.node, at=at, place=place, words=words, blocked=blocked,
        unreachable=unreachable,
    )  # fmt: skip


def _stood(events: Sequence[Event], k: int) -> LatLon | None:
    """Return the robot position for an event without one: where the interrupted drive is resumed."""
    driving = next((isinstance(e, Driving) for e in reversed(events[:k]) if isinstance(e, Driving | Arrived)), False)
    if not driving:
        return None
    for event in events[k + 1 :]:
        if isinstance(event, Driving):
            return event.path[0] if event.path and known(event.path[0]) else None
        if isinstance(event, Arrived):
            return None
        at = position_of(event)
        if at is not None:
            return at
    return None
