"""Conversion of optional visits to a problem of :mod:`fieldhand.orienteering`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast.mission_state import Spent, Work
from fieldhand.forecast.remaining_work import RemainingWork
from fieldhand.forecast.resource_limits import ResourceLimit, orienteering_limits
from fieldhand.forecast.visit_distances import VisitDistances
from fieldhand.orienteering.problem import Problem
from fieldhand.robot.model import RobotProfile

if TYPE_CHECKING:
    from fieldhand.orienteering.policy import Policy

Floats = NDArray[np.float64]

#: Overrun probability of driving straight to a visit and on, above which the visit is given up for good.
GONE = 0.9
#: Number of remakes of an order that was planned for nearly the same visits: a fifth of those of a new order.
_REMAKES = 8
_SEED = 0
#: Bounds of the failure probability given to a solver.
_LEAST, _MOST = 1e-6, 1.0 - 1e-6


def visits_problem(
    *,
    legs: VisitDistances,
    rewards: Sequence[float],
    service: Sequence[Work],
    rest: RemainingWork,
    resources: Sequence[ResourceLimit],
    robot: RobotProfile,
    spent: Spent,
    accepted: float,
    max_visits: int | None,
) -> Problem:
    """Return the orienteering problem of a robot that chooses among optional visits.

    Args:
        legs: Distances in metres between the current place, the candidates, and the start of the remaining work.
        rewards: Rewards of the candidates.
        service: Work at each candidate.
        rest: Mandatory work that follows.
        resources: The resource limits.
        robot: Profile with the leg cost model and the energy of work.
        spent: Resources used so far.
        accepted: Accepted probability of exceeding any limit.
        max_visits: Maximum number of visits; None for as many as fit.

    Returns:
        A problem with the current place as vertex 0, then the candidates, and the end as the last vertex. Its budgets
        may be too small for the way home, since a mission under way can get into that state.
    """
    chance = min(max(accepted, _LEAST), _MOST)
    return Problem(
        under_way=True,
        distances=legs.distances,
        coordinates=legs.coordinates,
        table=legs.table,
        rewards=np.array([0.0, *rewards, 0.0]),
        start=0,
        end=len(rewards) + 1,
        limits=orienteering_limits(resources, robot, spent, [Work(), *service, Work()], rest.work, chance),
        alpha=robot.leg_cost.alpha,
        legs_after=rest.legs_m,
        max_visits=max_visits,
    )


def left_before(
    resources: Sequence[ResourceLimit], robot: RobotProfile, spent: Spent, rest: RemainingWork
) -> tuple[float, ...]:
    """Return the metres of each resource left for optional visits after the following work is subtracted."""
    return tuple(r.metres_left(spent) - r.metres_of(rest.work, robot) for r in resources)


def policy_for(
    problem: Problem, *, price: float | None = None, warm: Sequence[int] = (), collected: float = 0.0
) -> Policy:
    """Return the policy used on board and in the forecast; it maximises mean reward, with 0 for failed missions.

    Both use the same seed, so the robot starts with the forecast order.

    Args:
        problem: A problem from :func:`visits_problem`.
        price: Price of a failure in units of reward, if an earlier decision of the run has computed it.
        warm: Vertices of the previous plan.
        collected: Reward of visits that are not in the problem because they were made before.
    """
    from fieldhand.orienteering.decision import SearchEffort
    from fieldhand.orienteering.policy import Policy

    effort = SearchEffort(remakes=_REMAKES) if warm else SearchEffort()
    return Policy(problem, _SEED, risk_tolerance=0.0, price=price, warm=warm, effort=effort, collected=collected)
