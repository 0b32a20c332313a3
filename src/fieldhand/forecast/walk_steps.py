"""The steps and decisions of a walk through a Task."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from fieldhand.forecast.mission_state import Work
from fieldhand.forecast.sampled_costs import SampledUse
from fieldhand.places.context import Context
from fieldhand.short_repr import short_repr
from fieldhand.site.model import Place
from fieldhand.task.plan import Node

if TYPE_CHECKING:
    from fieldhand.site.drives import Drive
    from fieldhand.site.working.stretch import Stretch

StepKind = Literal["drive", "act", "wait", "work", "charge", "visit-list", "decide", "exit"]
DecisionKind = Literal["holds", "fails", "blocked", "taken"]

#: Answers a question about a node, given its id: whether its condition holds, or its action fails.
NodeAnswer = Callable[[str], bool]


def never(node_id: str) -> bool:  # noqa: ARG001
    """Answer that no action fails."""
    return False


@dataclass(frozen=True, kw_only=True)
class Decision:
    """One answer along a walk.

    Attributes:
        node: Id of the node with the condition (``If``, or ``until`` of a loop), of the action or drive inside a
            ``Try``, or of the optional step or for-each.
        kind: ``holds`` for a condition, ``fails`` for an action, ``blocked`` for a drive that never arrives, ``taken``
            for an optional step.
        sure: True if earlier readings or the site determine the answer on this branch.
        place: Id of the current place.
    """

    node: str
    kind: DecisionKind
    answer: bool
    sure: bool = field(default=False, compare=False)
    place: str = field(default="", compare=False)


@dataclass(frozen=True, kw_only=True)
class VisitForecast:
    """The forecast of optional visits.

    Attributes:
        visits: Mean number of visits per mission.
        chances: Probability of a visit to each reachable place, by its id.
    """

    visits: float
    chances: Mapping[str, float]


@dataclass(frozen=True, kw_only=True, repr=False)
class WalkStep:
    """A step of a walk: a drive, an action, a wait, work along a stretch, a charge, a decision, visits, or the exit.

    Attributes:
        node: Plan node that the step belongs to; for the exit, the ``Stop`` that takes it or the root of the plan.
        kind: Kind of step. ``visit-list``: a for-each has found its places, or an optional step is decided on (a list
            of the one place where it begins); ``exit``: the way home; the others as named.
        context: The robot's place and visited trees before the step.
        places: Destination of a drive or an exit, place of an act or a wait, or places of a visit list in order.
        shed: Places of a visit list for which the budget will probably not suffice.
        visit_forecast: Forecast of a list of optional visits.
        drive: Path of a drive, or of an exit that includes one.
        captures: Number of captures of an act.
        seconds, joules: Mean time in seconds and energy in joules of the step; energy without idle power.
        answer: Answer of a decision.
        slower_s_per_m: Seconds per metre of a drive that the pace of its part of the plan and slow ground add to those
            of the mission.
        reached: False for a drive that is blocked just before its end.
        stretch: Stretch of work along a path.
        work: Use of a stretch in the form of work, whose metres are driven at the mission's speed.
        heading_deg: Heading at the end of a drive or during an act, in degrees clockwise from north; None if it is
            unknown, or of no importance for this robot.
        turn_s: Seconds of a drive in which the robot turns on the spot, before and after it.
        sees: True if the camera of an act has the plant in view, False if not; None without a camera.
    """

    node: Node
    kind: StepKind
    context: Context
    places: tuple[Place, ...] = ()
    shed: tuple[Place, ...] = ()
    visit_forecast: VisitForecast | None = None
    drive: Drive | None = None
    captures: int = 0
    seconds: float = 0.0
    joules: float = 0.0
    answer: bool | None = None
    slower_s_per_m: float = 0.0
    reached: bool = True
    stretch: Stretch | None = None
    work: Work = field(default_factory=Work)
    heading_deg: float | None = None
    turn_s: float = 0.0
    sees: bool | None = None

    __repr__ = short_repr


@dataclass(frozen=True, kw_only=True, repr=False)
class Walk:
    """A Task along one branch.

    Attributes:
        end: Final place of the robot.
        exit: Exit that was taken.
        decisions: Decisions in order, which identify the walk.
        unread: Conditions that test a reading not taken on this branch: id of the node, and the reading.
        used: Resources used by the missions sampled along the walk, each with its own optional visits; None if none
            were sampled.
    """

    steps: tuple[WalkStep, ...]
    end: Place
    exit: Literal["nominal", "faulted"]
    decisions: tuple[Decision, ...] = ()
    unread: tuple[tuple[str, str], ...] = ()
    used: SampledUse | None = field(default=None, compare=False)

    __repr__ = short_repr

    @property
    def legs_m(self) -> tuple[float, ...]:
        """Return the length of each leg in metres, including the way home."""
        return tuple(s.drive.length_m for s in self.steps if s.drive is not None)

    @property
    def work(self) -> tuple[float, float]:
        """Return seconds and joules of actions at places, waits and charges, and the seconds added by slower drives."""
        work = [work_in(s) for s in self.steps]
        return (sum(w.seconds for w in work), sum(w.joules for w in work))

    @property
    def whole_work(self) -> Work:
        """Return the work of all actions, at places and along stretches."""
        seconds, joules = self.work
        return sum((s.work for s in self.steps if s.kind == "work"), Work(seconds=seconds, joules=joules))


def work_in(step: WalkStep) -> Work:
    """Return the work of a step at one place (action, wait or charge), or the time that slower driving and turning add
    to a drive.
    """
    if step.kind in ("act", "wait", "charge"):
        return Work(seconds=step.seconds, joules=step.joules)
    return Work(seconds=step.turn_s + (0.0 if step.drive is None else step.drive.length_m * step.slower_s_per_m))
