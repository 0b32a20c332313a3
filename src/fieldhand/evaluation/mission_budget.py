"""The budget of a mission: its resource limits, the cost of routes, and the failure probability that remains."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import DriveFault
from fieldhand.evaluation.battery_drain import BatteryDrain
from fieldhand.forecast.distances import Distances
from fieldhand.forecast.mission_state import MissionState, Visit, Work
from fieldhand.forecast.recharge_rules import RechargeRules, mission_limits, recharge_rules
from fieldhand.forecast.remaining_work import RemainingWork, remaining_work_after
from fieldhand.forecast.resource_limits import ResourceLimit, slower_s_per_m, speed_of
from fieldhand.forecast.risk_allowance import RiskAllowance
from fieldhand.forecast.route_cost import RouteCost, overrun_chances
from fieldhand.forecast.slow_ground import slow_ground
from fieldhand.places.context import Context
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task.build import exit_of
from fieldhand.task.frames import Task
from fieldhand.task.run import StackFrame, pace_of

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

Floats = NDArray[np.float64]


class MissionBudget:
    """The budget of one mission.

    Args:
        task, site, robot: Task, site and robot of the mission.
        drives: Drives between places of the site.
        charge_percent: Battery charge at the start of the mission, 0 to 100.

    Attributes:
        accepted: For each limit the overrun probability that the Task accepts, shape (limits,).
        distances: Cached driving distances between places.
        drain: Battery drain relative to its model.
    """

    def __init__(self, task: Task, site: Site, robot: RobotProfile, drives: Drives, charge_percent: float) -> None:
        self.task, self.site, self.drives = task, site, drives
        self.drain = BatteryDrain(robot)
        self._blocked = False
        limits = mission_limits(task, site, robot, drives, charge_percent)
        self._slow = slow_ground(task.constraints, site, robot)
        self.accepted: Floats = np.array([r.failure_probability for r in limits])
        self.distances = Distances(drives)
        self._allowance: RiskAllowance | None = None

    @property
    def robot(self) -> RobotProfile:
        """Return the robot with a battery model as fast as observed."""
        return self.drain.robot

    def set_drives(self, drives: Drives) -> None:
        """Use these drives from now on."""
        self.drives, self.distances, self._blocked = drives, Distances(drives), True

    def allowance(self, mandatory: Floats) -> RiskAllowance:
        """Return how much optional visits may still add to the overrun probability.

        Args:
            mandatory: For each limit the probability that the mandatory work runs short; only that of the first call is
                used.
        """
        if self._allowance is None:
            self._allowance = RiskAllowance.at_start(self.accepted.tolist(), mandatory)
        return self._allowance

    def add(self, chance: float) -> None:
        """Subtract the probability that a run of optional visits is expected to add from the allowance."""
        if self._allowance is not None:
            self._allowance = self._allowance.reduced_by(chance)

    def resources(self, state: MissionState) -> tuple[ResourceLimit, ...]:
        """Return the current resource limits; the battery's is based on its measured charge.

        While optional visits are chosen inside a pace, or in a mission with slow ground, all driving is assumed to be
        as slow: the solver has one speed.
        """
        charge = state.charge_percent + state.spent.percent
        chooses = bool(state.frames) and state.frames[-1].node.is_optional
        pace = min(pace_of(state.frames), self._slow.slowest_m_s) if chooses else math.inf
        return mission_limits(
            self.task,
            self.site,
            self.robot,
            self.drives,
            charge,
            charges=state.charges,
            planned=state.planned_charges,
            pace_m_s=pace,
        )

    @property
    def recharge(self) -> RechargeRules | None:
        """Return the rules of recharging with the battery as observed; None if the mission does not recharge."""
        return recharge_rules(self.task, self.site, self.robot)

    def slower(self, visit: Visit, metres: float, start: Place | None = None) -> Work:
        """Return the time that the pace of a visit adds to the drive to it, and slow ground on the way from a start."""
        seconds = metres * slower_s_per_m(self.task.constraints, self.robot, visit.pace_m_s)
        if self._slow and start is not None and metres:
            speed = speed_of(self.task.constraints, self.robot, visit.pace_m_s)
            seconds += self._slow.extra_s(self.drives.between(start, visit.place).points, speed)
        return Work(seconds=seconds)

    def chances(self, way: RouteCost, state: MissionState) -> Floats:
        """Return for each limit the probability that a route takes more than is left."""
        return overrun_chances(way, self.resources(state), self.robot, state.spent)

    def length(self, a: Place, b: Place) -> float:
        """Return the length of the drive between two places in metres.

        Raises:
            DriveFault: No way leads from one to the other.
        """
        return 0.0 if a.covers(b) else self.drives.between(a, b).length_m

    def home(self, at: Place) -> Place:
        """Return the place to which the robot returns on a low budget; the current place if no way leads there."""
        home = self.site.home(exit_of(self.task, "low_budget"), at)
        return home if self.distances.connected(at, home) else at

    def rest(self, frames: Sequence[StackFrame], context: Context, to_come: Sequence[Visit] = ()) -> RemainingWork:
        """Return the work required after the current node (:mod:`fieldhand.forecast.remaining_work`).

        If the robot has found ways blocked, no budget is reserved for work that cannot be reached now.

        Raises:
            DriveFault: No way leads to the remaining work, although no obstacle was found.
        """
        for visits in (to_come, ()):
            try:
                return remaining_work_after(
                    self.task, self.site, self.robot, self.drives, frames, context, to_come=visits
                )
            except DriveFault:
                if not self._blocked:
                    raise
        return RemainingWork()
