"""Watches: conditions that are checked throughout a mission or part of it, and the response to each.

A condition of an if is tested once, when its node is reached; a watch is checked whenever the robot is polled, while it
drives, works and waits. Its condition is an event of the robot's profile, such as rain, or a reading that any action of
the mission takes.
"""

from __future__ import annotations

import operator
from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import Literal, TypeAlias

from fieldhand.task.nodes.base import Span
from fieldhand.terms import Test

#: Response to a watch. ``wait``: stand still until it is over. ``skip``: leave out the current visit. ``skip_row``:
#: leave out the remaining visits of the current row. ``return_to_start``, ``return_to_end``: give up the rest and go
#: there. ``end``: end the mission where the robot is. ``slow``: drive no faster than a speed while it holds.
Response: TypeAlias = Literal["wait", "skip", "skip_row", "return_to_start", "return_to_end", "end", "slow"]

#: Response once a wait has lasted its maximum; ``go_on`` continues although the event still holds.
Fallback: TypeAlias = Literal["return_to_start", "return_to_end", "end", "skip", "go_on"]

#: Responses that interrupt the plan, in order of priority, the strongest first.
PRIORITY: tuple[Response, ...] = ("end", "return_to_start", "return_to_end", "wait", "skip_row", "skip")


@dataclass(frozen=True, kw_only=True)
class EventHolds:
    """An event of the robot's profile holds: someone is near, it rains."""

    event: str


@dataclass(frozen=True, kw_only=True)
class EventAbsent:
    """An event of the robot's profile does not hold: nobody supervises. A silent sensor counts as absence, too."""

    event: str


@dataclass(frozen=True, kw_only=True)
class EventBeyond:
    """A measured event of the profile, compared with a threshold: wind above 5 m/s."""

    event: str
    test: Test
    value: float
    unit: str


@dataclass(frozen=True, kw_only=True)
class ReadingBeyond:
    """The last reading of a quantity, whichever action takes it, compared with a threshold."""

    quantity: str
    test: Test
    value: float
    unit: str


WatchCondition = EventHolds | EventAbsent | EventBeyond | ReadingBeyond


@dataclass(frozen=True, kw_only=True, repr=False)
class Watch:
    """A condition that is checked throughout the mission, and the response to it.

    A wait ends once the condition has not held for the time that the profile sets (``clear_s``), and so does a lower
    speed. Without ``at_most_s`` a wait lasts at most as long as the profile's ``event_wait_s``.

    Attributes:
        condition: An event of the profile, or a reading.
        response: What the robot does when it begins to hold.
        at_most_s: Maximum duration of a wait in seconds; None for the profile's.
        fallback: What the robot does after the maximum.
        said: Character ranges of the request that state the watch.
        speed_m_s: Highest driving speed of the response ``slow``; None for the robot's slow speed.
        during: Action to whose steps the watch is limited: it is checked while one of them, or a loop around it, is
            under way; empty for the whole mission.
    """

    condition: WatchCondition
    response: Response
    at_most_s: float | None = None
    fallback: Fallback = "return_to_end"
    said: tuple[Span, ...] = ()
    speed_m_s: float | None = None
    during: str = ""

    def __repr__(self) -> str:
        """Return the fields as text. Those added later are left out at their default: ids of Tasks are hashes of it."""
        later = {"speed_m_s", "during"}
        said = (f for f in fields(self) if f.name not in later or getattr(self, f.name) != f.default)
        return f"Watch({', '.join(f'{f.name}={getattr(self, f.name)!r}' for f in said)})"


def exceeds(test: Test, value: float, threshold: float) -> bool:
    """Return True if a value passes a test against a threshold."""
    return bool(getattr(operator, test)(value, threshold))


def watched_events(watches: Iterable[Watch]) -> tuple[str, ...]:
    """Return the events of the profile that some watches name, each once."""
    conditions = (watch.condition for watch in watches)
    return tuple(dict.fromkeys(c.event for c in conditions if isinstance(c, EventHolds | EventAbsent | EventBeyond)))
