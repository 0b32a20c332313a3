"""Optional visits as an orienteering problem: the bridge from site and robot to :mod:`fieldhand.orienteering`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast.limits import Resource, limits_of, resources_of
from fieldhand.forecast.rest import Rest, rest_after
from fieldhand.forecast.service import service_of
from fieldhand.forecast.state import Spent
from fieldhand.orienteering.policy import SOLVE, Decision, Effort, decide, left_of
from fieldhand.orienteering.problem import Problem, under_way
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task.plan import ForEach

if TYPE_CHECKING:
    from fieldhand.forecast.walk import Walker

Floats = NDArray[np.float64]


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
