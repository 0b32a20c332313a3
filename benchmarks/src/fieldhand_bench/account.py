"""The result of comparing a plan with an event log: work done, work undone, optional visits."""

from __future__ import annotations

from dataclasses import dataclass, field

from fieldhand.task.results import Event


@dataclass(frozen=True, kw_only=True)
class Undone:
    """Mandatory work that is missing from the log; without places if only the robot could have resolved them."""

    node: str
    places: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Made:
    """A completed optional visit; ``run`` numbers the executions of optional loops, so that repeated ones differ."""

    node: str
    run: int
    place: str


@dataclass(kw_only=True)
class Account:
    """The work of a plan as found in an event log.

    Attributes:
        done: Number of mandatory pieces of work that were done; a piece is an action with its captures or a drive.
        undone: Mandatory pieces of work that were not done.
        made: Completed optional visits.
        left_out: Number of optional visits that were given up.
        odd: Events that the plan does not explain, one sentence each.
        rest: Events from the point at which the mission was cut short.
    """

    done: int = 0
    undone: list[Undone] = field(default_factory=list)
    made: list[Made] = field(default_factory=list)
    left_out: int = 0
    odd: list[str] = field(default_factory=list)
    rest: tuple[Event, ...] = ()
