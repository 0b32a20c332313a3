"""Sections on what went otherwise than planned: work left out, faults and interruptions, and conditions tested."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fieldhand.clock import clock_time
from fieldhand.evaluation.report.log_facts import end_of, places_ahead
from fieldhand.evaluation.report.place_names import PlaceNames
from fieldhand.language.words import listed, say_action, say_count
from fieldhand.robot.model import RobotProfile
from fieldhand.task.frames import Task
from fieldhand.task.results import (
    Acted,
    Arrived,
    ClockSet,
    Continued,
    Decided,
    Event,
    EventBegan,
    EventEnded,
    Faulted,
    InDoubt,
    LimitCrossed,
    MissionStatus,
    Obstructed,
    Paused,
    Resumed,
    Shed,
    ShedCause,
    Strayed,
    Waited,
)
from fieldhand.wording.events import EventText

#: Decisions of the guard listed per section; the event log has all.
_MOST_DETAILS = 60
#: Above the first number lines are folded; above the second they are counted.
_FEW_LINES, _MOST_LINES = 12, 200


#: Causes of giving work up, in the order of the sections.
_CAUSES: tuple[ShedCause, ...] = ("budget", "event", "unreachable")


@dataclass(frozen=True, kw_only=True)
class LeftOut:
    """Places that were left out for one cause.

    Attributes:
        mandatory: True if the work had to be done.
        sentence: One sentence.
        details: Each decision of the guard as it was recorded.
    """

    mandatory: bool
    sentence: str
    details: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class FoldedLines:
    """Lines, and a sentence shown in their place if they are many."""

    summary: str
    lines: tuple[str, ...]


def left_out(task: Task, events: Sequence[Event], names: PlaceNames) -> tuple[LeftOut, ...]:
    """Return the work that was not done: places not reached before the end, then what was given up, by cause."""
    groups: dict[tuple[bool, int], list[Shed]] = {}
    for event in events:
        if isinstance(event, Shed):
            groups.setdefault((event.optional, _CAUSES.index(event.cause)), []).append(event)
    found = [
        _given_up(group, optional=optional, cause=_CAUSES[cause], names=names)
        for (optional, cause), group in sorted(groups.items())
    ]
    ahead = places_ahead(task, events)
    return (_not_reached(ahead, events, names), *found) if ahead else tuple(found)


def faults(robot: RobotProfile, events: Sequence[Event], names: PlaceNames) -> FoldedLines:
    """Return what went wrong, is in doubt or was interrupted, failed attempts at captures included."""
    lines, text = [], EventText(robot)
    for event in events:
        if isinstance(event, Acted) and event.status != "success":
            what = f"{say_action(event.action)} failed at {names.name(event.kind, event.place)}"
            lines.append(f"{clock_time(event.t)}: {what} (attempt {event.attempt}): {event.what}")
        elif isinstance(event, Faulted):
            worked = " (worked around)" if event.handled else ""
            lines.append(f"{clock_time(event.t)}: {event.what or event.fault}{worked}")
        elif isinstance(event, InDoubt):
            then = "it was taken again" if event.then == "repeat" else "it was not taken again"
            what = f"{say_action(event.action)} at {names.name(event.kind, event.place)} is in doubt; {then}"
            lines.append(f"{clock_time(event.t)}: {what}: {event.what}")
        elif isinstance(
            event,
            Obstructed
            | Strayed
            | Waited
            | EventBegan
            | EventEnded
            | LimitCrossed
            | ClockSet
            | Resumed
            | Paused
            | Continued,
        ):
            lines.append(f"{clock_time(event.t)}: {text.brief(event)}")
    return _folded(lines, f"{say_count(len(lines), 'line')}, including failed tries.")


def conditions(events: Sequence[Event], names: PlaceNames) -> FoldedLines:
    """Return the conditions that were tested, each with its result."""
    lines, held, at = [], 0, ""
    for event in events:
        if isinstance(event, Arrived):
            at = f" at {names.name(event.kind, event.place)}"
        elif isinstance(event, Decided):
            held += event.holds
            lines.append(f"{clock_time(event.t)}{at}: {event.why}")
    return _folded(lines, f"{say_count(len(lines), 'condition')} tested: {held} held, {len(lines) - held} did not.")


_ENDS: dict[MissionStatus, str] = {
    "completed": "was over",
    "returned": "turned home",
    "exceeded": "turned home",
    "faulted": "ended with a fault",
    "aborted": "was stopped",
}


def _not_reached(ahead: Sequence[str], events: Sequence[Event], names: PlaceNames) -> LeftOut:
    ended = end_of(events)
    how = "the log ends before the mission does" if ended is None else f"the mission {_ENDS[ended.status]} before"
    summary = f"{say_count(len(ahead), 'place')} not reached because {how}: {names.many(ahead)}."
    return LeftOut(mandatory=True, sentence=summary, details=())


def _given_up(group: Sequence[Shed], *, optional: bool, cause: ShedCause, names: PlaceNames) -> LeftOut:
    places = list(dict.fromkeys(place for event in group for place in event.places))
    what = say_count(len(places), "place") if places else say_count(len(group), "step")
    done = "left out" if optional else "given up, though to be done,"
    where = f": {names.many(places)}" if places else ""
    them = "it" if len(places) == 1 else "them"
    why = {
        "budget": f"the budget would probably not have been enough{_chances(group)}",
        "event": f"of what the mission watched: {listed(list(dict.fromkeys(event.reason for event in group)))}",
        "unreachable": f"no way led to {them}",
    }[cause]
    details = [f"{clock_time(event.t)}  {' '.join(event.reason.split())}" for event in group[:_MOST_DETAILS]]
    if len(group) > _MOST_DETAILS:
        details.append(f"and {len(group) - _MOST_DETAILS} more in the event log")
    return LeftOut(mandatory=not optional, sentence=f"{what} {done} because {why}{where}.", details=tuple(details))


def _chances(group: Sequence[Shed]) -> str:
    """Return " (84 to 93 % chance of running short)", or nothing where the log has no chance."""
    found = sorted(round(100 * event.chance_short) for event in group if event.chance_short > 0.0)
    if not found:
        return ""
    spread = f"{found[0]}" if found[0] == found[-1] else f"{found[0]} to {found[-1]}"
    return f" ({spread} % chance of running short)"


def _folded(lines: Sequence[str], summary: str) -> FoldedLines:
    """Return lines unfolded where they are few, and cut where they are too many."""
    more = len(lines) - _MOST_LINES
    kept = (*lines[:_MOST_LINES], f"and {more} more in the event log") if more > 0 else tuple(lines)
    return FoldedLines(summary=summary if len(lines) > _FEW_LINES else "", lines=kept)
