"""Resource limits of a mission: its budgets and the battery reserve, all converted to metres of driving.

The random cost of a leg counts as that many metres driven, which determine its time (at the robot's speed) and its
energy. So the use of every resource is the same random number of metres times a constant factor, plus the work; divided
by that factor, all resources become limits of one orienteering problem.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast.mission_state import Spent, Work
from fieldhand.orienteering.problem import Limit
from fieldhand.robot.model import RobotProfile
from fieldhand.task.frames import Budget, BudgetKind, Constraints

ResourceKind = BudgetKind | Literal["reserve"]
Floats = NDArray[np.float64]

_LEAST_PER_METRE = 1e-9


@dataclass(frozen=True, kw_only=True)
class ResourceLimit:
    """A limit on a resource of a mission.

    Attributes:
        kind: Kind of budget, or ``reserve``: the charge above the reserve that must be left at the end.
        limit: Amount available for the whole mission: metres, seconds, or percent of a full battery.
        failure_probability: Accepted probability of using more (Pf).
        per_metre: Amount used per metre of driving, in the unit of ``limit``.
        per_percent: Amount used per percent of charge besides, since it has to be charged again; included in
            ``per_metre`` and ``limit`` (:mod:`fieldhand.forecast.recharge_rules`).
    """

    kind: ResourceKind
    limit: float
    failure_probability: float
    per_metre: float
    per_percent: float = 0.0

    def of_work(self, robot: RobotProfile, work: Work) -> float:
        """Return the amount of the resource that work uses."""
        driven = work.metres * self.per_metre
        if self.per_percent:
            driven += self.per_percent * robot.percent(0.0, work.seconds, work.joules)
        match self.kind:
            case "distance_m":
                return driven
            case "duration_s":
                return driven + work.seconds
            case _:
                return driven + robot.percent(0.0, work.seconds, work.joules)

    def metres_of(self, work: Work, robot: RobotProfile) -> float:
        """Return the amount that work uses, as equivalent metres of driving."""
        return self.of_work(robot, work) / self.per_metre

    def used(self, spent: Spent) -> float:
        """Return the amount used so far."""
        charged = self.per_percent * spent.percent
        match self.kind:
            case "distance_m":
                return charged + spent.metres
            case "duration_s":
                return charged + spent.seconds
            case _:
                return charged + spent.percent

    def metres_left(self, spent: Spent) -> float:
        """Return the mean metres that can be driven with the amount left; negative if overspent."""
        return (self.limit - self.used(spent)) / self.per_metre


def speed_of(constraints: Constraints, robot: RobotProfile, pace_m_s: float = math.inf) -> float:
    """Return the speed in m/s: the robot's, or the Task's or that of the part of the plan (its pace) if slower."""
    whole = math.inf if constraints.speed_m_s is None else constraints.speed_m_s
    return min(robot.speed_m_s, whole, pace_m_s)


def slower_s_per_m(constraints: Constraints, robot: RobotProfile, pace_m_s: float) -> float:
    """Return the seconds per metre that a pace adds to those of the rest of the mission; 0 if it is no slower."""
    return max(0.0, 1.0 / speed_of(constraints, robot, pace_m_s) - 1.0 / speed_of(constraints, robot))


def reserve_percent(constraints: Constraints, robot: RobotProfile) -> float:
    """Return the charge in percent that must be left at the end."""
    return robot.energy.reserve_percent if constraints.reserve_percent is None else constraints.reserve_percent


def resource_limits(
    constraints: Constraints, robot: RobotProfile, charge_percent: float = 100.0, *, pace_m_s: float = math.inf
) -> tuple[ResourceLimit, ...]:
    """Return every limit of a mission: its budgets in order, then the battery reserve.

    Args:
        constraints: Constraints of the Task.
        robot: The robot.
        charge_percent: Battery charge at the start of the mission, 0 to 100.
        pace_m_s: Speed limit of the part of the plan in which all driving is assumed to take place.
    """
    speed = speed_of(constraints, robot, pace_m_s)
    per_metre: dict[ResourceKind, float] = {
        "distance_m": 1.0,
        "duration_s": 1.0 / speed,
        "energy_percent": robot.percent(1.0, 1.0 / speed),
    }
    accepted = min((b.failure_probability for b in constraints.budgets), default=Budget.failure_probability)
    budgets = tuple(
        ResourceLimit(
            kind=b.kind,
            limit=b.limit,
            failure_probability=b.failure_probability,
            per_metre=max(per_metre[b.kind], _LEAST_PER_METRE),
        )
        for b in constraints.budgets
    )
    reserve = ResourceLimit(
        kind="reserve",
        limit=charge_percent - reserve_percent(constraints, robot),
        failure_probability=accepted,
        per_metre=max(per_metre["energy_percent"], _LEAST_PER_METRE),
    )
    return (*budgets, reserve)


def orienteering_limits(
    resources: Sequence[ResourceLimit],
    robot: RobotProfile,
    spent: Spent,
    service: Sequence[Work],
    later: Work,
    accepted: float,
) -> tuple[Limit, ...]:
    """Return the limits of an orienteering problem, in metres.

    Args:
        resources: The resource limits.
        robot: Profile with the battery model, for the energy of work.
        spent: Resources used so far.
        service: Work at each vertex.
        later: Work that follows on every route.
        accepted: Accepted probability of exceeding any of them.
    """
    return tuple(
        Limit(
            budget=r.metres_left(spent) - r.metres_of(later, robot),
            failure_probability=accepted,
            service=np.array([r.metres_of(work, robot) for work in service], dtype=np.float64),
        )
        for r in resources
    )
