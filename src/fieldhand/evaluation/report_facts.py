"""What a report needs to know of a log before anything is said: its end, what was used, which branch was taken."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.forecast.estimate import BranchEstimate, Estimate
from fieldhand.task.results import Acted, Decided, Ended, Event, Started


def captures(events: Sequence[Event]) -> list[Acted]:
    """The captures of a log, those that failed included."""
    return [e for e in events if isinstance(e, Acted)]


def start_of(events: Sequence[Event]) -> Started | None:
    """The beginning of the mission, if the log has it."""
    return next((e for e in events if isinstance(e, Started)), None)


def end_of(events: Sequence[Event]) -> Ended | None:
    """The end of the mission, if the log has it."""
    return next((e for e in reversed(events) if isinstance(e, Ended)), None)


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


def clock_time(seconds: float) -> str:
    """Minutes and seconds since the mission began: "3:07"; from an hour on "1:03:07"."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"
