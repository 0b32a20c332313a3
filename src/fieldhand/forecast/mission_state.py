"""Data exchanged between the mission and the budget guard: position, resources used, possible visits, decisions."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.places.context import Context
from fieldhand.site.model import Place

if TYPE_CHECKING:
    from fieldhand.task.results import ShedCause
    from fieldhand.task.run import StackFrame


@dataclass(frozen=True, kw_only=True)
class Spent:
    """Resources used so far, or by a part of a mission: metres, seconds, percent of a full battery.

    Attributes:
        percent: What the battery supplied; what it was charged with in between is not subtracted.
        joules: Energy of actions in joules by the profile, without idle power.
        docked_s: Seconds of these at the charger, which supplied the robot.
        absent_s: Seconds beside these for which the program was dead, while the robot stood and may have been on.
    """

    metres: float = 0.0
    seconds: float = 0.0
    percent: float = 0.0
    joules: float = 0.0
    docked_s: float = 0.0
    absent_s: float = 0.0

    def __add__(self, other: Spent) -> Spent:
        return Spent(
            metres=self.metres + other.metres,
            seconds=self.seconds + other.seconds,
            percent=self.percent + other.percent,
            joules=self.joules + other.joules,
            docked_s=self.docked_s + other.docked_s,
            absent_s=self.absent_s + other.absent_s,
        )


@dataclass(frozen=True, kw_only=True)
class Work:
    """Work on its longest branch: seconds, joules of actions without idle power, and metres driven."""

    seconds: float = 0.0
    joules: float = 0.0
    metres: float = 0.0

    def __add__(self, other: Work) -> Work:
        return Work(
            seconds=self.seconds + other.seconds,
            joules=self.joules + other.joules,
            metres=self.metres + other.metres,
        )


@dataclass(frozen=True, kw_only=True)
class Visit:
    """A place to which the robot could drive next, with the cost of the work there, excluding the drive to it.

    Attributes:
        reward: Reward of an optional visit.
        service_s: Seconds of work there on the longest branch.
        service_j: Energy of the actions there in joules, idle power not included.
        inside_m: Metres driven within the visit after arrival, on the longest branch; their time and energy are not
            included in ``service_s`` and ``service_j``.
        leaves: Place where the visit ends; None if it is ``place``.
        pace_m_s: Speed limit of the drive to it in m/s; infinite without one.
        ends: True for the way home after everything else.
    """

    place: Place
    reward: float = 1.0
    service_s: float = 0.0
    service_j: float = 0.0
    inside_m: float = 0.0
    leaves: Place | None = None
    pace_m_s: float = math.inf
    ends: bool = False

    @property
    def work(self) -> Work:
        """Return the work of the visit, without the drive to it."""
        return Work(seconds=self.service_s, joules=self.service_j, metres=self.inside_m)

    @property
    def end(self) -> Place:
        """Return the place where the visit ends."""
        return self.place if self.leaves is None else self.leaves


@dataclass(frozen=True, kw_only=True)
class MissionState:
    """The state of a mission on which the guard bases its decisions.

    Attributes:
        frames: Current nodes of the plan, outermost first; the last one is about to drive or act.
        context: Current place, visited trees, and bound places.
        spent: Resources used since the mission began.
        charge_percent: Current battery charge, 0 to 100.
        charges, planned_charges: Number of charges so far that the guard ordered, and of those that the plan contains.
    """

    frames: tuple[StackFrame, ...]
    context: Context
    spent: Spent
    charge_percent: float
    charges: int = 0
    planned_charges: int = 0

    @property
    def node(self) -> str:
        """Return the id of the node that is about to drive or act."""
        return self.frames[-1].node.id


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """The guard's decision about a mandatory visit: reason, probability of running short, and cause of a refusal.

    ``charge_to``: percent to which the battery has to be charged first; then the guard is asked again. 0 for none.
    """

    go: bool
    reason: str = ""
    chance_short: float = 0.0
    cause: ShedCause = "budget"
    charge_to: float = 0.0


@dataclass(frozen=True, kw_only=True)
class VisitChoice:
    """The guard's choice of the next candidate (None if none fits), the candidates given up for good, and the reason.

    Attributes:
        chance_short: Probability of running short by the visits given up, if there are any; otherwise by the next one.
        cause: Cause of giving them up.
        names_places: True if the reason names their places.
        charge_to: Percent to which the battery has to be charged first; then the guard is asked again. 0 for none.
    """

    index: int | None
    shed: tuple[int, ...] = ()
    reason: str = ""
    chance_short: float = 0.0
    cause: ShedCause = "budget"
    names_places: bool = False
    charge_to: float = 0.0
