"""The steps and decisions of a walk through a Task."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from fieldhand.forecast.sampled_costs import SampledUse
from fieldhand.places.context import Context
from fieldhand.short_repr import short_repr
from fieldhand.site.model import Place
from fieldhand.task.plan import Node

if TYPE_CHECKING:
    from fieldhand.site.drives import Drive

StepKind = Literal["drive", "act", "visit-list", "decide", "exit"]
DecisionKind = Literal["holds", "fails", "blocked", "taken"]

#: Answers a question about a node by its id: does its condition hold, does its action fail.
Answer = Callable[[str], bool]


def never(node_id: str) -> bool:  # noqa: ARG001
    """No action fails."""
    return False


@dataclass(frozen=True, kw_only=True)
class Decision:
    """One answer along a walk.

    Attributes:
        node: Whose condition (``If``, or ``until`` of a loop), whose action or drive inside a ``Try``, which optional
            step or for-each.
        kind: ``holds`` for a condition, ``fails`` for an action, ``blocked`` for a drive that never arrives, ``taken``
            for an optional step.
        sure: No other answer can be on this branch: what was read before, or the site, says it.
        place: Id of the place in hand.
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
    """One thing that happens.

    Attributes:
        node: The plan node that it belongs to; for the exit, the ``Stop`` that takes it or the root of the plan.
        kind: ``visit-list`` where a for-each has found its places, or where an optional step is decided on (a list of
            one place, where it begins); ``exit`` for the way home, else what it says.
        context: The robot's place and visited trees before the step.
        places: Of a drive or an exit, where to; of an act, where; of a visit list, the places in their order.
        shed: Of a visit list, places for which the budget will hardly last.
        visit_forecast: Forecast of a list of optional visits.
        drive: The way, of a drive, and of an exit that goes anywhere.
        captures: Number of captures of an act.
        seconds, joules: Mean time and energy of the step; energy without idle power.
        answer: Answer of a decision.
        reached: False of a drive that is blocked just before its end.
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
    reached: bool = True

    __repr__ = short_repr


@dataclass(frozen=True, kw_only=True, repr=False)
class Walk:
    """A Task along one branch.

    Attributes:
        end: Final place of the robot.
        exit: Exit that was taken.
        decisions: In the order in which they came up; they tell one walk from another.
        unread: Conditions that test what nothing has read on this branch: id of the node, and the reading.
        used: What missions use that go this way, each with its own optional visits; None where none were drawn.
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
        """Return seconds and joules of all actions."""
        acts = [s for s in self.steps if s.kind == "act"]
        return (sum(s.seconds for s in acts), sum(s.joules for s in acts))
