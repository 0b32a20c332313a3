"""The cost of a route with the work along it, and the probability that it exceeds a limit."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast.mission_state import Spent, Work
from fieldhand.forecast.resource_limits import ResourceLimit
from fieldhand.orienteering.costs import CostModel, Deterministic, ShiftedExponential
from fieldhand.orienteering.overrun import overrun_probability
from fieldhand.robot.model import RobotProfile

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class RouteCost:
    """The cost of a route: power sums of its leg lengths, and the work along it.

    Attributes:
        sums: Sums of the leg lengths in metres, of their squares and of their cubes, which determine the cost
            distribution.
        work: Work along the route.
    """

    sums: tuple[float, float, float] = (0.0, 0.0, 0.0)
    work: Work = field(default_factory=Work)

    def __add__(self, other: RouteCost) -> RouteCost:
        a, b = self.sums, other.sums
        return RouteCost(sums=(a[0] + b[0], a[1] + b[1], a[2] + b[2]), work=self.work + other.work)


def route_cost(legs_m: Iterable[float], work: Work | None = None) -> RouteCost:
    """Return the cost of a route over given legs."""
    legs = np.asarray(tuple(legs_m), dtype=np.float64)
    sums = (float(legs.sum()), float((legs**2).sum()), float((legs**3).sum()))
    return RouteCost(sums=sums, work=work or Work())


def cost_model(robot: RobotProfile) -> CostModel:
    """Return the robot's cost model of a leg."""
    alpha = robot.leg_cost.alpha
    return Deterministic() if alpha >= 1.0 else ShiftedExponential(alpha)


def mean_metres(way: RouteCost, resources: Sequence[ResourceLimit], robot: RobotProfile) -> Floats:
    """Return the mean use of each resource by a route, in equivalent metres of driving, shape (resources,)."""
    return np.array([way.sums[0] + r.metres_of(way.work, robot) for r in resources])


def overrun_chances(
    way: RouteCost, resources: Sequence[ResourceLimit], robot: RobotProfile, spent: Spent, used: Floats | None = None
) -> Floats:
    """Return for each resource the probability that a route uses more than is left, shape (resources,).

    Args:
        way, resources, robot: The route, the resource limits and the robot.
        spent: Resources used so far.
        used: Metres that each sampled mission has driven in addition, shape (missions,). The result then has shape
            (resources, missions).
    """
    first, squares, cubes = way.sums
    second, third = cost_model(robot).cumulants()
    room = np.array([r.metres_left(spent) - r.metres_of(way.work, robot) for r in resources])
    left = room if used is None else room[:, None] - used
    return overrun_probability(first, second * squares, third * cubes, left)
