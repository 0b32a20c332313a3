"""Optional visits as a problem of :mod:`fieldhand.orienteering`."""

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

#: A visit is given up for good when going straight there, and then on, runs short with this chance.
GONE = 0.9
#: How often an order is remade that was planned for much the same visits: a fifth of what one from nothing takes.
_REMAKES = 8
_SEED = 0
#: A chance that a solver is asked to keep to lies between these.
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
        legs: Between here, the candidates, and where the rest begins.
        rewards: Rewards of the candidates.
        service: Work at each candidate.
        rest: Work that follows.
        resources: The resource limits.
        robot: Its cost of legs, and the energy of work.
        spent: Resources used so far.
        accepted: Accepted probability of running short of any of it.
        max_visits: Visits that may be made; None for as many as fit.

    Returns:
        A problem with here as vertex 0, the candidates after it, and the end as the last vertex. Its budgets may be too
        small for the way home: a mission under way can have come to that.
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
    """Return metres left of each resource for optional visits after the following work is subtracted."""
    return tuple(r.metres_left(spent) - r.metres_of(rest.work, robot) for r in resources)


def policy_for(problem: Problem, *, price: float | None = None, warm: Sequence[int] = ()) -> Policy:
    """Return what decides on board and in the forecast; it collects the most over all missions, failed ones counting 0.

    Both search with the same seed: the order that was forecast is the one that the robot sets out with.

    Args:
        problem: A problem from :func:`visits_problem`.
        price: Price of a failure, if an earlier decision of the run computed it.
        warm: Vertices that were planned.
    """
    from fieldhand.orienteering.decision import SearchEffort
    from fieldhand.orienteering.policy import Policy

    effort = SearchEffort(remakes=_REMAKES) if warm else SearchEffort()
    return Policy(problem, _SEED, risk_tolerance=0.0, price=price, warm=warm, effort=effort)
