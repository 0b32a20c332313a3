"""Facts of an event log that several sections of the report need: its end, the use of resources, what was not done."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.forecast.estimate import BranchEstimate, Estimate
from fieldhand.task.frames import Task
from fieldhand.task.plan import walk
from fieldhand.task.results import (
    Acted,
    Arrived,
    Decided,
    Driving,
    Ended,
    Event,
    Exited,
    Faulted,
    Shed,
    Started,
    Visiting,
)


def captures(events: Sequence[Event]) -> list[Acted]:
    """Return the captures of a log, failed ones included."""
    return [e for e in events if isinstance(e, Acted)]


def start_of(events: Sequence[Event]) -> Started | None:
    """Return the event that begins the mission, or None if the log lacks it."""
    return next((e for e in events if isinstance(e, Started)), None)


def end_of(events: Sequence[Event]) -> Ended | None:
    """Return the event that ends the mission, or None if the log lacks it."""
    return next((e for e in reversed(events) if isinstance(e, Ended)), None)


def plan_done(events: Sequence[Event]) -> bool:
    """Return True if the plan was carried out to its end, and the nominal exit after it."""
    ended = end_of(events)
    if ended is None or ended.status != "exceeded":
        return ended is not None and ended.status == "completed"
    return any(isinstance(e, Exited) and e.exit == "nominal" for e in events)


def used(events: Sequence[Event]) -> tuple[float, float, float]:
    """Return the metres, seconds and percent of a full battery that the log shows as used."""
    metres = max((getattr(e, "travelled_m", 0.0) for e in events), default=0.0)
    seconds = max((e.t for e in events), default=0.0)
    started = start_of(events)
    charges = [e.charge_percent for e in events if hasattr(e, "charge_percent")]
    percent = started.charge_percent - charges[-1] if started and charges else 0.0
    return metres, seconds, max(0.0, percent)


def branch_taken(events: Sequence[Event], estimate: Estimate) -> BranchEstimate:
    """Return the estimate of the branch that was taken, or of the most demanding branch if it was not estimated."""
    answers = [(e.node, e.holds) for e in events if isinstance(e, Decided)]
    for branch in estimate.branches:
        if [(d.node, d.answer) for d in branch.decisions if d.kind == "holds"] == answers:
            return branch
    return estimate.worst


def cut_off_places(events: Sequence[Event]) -> tuple[str, ...]:
    """Return the places given up because no way led to them, without those captured later."""
    found: dict[str, None] = {}
    for event in events:
        if isinstance(event, Shed) and event.cause == "unreachable":
            found.update(dict.fromkeys(event.places))
        elif isinstance(event, Acted) and event.status == "success":
            found.pop(event.place, None)
    return tuple(found)


def places_ahead(task: Task, events: Sequence[Event]) -> tuple[str, ...]:
    """Return the places that the current for-each had still to visit when the mission ended before its plan did."""
    begun = max((k for k, e in enumerate(events) if isinstance(e, Visiting)), default=None)
    if begun is None or plan_done(events):
        return ()
    loop = events[begun]
    node = next((n for n in walk(task.composition.plan) if n.id == loop.node), None)
    if (
        not isinstance(loop, Visiting)
        or node is None
        or not node.visits_each
        or node.at_most is not None
        or node.tested
    ):
        return ()
    gone = {(e.place, e.side if loop.sides else "") for e in events[begun:] if isinstance(e, Arrived | Acted)}
    shed = {p for e in events[begun:] if isinstance(e, Shed) for p in e.places}
    each = zip(loop.places, loop.sides or [""] * len(loop.places), strict=False)
    return tuple(dict.fromkeys(p for p, side in each if (p, side) not in gone and p not in shed))


def failed_targets(events: Sequence[Event]) -> tuple[str, ...]:
    """Return the places to which drives failed, in the order of the drives."""
    target, found = "", []
    for event in events:
        if isinstance(event, Driving):
            target = event.place
        elif isinstance(event, Faulted) and event.fault == "drive_failed":
            found.append(target)
    return tuple(found)
