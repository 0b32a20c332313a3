"""Predict, while the robot drives and works, whether each limit still allows the way home.

The budget guard decides before each drive, and its decision holds until the next one. In between, the battery may start
to empty faster, or a leg may turn out longer than expected. As soon as going on would more likely than not exceed a
limit, and turning round is safer, the failsafe requests that the current drive or capture be aborted. If the battery
empties faster than its model predicts, the threshold is the accepted probability instead. docs/faults.md gives the
rules.
"""

from __future__ import annotations

import numpy as np

from fieldhand.evaluation.battery_drain import BatteryDrain
from fieldhand.forecast.failsafe_state import FailsafeForecast, FailsafeState
from fieldhand.forecast.resource_limits import reserve_percent, resource_limits
from fieldhand.forecast.route_cost import mean_metres, overrun_chances, route_cost
from fieldhand.forecast.turning_back import TurningRule
from fieldhand.robot.model import RobotProfile
from fieldhand.task.frames import Task

#: Probability of running short above which going on is more likely to fail than to succeed.
EVEN = 0.5

#: Drain relative to the model from which the battery counts as abnormal, so that only the accepted probability is
#: risked.
ABNORMAL = 1.2

#: Turning round counts as safer if its probability of running short is lower by at least the first value, or if it
#: needs no more than the second value as a fraction of what going on needs.
_LESS_LIKELY, _LESS = 0.02, 0.8


class BudgetFailsafe:
    """A battery and budget failsafe (:class:`fieldhand.execution.guard.Failsafe`) for one mission.

    It compares going on with going home at once, from the charge and the distances at each poll. docs/faults.md gives
    its rules.

    Args:
        task, robot: Task and robot of the mission.
        drain: Battery drain relative to its model; updated at each call, and shared with the budget guard.
    """

    def __init__(self, task: Task, robot: RobotProfile, drain: BatteryDrain) -> None:
        self._task, self._model, self._drain = task, robot, drain
        reserve = reserve_percent(task.constraints, robot)
        self._stop_percent = robot.energy.levels(reserve).stop

    def learn(self, now: FailsafeState) -> None:
        """Update the battery drain from the resources spent."""
        self._drain.learn(now.spent)

    def foresee(self, now: FailsafeState) -> FailsafeForecast:
        """Update the battery drain and return the forecast, with an alarm if the robot should turn home."""
        self.learn(now)
        return self._homeward(now, now.on_m) if now.returning else self._outward(now)

    def _outward(self, now: FailsafeState) -> FailsafeForecast:
        """Compare going on and then home with going home at once, for each limit."""
        robot = self._drain.robot
        resources = resource_limits(self._task.constraints, robot, now.charge_percent + now.spent.percent)
        on, home = route_cost([now.on_m, now.after_m], now.work), route_cost([now.home_m])
        chances = overrun_chances(on, resources, robot, now.spent)
        at_once = overrun_chances(home, resources, robot, now.spent)
        needs_on, needs_home = mean_metres(on, resources, robot), mean_metres(home, resources, robot)
        if now.haven_m < now.home_m or now.haven_after_m < now.after_m:
            # The charge need only last to the charger; the budgets are for the whole way home.
            on, home = route_cost([now.on_m, now.haven_after_m], now.work), route_cost([now.haven_m])
            charge = resources[-1:]
            chances[-1:] = overrun_chances(on, charge, robot, now.spent)
            at_once[-1:] = overrun_chances(home, charge, robot, now.spent)
            needs_on[-1:], needs_home[-1:] = mean_metres(on, charge, robot), mean_metres(home, charge, robot)
        accepted = np.array([r.failure_probability for r in resources])
        drains = np.array([r.kind in ("reserve", "energy_percent") for r in resources])
        most = np.where(drains & (self._drain.factor >= ABNORMAL), accepted, np.maximum(EVEN, accepted))
        safer = (at_once < chances - _LESS_LIKELY) | (needs_home < _LESS * needs_on)
        risky = (chances > most) & safer
        # If even the charge above the stop level does not last for the way home, going on gains nothing.
        out_of_reach = self._homeward(now, now.haven_m)
        risky[-1] |= out_of_reach.alarm == "out_of_reach" and needs_home[-1] < needs_on[-1]
        if not risky.any():
            return self._costly(now)
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

    def _costly(self, now: FailsafeState) -> FailsafeForecast:
        """Raise the alarm if the drive has become so costly that the charger might be out of reach from its end."""
        robot, rule = self._drain.robot, TurningRule(self._drain.robot)
        none = FailsafeForecast(drain=self._drain.factor)
        if now.turns is None or now.on_m <= 0.0:
            return none
        per_metre = resource_limits(self._task.constraints, robot)[-1].per_metre
        left = now.charge_percent - self._stop_percent - robot.percent(0.0, now.work.seconds)
        left_m = left / per_metre
        if not rule.turns(left_m, now.driven_m, now.done_m, now.on_m, now.charger_after_m, now.charger_m, now.turns):
            return none
        then_m = left_m - float(rule.pace(now.driven_m, now.done_m)) * now.on_m
        return FailsafeForecast(
            alarm="turn_back",
            left=then_m * per_metre,
            needed=now.charger_after_m * per_metre,
            chance_short=float(rule.stop_chance(then_m, now.charger_after_m)),
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
