"""Event logs with a mistake planted in them, as a wrong plan or a wrong robot would have left them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any

Event = dict[str, Any]

#: Degrees of latitude of about 40 m.
FAR_DEG = 3.6e-4


def tampered(lines: Sequence[str], elsewhere: tuple[float, float]) -> Iterator[tuple[str, list[str]]]:
    """Each mistake that this log can have, by name, with the log that has it.

    Args:
        lines: Of a log.
        elsewhere: Latitude and longitude of another tree.
    """
    events = [json.loads(line) for line in lines]
    acts = [k for k, event in enumerate(events) if event["event"] == "action" and event["status"] == "success"]
    lat, lon = elsewhere
    there = {"lat": lat, "lon": lon}
    end = {"event": "mission"}
    yield "the log is cut off", _lines([e for e in events if e["event"] != "mission"])
    yield "the mission was aborted", _lines(_changed(events, end, status="aborted"))
    yield "it ended elsewhere", _lines(_changed(events, end, lat=events[-1]["lat"] + FAR_DEG))
    yield "it drove ten times as far", _lines([_farther(e) for e in events])
    if not acts:
        return
    first, last = acts[0], acts[-1]
    yield "the first capture is missing", _lines([e for k, e in enumerate(events) if k != first])
    yield "the last capture is missing", _lines([e for k, e in enumerate(events) if k != last])
    yield "the last capture failed", _lines(_replaced(events, last, status="failed"))
    yield "a capture more", _lines([*events[:last], events[last], *events[last:]])
    yield "a capture more elsewhere", _lines([*events[: last + 1], events[last] | there, *events[last + 1 :]])
    yield "the first capture at another tree", _lines(_replaced(events, first, **there))
    yield "the last capture at another tree", _lines(_replaced(events, last, **there))
    yield "another action", _lines(_replaced(events, first, action="sweep_the_floor"))
    yield "beyond every tree", _lines(_replaced(events, last, lat=events[last]["lat"] + 10 * FAR_DEG))
    if len(acts) > 1:
        swapped = list(events)
        swapped[first], swapped[last] = events[last], events[first]
        yield "first and last swapped", _lines(swapped)


def _lines(events: Sequence[Event]) -> list[str]:
    return [json.dumps(event) for event in events]


def _replaced(events: Sequence[Event], number: int, **changes: Any) -> list[Event]:
    return [event | changes if k == number else event for k, event in enumerate(events)]


def _changed(events: Sequence[Event], which: Event, **changes: Any) -> list[Event]:
    return [event | changes if which.items() <= event.items() else event for event in events]


def _farther(event: Event) -> Event:
    return event | {"travelled_m": 10 * event["travelled_m"]} if "travelled_m" in event else event
