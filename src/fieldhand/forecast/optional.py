"""What is optional as an orienteering problem: the bridge from site and robot to :mod:`fieldhand.orienteering`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import DriveFault
from fieldhand.forecast import routes
from fieldhand.forecast.limits import Resource, limits_of, resources_of, speed_of
from fieldhand.forecast.rest import Rest, every_answer, following, rest_after
from fieldhand.forecast.service import service_of
from fieldhand.forecast.state import Spent, Visit
from fieldhand.forecast.walk import Walker
from fieldhand.orienteering.policy import SOLVE, Decision, Effort, decide, left_of
from fieldhand.orienteering.problem import Problem, under_way
from fieldhand.orienteering.tail import chance_over
from fieldhand.robot.model import RobotProfile
from fieldhand.site.context import Context
from fieldhand.site.model import Place, Site
from fieldhand.task.frames import Task
from fieldhand.task.plan import ForEach, Optional

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

Floats = NDArray[np.float64]

#: What rounding may add.
_LOOK = 1 + 1e-9


def reward_of(node: ForEach, place: Place, site: Site) -> float:
    """What a visit is worth: the tree's attribute that the for-each names (0 where it has none), else 1."""
    if not node.reward:
        return 1.0
    tree = site.by_id.get(place.id) if place.kind == "tree" else None
    value = None if tree is None else tree.properties.get(node.reward)
    if not isinstance(value, int | float) or not math.isfinite(value):
        return 0.0
    return max(0.0, float(value))


def affordable(walker: Walker, node: ForEach, places: tuple[Place, ...]) -> tuple[int, ...]:
    """The optional visits that fit what the walk has left by then, as positions in ``places``, in their order.

    The rest of the plan and the way home are set aside first. The robot decides anew after every leg; so it makes about
    as many visits, not always these.
    """
    rest = rest_after(walker.task, walker.site, walker.robot, walker.drives, node.id, walker.context)
    around = [walker.context.here, *places, *([] if rest.first is None else [rest.first])]
    problem = visits_problem(
        distances=np.asarray(walker.drives.lengths(around), dtype=np.float64),
        rewards=[reward_of(node, place, walker.site) for place in places],
        service=[service_of(node.body, walker.robot)] * len(places),
        rest=rest,
        resources=resources_of(walker.task.constraints, walker.robot, walker.charge_percent),
        robot=walker.robot,
        spent=walker.spent,
    )
    levels = tuple(limit.failure_probability for limit in problem.limits)
    decision = decide_at_most(problem, levels, np.random.default_rng(0), effort=SOLVE, at_most=node.at_most)
    return tuple(v - 1 for v in decision.route.vertices[1:-1])


def visit_of(node: Optional, task: Task, site: Site, robot: RobotProfile, drives: Drives, context: Context) -> Visit:
    """An optional step as one visit: from where its body first drives to, on the branch that takes most.

    Args:
        node: The step.
        task, site, robot, drives: The mission.
        context: Where the robot is and has been.

    Returns:
        The visit; at the place in hand where nothing is driven. Of places that cannot be told before the robot is on
        its way, and of what comes after them, the work is counted and no drive.

    Raises:
        PlaceError: Its first place cannot be told.
        DriveFault: A place that cannot be reached.
    """
    speed = speed_of(task.constraints, robot)
    work_s, work_j = service_of(node.body, robot)
    longest, most = Visit(place=context.here), -1.0
    for holds in every_answer((node.body,)):
        steps = Walker(task, site, robot, drives, holds, optional=False, context=context).along(node.body)
        legs = [(s.drive.length_m, s.places[0]) for s in steps if s.drive is not None]
        acts = [s for s in steps if s.kind == "act"]
        visit = Visit(
            place=legs[0][1] if legs else context.here,
            reward=node.reward,
            service_s=max(work_s, sum(s.seconds for s in acts)),
            service_j=max(work_j, sum(s.joules for s in acts)),
            inside_m=sum(metres for metres, _ in legs[1:]),
            leaves=legs[-1][1] if len(legs) > 1 else None,
        )
        seconds = visit.service_s + sum(metres for metres, _ in legs) / speed
        if seconds > most:
            longest, most = visit, seconds
    return longest


def weigh(walker: Walker, node: Optional) -> tuple[Place, bool]:
    """Where an optional step begins, and whether it fits what the walk has left by then.

    What must follow and the way home are set aside first.
    """
    task, site, robot, drives, context = walker.task, walker.site, walker.robot, walker.drives, walker.context
    try:
        visit = visit_of(node, task, site, robot, drives, context)
    except DriveFault:
        return next(iter(routes.first_places(node.body, site, context)), context.here), False
    end = visit.leaves or visit.place
    rest = _rest_of_rounds(walker, node, Context(here=end, visited=context.visited, bound=context.bound))
    home = 0.0 if rest.first is None else _length(drives, end, rest.first)
    straight = 0.0 if rest.first is None else _length(drives, context.here, rest.first)
    legs = np.zeros((2, 3 + len(rest.legs_m)))  # on without the step, and by way of it
    legs[0, 0] = straight
    legs[1, :3] = _length(drives, context.here, visit.place), visit.inside_m, home
    legs[:, 3:] = rest.legs_m
    works = ((rest.seconds, rest.joules), (rest.seconds + visit.service_s, rest.joules + visit.service_j))
    limits = resources_of(task.constraints, robot, walker.charge_percent)
    left = np.array([[r.metres_left(walker.spent) - r.of_work(robot, *w) / r.per_metre for w in works] for r in limits])
    length = legs.sum(axis=1)
    chances = chance_over(length, (legs**2).sum(axis=1), left, robot.leg_cost.alpha)
    # As for a route over several visits: safe enough is what is accepted, or no riskier than it is without the step.
    allowed = np.maximum([r.failure_probability for r in limits], chances[:, 0])
    enough = length[1] <= np.maximum(left[:, 1], length[0]) * _LOOK
    return visit.place, bool(visit.reward > 0.0 and enough.all() and (chances[:, 1] <= allowed * _LOOK).all())


def _rest_of_rounds(walker: Walker, node: Optional, then: Context) -> Rest:
    """What must follow an optional step that ends at ``then``: what is left of the loops around it, then what is after.

    Of the loops it counts the drives from place to place and the work there, not what their bodies drive besides.
    """
    mission = (walker.task, walker.site, walker.robot, walker.drives)
    if not walker.rounds:
        return rest_after(*mission, node.id, then)
    outermost = walker.rounds[0]
    if outermost.after is None:
        outermost.after = rest_after(*mission, outermost.node.id, then, loops=False)
    rest, inner = outermost.after, node.id
    stops: list[Place] = []
    legs: list[float] = []
    seconds, joules = rest.seconds, rest.joules
    for one in reversed(walker.rounds):
        left = one.places[one.at + 1 :]
        if stops and left:
            legs.append(_length(walker.drives, stops[-1], left[0]))
        stops += left
        legs += one.legs_m[one.at + 1 :]
        later = following(one.node.body, inner, walker.site, then, loops=False)
        works = [service_of(x, walker.robot) for x in later if not isinstance(x, tuple)]
        works += [service_of(one.node.body, walker.robot)] * len(left)
        seconds, joules = seconds + sum(s for s, _ in works), joules + sum(j for _, j in works)
        inner = one.node.id
    if stops and rest.first is not None:
        legs.append(_length(walker.drives, stops[-1], rest.first))
    return Rest(
        first=stops[0] if stops else rest.first,
        legs_m=(*legs, *rest.legs_m),
        seconds=seconds,
        joules=joules,
        mandatory=rest.mandatory or bool(stops),
    )


def _length(drives: Drives, a: Place, b: Place) -> float:
    return 0.0 if a.xy == b.xy else drives.between(a, b).length_m


def decide_at_most(
    problem: Problem,
    levels: tuple[float, ...],
    rng: np.random.Generator,
    warm: tuple[int, ...] = (),
    *,
    effort: Effort,
    at_most: int | None,
) -> Decision:
    """The next optional visit where only so many may be made; preview and robot both ask here.

    The best route without that bound is planned first; then the stops worth least for their detour are left out, and
    the way over those that remain is planned anew.

    Args:
        problem, levels, rng, warm, effort: As for :func:`fieldhand.orienteering.policy.decide`.
        at_most: Visits that may still be made; None for as many as fit.
    """
    decision = decide(problem, levels, rng, warm, effort)
    stops = [v - 1 for v in decision.route.vertices[1:-1]]
    if at_most is None or len(stops) <= at_most:
        return decision
    kept = [s + 1 for s in _least_worth_dropped(stops, problem, at_most)]
    return decide(only(problem, kept), levels, rng, (problem.start, *kept, problem.end), effort)


def only(problem: Problem, vertices: Sequence[int]) -> Problem:
    """The problem in which nothing but these vertices is worth a visit."""
    others = tuple(v for v in range(len(problem.rewards)) if v not in vertices)
    return left_of(problem, problem.start, tuple(limit.budget for limit in problem.limits), others)


def visits_problem(
    *,
    distances: Floats,
    rewards: Sequence[float],
    service: Sequence[tuple[float, float]],
    rest: Rest,
    resources: Sequence[Resource],
    robot: RobotProfile,
    spent: Spent,
) -> Problem:
    """The orienteering problem of a robot that stands before optional visits.

    Args:
        distances: Between here, the candidates, and where the rest begins, in metres; without a last row where no more
            is driven after the visits.
        rewards: Of the candidates.
        service: Seconds and joules of work at each candidate.
        rest: What follows.
        resources: What may be used.
        robot: Its cost of legs, and the energy of work.
        spent: What has been used.

    Returns:
        A problem with here as vertex 0, the candidates after it, and the end as the last vertex. Its budgets may be too
        small for the way home: a mission under way can have come to that.
    """
    if rest.first is None:
        # Nothing follows, the robot may end anywhere: an end that is 0 away from everywhere.
        padded = np.zeros((len(distances) + 1, len(distances) + 1))
        padded[:-1, :-1] = distances
        distances = padded
    return under_way(
        distances=distances,
        rewards=np.array([0.0, *rewards, 0.0]),
        start=0,
        end=len(distances) - 1,
        limits=limits_of(resources, robot, spent, [(0.0, 0.0), *service, (0.0, 0.0)], (rest.seconds, rest.joules)),
        alpha=robot.leg_cost.alpha,
        after=rest.legs_m,
    )


def _least_worth_dropped(stops: list[int], problem: Problem, count: int) -> list[int]:
    """The stops without those that are worth least for the detour, until there are ``count``."""
    kept = list(stops)
    while len(kept) > count:
        way = [problem.start, *(s + 1 for s in kept), problem.end]
        d = problem.distances
        detour = [d[a, b] + d[b, c] - d[a, c] for a, b, c in zip(way, way[1:], way[2:], strict=False)]
        worth = [problem.rewards[v] / (max(x, 0.0) + 1e-6) for v, x in zip(way[1:-1], detour, strict=True)]
        kept.pop(int(np.argmin(worth)))
    return kept
