"""What a report needs to know of a log before anything is said: its end, what was used, which branch was taken."""

from __future__ import annotations

import math
from collections.abc import Sequence

from fieldhand.errors import InputError
from fieldhand.forecast.estimate import BranchEstimate, Estimate
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task
from fieldhand.task.results import Acted, Decided, Ended, Event, Exited, Shed, Started

#: What of an event must be a number for anything to be said of it. Positions may be unknown.
_FIGURES = ("t", "leg_m", "travelled_m", "charge_percent")


def captures(events: Sequence[Event]) -> list[Acted]:
    """The captures of a log, those that failed included."""
    return [e for e in events if isinstance(e, Acted)]


def start_of(events: Sequence[Event]) -> Started | None:
    """The beginning of the mission, if the log has it."""
    return next((e for e in events if isinstance(e, Started)), None)


def end_of(events: Sequence[Event]) -> Ended | None:
    """The end of the mission, if the log has it."""
    return next((e for e in reversed(events) if isinstance(e, Ended)), None)


def plan_done(events: Sequence[Event]) -> bool:
    """Return True if the plan was carried out to its end, and the exit for that was taken to the end."""
    ended = end_of(events)
    if ended is None or ended.status != "exceeded":
        return ended is not None and ended.status == "completed"
    return any(isinstance(e, Exited) and e.exit == "nominal" for e in events)


def out_of_reach(event: Shed) -> bool:
    """Whether work was given up because no way led to it, and not for the budget's sake."""
    # The guard gives what cannot be driven to no chance but certainty.
    return event.cause == "unreachable" or (event.chance_short >= 1.0 and "no way" in event.reason)


def branch_taken(events: Sequence[Event], estimate: Estimate) -> BranchEstimate:
    """The estimate of the branch that was taken; where it was not looked at, that of the most demanding one."""
    answers = [(e.node, e.holds) for e in events if isinstance(e, Decided)]
    for branch in estimate.branches:
        if [(d.node, d.answer) for d in branch.decisions if d.kind == "holds"] == answers:
            return branch
    return estimate.worst


def used(events: Sequence[Event]) -> tuple[float, float, float]:
    """Metres, seconds and percent of a full battery that the log shows as used."""
    metres = max((getattr(e, "travelled_m", 0.0) for e in events), default=0.0)
    seconds = max((e.t for e in events), default=0.0)
    started = start_of(events)
    charges = [e.charge_percent for e in events if hasattr(e, "charge_percent")]
    percent = started.charge_percent - charges[-1] if started and charges else 0.0
    return metres, seconds, max(0.0, percent)


def require_fitting(events: Sequence[Event], task: Task, site: Site, robot: RobotProfile, *, where: str) -> None:
    """See whether a log can be reported as one of this Task, on this site, by this robot.

    Raises:
        InputError: It has no beginning, is of another, or its figures are no numbers; says which.
    """
    started = start_of(events)
    if started is None:
        raise InputError(
            "has no line that says of which mission it is",
            where=where,
            advice="give the whole log, from its first line",
        )
    for what, wanted, found in (
        ("Task", task.id, started.task),
        ("robot", robot.name, started.robot),
        ("site", site.name, started.site),
    ):
        if wanted != found:
            raise InputError(
                f"is of the {what} {found!r}, not {wanted!r}",
                where=where,
                advice=f"give the {what} that it was made with",
            )
    for number, event in enumerate(events, start=1):
        for name in _FIGURES:
            value = getattr(event, name, 0.0)
            if not math.isfinite(value) or abs(value) > 1e12:
                raise InputError(
                    f"{name} of event {number} ({event.event}) is {value}, which no mission has",
                    where=where,
                    advice="was the log edited?",
                )
