"""What passes between the robot and the budget guard: where it is, what it has spent, where it could go next."""

from __future__ import annotations

from dataclasses import dataclass

from fieldhand.site.context import Context
from fieldhand.site.model import Place


@dataclass(frozen=True, kw_only=True)
class Spent:
    """Resources used so far, or by a part of a mission."""

    metres: float = 0.0
    seconds: float = 0.0
    percent: float = 0.0

    def __add__(self, other: Spent) -> Spent:
        return Spent(
            metres=self.metres + other.metres,
            seconds=self.seconds + other.seconds,
            percent=self.percent + other.percent,
        )


@dataclass(frozen=True, kw_only=True)
class Visit:
    """A place that the robot could drive to next, and what doing the work there takes (the drive not included).

    Attributes:
        reward: What the visit is worth, where it is optional.
        service_s: Seconds of work there, on the longest branch.
        service_j: Energy of the actions there in joules, idle power not included.
        inside_m: Metres driven from there on within the visit, on the longest branch; their time and energy are not in
            ``service_s`` and ``service_j``.
        leaves: Where the visit ends; None where that is ``place``.
    """

    place: Place
    reward: float = 1.0
    service_s: float = 0.0
    service_j: float = 0.0
    inside_m: float = 0.0
    leaves: Place | None = None


@dataclass(frozen=True, kw_only=True)
class MissionState:
    """What the guard decides on.

    Attributes:
        node: Id of the plan node that is about to drive or act.
        context: The place in hand, visited trees, bound places.
        spent: Used since the mission began.
        charge_percent: Battery left.
    """

    node: str
    context: Context
    spent: Spent
    charge_percent: float


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """Whether a mandatory visit may go ahead, why, and the chance of running short if it does."""

    go: bool
    reason: str = ""
    chance_short: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Choice:
    """Which of the candidates comes next (None: none fits any more), which are given up for good, and why."""

    index: int | None
    shed: tuple[int, ...] = ()
    reason: str = ""
    chance_short: float = 0.0
