"""What the report tells line by line, folded where it is much: faults and interruptions, conditions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fieldhand.clock import clock_time
from fieldhand.evaluation.report_places import PlaceNames
from fieldhand.evaluation.telling import Teller
from fieldhand.robot.model import RobotProfile
from fieldhand.task.results import (
    Acted,
    Arrived,
    ClockSet,
    Continued,
    Decided,
    Event,
    Faulted,
    InDoubt,
    LimitCrossed,
    Obstructed,
    Paused,
    Resumed,
    Waited,
)
from fieldhand.task.words import say_action, say_count

#: More lines than the few are folded; more than the most are counted, not told.
_FEW_LINES, _MOST_LINES = 12, 200


@dataclass(frozen=True, kw_only=True)
class Folded:
    """Lines, and where they are many a sentence that stands for them."""

    said: str
    lines: tuple[str, ...]


def faults(robot: RobotProfile, events: Sequence[Event], names: PlaceNames) -> Folded:
    """What went wrong, is in doubt or was interrupted, captures that had to be tried again included."""
    lines, told = [], Teller(robot)
    for event in events:
        if isinstance(event, Acted) and event.status != "success":
            what = f"{say_action(event.action)} failed at {names.name(event.kind, event.place)}"
            lines.append(f"{clock_time(event.t)}: {what} (attempt {event.attempt}): {event.what}")
        elif isinstance(event, Faulted):
            worked = " (worked around)" if event.handled else ""
            lines.append(f"{clock_time(event.t)}: {event.what or event.fault}{worked}")
        elif isinstance(event, InDoubt):
            then = "it was made again" if event.then == "repeat" else "it was not made again"
            what = f"{say_action(event.action)} at {names.name(event.kind, event.place)} is in doubt; {then}"
            lines.append(f"{clock_time(event.t)}: {what}: {event.what}")
        elif isinstance(event, Obstructed | Waited | LimitCrossed | ClockSet | Resumed | Paused | Continued):
            lines.append(f"{clock_time(event.t)}: {told.in_short(event)}")
    return _folded(lines, f"{say_count(len(lines), 'line')}, failed tries included.")


def conditions(events: Sequence[Event], names: PlaceNames) -> Folded:
    """The conditions that were tested, and what they came to."""
    lines, held, at = [], 0, ""
    for event in events:
        if isinstance(event, Arrived):
            at = f" at {names.name(event.kind, event.place)}"
        elif isinstance(event, Decided):
            held += event.holds
            lines.append(f"{clock_time(event.t)}{at}: {event.why}")
    return _folded(lines, f"{say_count(len(lines), 'condition')} tested: {held} held, {len(lines) - held} did not.")


def _folded(lines: Sequence[str], said: str) -> Folded:
    """Lines as they are where they are few."""
    more = len(lines) - _MOST_LINES
    kept = (*lines[:_MOST_LINES], f"and {more} more in the event log") if more > 0 else tuple(lines)
    return Folded(said=said if len(lines) > _FEW_LINES else "", lines=kept)
