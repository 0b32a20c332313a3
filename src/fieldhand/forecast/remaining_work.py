"""Remaining work of a plan under way: the mandatory steps that follow, and the way home.

The current nodes (:class:`fieldhand.task.run.StackFrame`) contain what is left of them. The caller supplies the
remaining visits of the current loops. A repeat counts with all its remaining rounds, as if its condition never ended
it.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

from fieldhand.errors import DriveFault, PlaceError
from fieldhand.forecast.mission_state import Visit, Work
from fieldhand.forecast.request_handler import ForecastHandler
from fieldhand.forecast.resource_limits import slower_s_per_m, speed_of
from fieldhand.forecast.route_cost import RouteCost, route_cost
from fieldhand.forecast.slow_ground import slow_ground
from fieldhand.forecast.walk_state import Answers
from fieldhand.forecast.walk_steps import NodeAnswer, never
from fieldhand.places.context import Context
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task import plan
from fieldhand.task.frames import Task
from fieldhand.task.plan import Node
from fieldhand.task.run import StackFrame

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

_MAX_CONDITIONS = 4


@dataclass(frozen=True, kw_only=True)
class RemainingWork:
    """The remaining work on the most demanding branch.

    Attributes:
        stops: Places to be visited in order, including home; empty if no drive remains.
        legs_m: Lengths in metres of the legs between the stops, without the leg to the first one.
        work: Work of all remaining actions.
        mandatory: True if it consists of more than the way home.
        fixed: True if it does not depend on the robot's previous places, except for the order of visits with a free
            order.
    """

    stops: tuple[Place, ...] = ()
    legs_m: tuple[float, ...] = ()
    work: Work = field(default_factory=Work)
    mandatory: bool = False
    fixed: bool = True

    @cached_property
    def way(self) -> RouteCost:
        """Return the cost of the legs from the first stop on, with the work."""
        return route_cost(self.legs_m, self.work)

    @property
    def first(self) -> Place | None:
        """Return the first place; None if no drive remains."""
        return self.stops[0] if self.stops else None


def remaining_work_after(
    task: Task,
    site: Site,
    robot: RobotProfile,
    drives: Drives,
    frames: Sequence[StackFrame],
    context: Context,
    *,
    to_come: Sequence[Visit] = (),
) -> RemainingWork:
    """Return the mandatory work after the current node, on the most demanding branch.

    Args:
        task, site, robot, drives: Task, site, robot and drives of the mission.
        frames: Current nodes of the plan, outermost first.
        context: The robot's current place and visited trees.
        to_come: Visits of the current for-each loops that have not begun, in visiting order; they come first.

    Raises:
        DriveFault: No way leads between the remaining visits, or onward from them.
    """
    rest = _most(task, site, robot, drives, following(frames), arrived(context, to_come))
    if not to_come:
        return rest
    slow = slow_ground(task.constraints, site, robot)

    def added_s(a: Place, b: Visit, metres: float) -> float:
        """Return the seconds that the pace of a visit and slow ground add to a leg."""
        seconds = metres * slower_s_per_m(task.constraints, robot, b.pace_m_s)
        if slow and metres:
            speed = speed_of(task.constraints, robot, b.pace_m_s)
            seconds += slow.extra_s(drives.between(a, b.place).points, speed)
        return seconds

    return _joined(to_come, rest, drives, added_s)


def whole_mission_work(task: Task, site: Site, robot: RobotProfile, drives: Drives, context: Context) -> RemainingWork:
    """Return the mandatory work of a whole Task from the start of the mission."""
    return _most(task, site, robot, drives, (task.composition.plan,), context)


def _most(
    task: Task, site: Site, robot: RobotProfile, drives: Drives, nodes: Sequence[Node], context: Context
) -> RemainingWork:
    """Return the work of the most demanding branch of nodes, including the way home."""
    speed = speed_of(task.constraints, robot)
    fixed = not any(_is_relative(node) for node in nodes)
    worst, most = RemainingWork(), -1.0
    for holds in every_answer(nodes):
        found = _walk_rest(ForecastHandler(task, site, robot, drives, Answers(holds=holds), context=context), nodes)
        found = replace(found, fixed=fixed)
        seconds = (sum(found.legs_m) + found.work.metres) / speed + found.work.seconds
        if found.first is not None:
            seconds += drives.between(context.here, found.first).length_m / speed
        if seconds > most:
            worst, most = found, seconds
    return worst


def optional_runs(frames: Sequence[StackFrame]) -> int:
    """Return how many runs of optional visits may still follow, including that of the current node.

    A loop may contain any number of runs; one more than is known is counted, so that some allowance is left.
    """
    loops = [frame.node.visits_each or frame.node.rounds is not None for frame in frames[:-1]]
    once = (frame for frame, again in zip(frames, loops, strict=False) if not again)
    later = sum(node.is_optional for frame in once for step in frame.left for node in plan.walk(step))
    return 1 + sum(loops) + later


def following(frames: Sequence[StackFrame]) -> tuple[Node, ...]:
    """Return the nodes after the current one in order, including the remaining rounds of repeats."""
    rest: tuple[Node, ...] = ()
    for frame in reversed(frames):
        rest = frame.node.around((*rest, *frame.left))
    return rest


def arrived(context: Context, visits: Sequence[Visit]) -> Context:
    """Return the context of the mission after given visits."""
    if not visits:
        return context
    known = set(context.visited)
    trees = dict.fromkeys(v.place.id for v in visits if v.place.kind == "tree")
    fresh = [tree for tree in trees if tree not in known]
    return replace(context, here=visits[-1].end, visited=(*context.visited, *fresh))


def _joined(
    visits: Sequence[Visit], rest: RemainingWork, drives: Drives, added_s: Callable[[Place, Visit, float], float]
) -> RemainingWork:
    """Return given visits followed by the remaining work; ``added_s`` gives the seconds that a slower leg adds."""
    legs = [_length(drives, a.end, b.place) for a, b in itertools.pairwise(visits)]
    added = sum(added_s(a.end, b, metres) for metres, (a, b) in zip(legs, itertools.pairwise(visits), strict=True))
    if rest.first is not None:
        legs.append(_length(drives, visits[-1].end, rest.first))
    return RemainingWork(
        stops=(*(v.place for v in visits), *rest.stops),
        legs_m=(*legs, *rest.legs_m),
        work=sum((v.work for v in visits), rest.work + Work(seconds=added)),
        mandatory=True,
        fixed=rest.fixed,
    )


def _length(drives: Drives, a: Place, b: Place) -> float:
    return 0.0 if a.covers(b) else drives.between(a, b).length_m


def _walk_rest(walker: ForecastHandler, nodes: Sequence[Node]) -> RemainingWork:
    try:
        walked = walker.run(nodes)
    except (PlaceError, DriveFault):
        # Places that cannot be resolved from here may be once the robot is there; then only the way home is reserved.
        walker = ForecastHandler(
            walker.task,
            walker.site,
            walker.robot,
            walker.drives,
            Answers(holds=never),
            context=walker.beginning,
        )
        walked = walker.run(())
    # The walk's own legs cannot be used: if it begins at its current place, the robot will have to come back there.
    stops: list[Place] = []
    legs: list[float] = []
    for k, stop in enumerate(walker.stops):
        if k and k - 1 in walker.worked:
            legs.append(0.0)  # the way along a stretch is part of its work
        elif k and stops[-1].covers(stop):
            continue
        elif k:
            legs.append(walker.drives.between(stops[-1], stop).length_m)
        stops.append(stop)
    return RemainingWork(
        stops=tuple(stops),
        legs_m=tuple(legs),
        work=walked.whole_work,
        mandatory=any(s.kind in ("drive", "act", "wait", "work") for s in walked.steps),
    )


def _is_relative(following: Node) -> bool:
    """Return True if places in a node depend on where the robot is or has been."""
    selectors = (node.selector for node in plan.walk(following))
    return any(s is not None and s.relative for s in selectors)


def every_answer(nodes: Sequence[Node]) -> list[NodeAnswer]:
    """Return every combination of answers to the first few conditions; all others share one answer."""
    asked = [n.id for node in nodes for n in plan.walk(node) if n.tested is not None]
    if not asked:
        return [lambda _: False]
    some = asked[:_MAX_CONDITIONS]
    beyond = (True, False) if len(asked) > len(some) else (False,)
    return [
        _answer_from(dict(zip(some, answers, strict=True)), default)
        for answers in itertools.product((True, False), repeat=len(some))
        for default in beyond
    ]


def _answer_from(answers: dict[str, bool], default: bool) -> NodeAnswer:
    return lambda node_id: answers.get(node_id, default)
