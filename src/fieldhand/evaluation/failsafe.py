"""Foresee, while the robot drives and works, whether each limit still allows the way home.

The budget guard decides before each drive; what it granted holds until the next decision. In between, the battery may
begin to empty faster and a leg may turn out long. As soon as going on would more likely than not exceed a limit, and
turning round is safer, the drive or capture in hand is to be broken off. Of a battery that empties faster than its
model, no more is risked than the accepted chance. docs/faults.md gives the rules.
"""

from __future__ import annotations

import numpy as np

from fieldhand.evaluation.battery_drain import BatteryDrain
from fieldhand.forecast.failsafe_state import FailsafeForecast, FailsafeState
from fieldhand.forecast.resource_limits import reserve_percent, resource_limits
from fieldhand.forecast.route_cost import mean_metres, overrun_chances, route_cost
from fieldhand.robot.model import RobotProfile
from fieldhand.task.frames import Task

#: Chance of running short from which going on is worse than a coin toss.
EVEN = 0.5

#: A battery that empties this many times as fast as its model is no battery to take chances with.
ABNORMAL = 1.2

#: Turning round is safer where it is less likely to run short by so much, or takes no more than this part.
_LESS_LIKELY, _LESS = 0.02, 0.8


class BudgetFailsafe:
    """Implements :class:`fieldhand.execution.guard.Failsafe`.

    Args:
        task, robot: The mission.
        drain: Battery drain; learned at each call.
    """

    def __init__(self, task: Task, robot: RobotProfile, drain: BatteryDrain) -> None:
        self._task, self._model, self._drain = task, robot, drain
        reserve = reserve_percent(task.constraints, robot)
        self._stop_percent = robot.energy.levels(reserve).stop

    def learn(self, now: FailsafeState) -> None:
        """Learn how fast the battery empties."""
        self._drain.learn(now.spent)

    def foresee(self, now: FailsafeState) -> FailsafeForecast:
        """Return whether the mission may continue as it does; the battery's drain is learned first."""
        self.learn(now)
        return self._homeward(now, now.on_m) if now.returning else self._outward(now)

    def _outward(self, now: FailsafeState) -> FailsafeForecast:
        """Compare going on and then home with going home at once, for each limit."""
        robot = self._drain.robot
        resources = resource_limits(self._task.constraints, robot, now.charge_percent + now.spent.percent)
        on, home = route_cost([now.on_m, now.after_m], now.work), route_cost([now.home_m])
        chances = overrun_chances(on, resources, robot, now.spent)
        at_once = overrun_chances(home, resources, robot, now.spent)
        accepted = np.array([r.failure_probability for r in resources])
        drains = np.array([r.kind in ("reserve", "energy_percent") for r in resources])
        most = np.where(drains & (self._drain.factor >= ABNORMAL), accepted, np.maximum(EVEN, accepted))
        needs_on, needs_home = mean_metres(on, resources, robot), mean_metres(home, resources, robot)
        safer = (at_once < chances - _LESS_LIKELY) | (needs_home < _LESS * needs_on)
        risky = (chances > most) & safer
        # Where not even the charge above the stop level lasts for the way home, nothing is gained by going on.
        charge = self._homeward(now, now.home_m)
        risky[-1] |= charge.alarm == "out_of_reach" and needs_home[-1] < needs_on[-1]
        if not risky.any():
            return FailsafeForecast(drain=self._drain.factor)
        worst = int(np.where(risky, chances, -1.0).argmax())
        resource = resources[worst]
        return FailsafeForecast(
            alarm="turn_home",
            limit=resource.kind,
            left=resource.limit - resource.used(now.spent),
            needed=float(needs_home[worst]) * resource.per_metre,
            chance_short=float(chances[worst]),
            drain=self._drain.factor,
        )

    def _homeward(self, now: FailsafeState, metres: float) -> FailsafeForecast:
        """Compare the energy for the way home with the charge above the stop level."""
        robot = self._drain.robot
        per_metre = resource_limits(self._task.constraints, robot)[-1].per_metre
        left = now.charge_percent - self._stop_percent
        needed = metres * per_metre
        return FailsafeForecast(
            alarm="out_of_reach" if needed > left else "none",
            left=left,
            needed=needed,
            chance_short=1.0 if needed > left else 0.0,
            reach_m=max(0.0, left) / per_metre,
            drain=self._drain.factor,
        )
