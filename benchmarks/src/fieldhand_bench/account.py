"""What a log shows of a plan."""

from __future__ import annotations

from dataclasses import dataclass, field

from fieldhand.task.results import Event


@dataclass(frozen=True, kw_only=True)
class Undone:
    """Work that had to be done and that the log does not show; no places where only the robot would have known them."""

    node: str
    places: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Made:
    """An optional visit that was made with all its work; ``run`` counts how often its loop had begun."""

    node: str
    run: int
    place: str


@dataclass(kw_only=True)
class Account:
    """What a log shows of a plan.

    Attributes:
        done: Pieces of work (an action with its captures, a drive that was asked for) that had to be done and were.
        undone: Those that were not.
        made: Optional visits.
        left_out: Optional visits that were given up.
        odd: What the plan does not explain.
        rest: Events from where the mission was cut short.
    """

    done: int = 0
    undone: list[Undone] = field(default_factory=list)
    made: list[Made] = field(default_factory=list)
    left_out: int = 0
    odd: list[str] = field(default_factory=list)
    rest: tuple[Event, ...] = ()
