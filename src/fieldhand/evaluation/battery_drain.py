"""Battery drain relative to the battery model, learned during the mission."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast.mission_state import Spent
from fieldhand.language import Number, message
from fieldhand.robot.model import RobotProfile

#: Charge in percent that the model must predict as spent before the measured drain counts fully. Until then the
#: difference is taken as spent at the modelled rate, because a meter that shows whole percents is too coarse at the
#: beginning.
LEAST = 2.0

#: Percent, and number of meter steps, by which the charge must fall within a time span for the rate of that span to
#: count. Spans detect a battery that begins to fail half-way.
SPAN, STEPS = 1.0, 3.0

#: Safety factor on the drain in excess of the model.
CAUTION = 1.1

#: Relative change of the factor below which it is left unchanged.
_SAME = 0.01

#: Maximum number of readings kept; beyond it, every second one is discarded.
_KEPT = 256


class BatteryDrain:
    """The drain of a battery relative to its model, learned from the meter.

    Args:
        robot: Profile with the battery model.

    Attributes:
        factor: Measured drain divided by modelled drain; at least 1, so that a battery that lasts longer than modelled
            does not increase the budget.
        robot: Profile with the battery model scaled by the factor.
    """

    def __init__(self, robot: RobotProfile) -> None:
        self._model = self.robot = robot
        self.factor = 1.0
        self._last = Spent()
        #: What may still be counted as used while nobody looked, what was, and the model when somebody looked again.
        self._standing = self._stood = self._back_at = 0.0
        self._seen: list[tuple[float, float]] = [(0.0, 0.0)]
        self._step = SPAN

    def learn(self, spent: Spent) -> None:
        """Update the factor from what has been spent since the mission began.

        The larger of two rates counts: that of the whole mission, and the highest rate of any span up to now in which
        the charge fell far enough to be significant, less one step of the meter.
        """
        modelled = self._modelled(spent) + self._standing_percent(spent)
        self._remember(modelled, spent.percent)
        pace = max(_damped(modelled, spent.percent), self._latest(modelled, spent.percent))
        factor = max(1.0, 1.0 + CAUTION * (pace - 1.0))
        if abs(factor - self.factor) > _SAME * self.factor:
            self.factor = factor
            energy = self._model.energy
            self.robot = replace(self._model, energy=replace(energy, capacity_j=energy.capacity_j / factor))

    def _modelled(self, spent: Spent) -> float:
        return self._model.percent(spent.metres, spent.seconds - spent.docked_s, spent.joules)

    def _standing_percent(self, spent: Spent) -> float:
        """Return what the robot has used while the program was dead: no more than it uses standing, if it was on.

        The charge is read a moment later, so the fall counts until the model predicts :data:`SPAN` more.
        """
        if spent.absent_s > self._last.absent_s:
            self._standing = self._model.percent(0.0, spent.absent_s - self._last.absent_s)
            self._back_at = self._modelled(spent)
        elif self._standing and self._modelled(spent) > self._back_at + SPAN:
            self._standing = 0.0
        fallen = spent.percent - self._last.percent - (self._modelled(spent) - self._modelled(self._last))
        used = min(self._standing, max(0.0, fallen))
        self._standing, self._stood, self._last = self._standing - used, self._stood + used, spent
        return self._stood

    def _remember(self, modelled: float, spent: float) -> None:
        last_model, last_spent = self._seen[-1]
        if modelled <= last_model or spent <= last_spent:
            return
        self._step = min(self._step, spent - last_spent)
        self._seen.append((modelled, spent))
        if len(self._seen) > _KEPT:
            self._seen = [self._seen[0], *self._seen[2::2]]

    def _latest(self, modelled: float, spent: float) -> float:
        """Return the highest rate of the spans that end now."""
        seen: NDArray[np.float64] = np.array(self._seen)
        fallen, by_model = spent - seen[:, 1], modelled - seen[:, 0]
        long_enough = (fallen >= max(SPAN, STEPS * self._step)) & (by_model > 0.0)
        if not long_enough.any():
            return 0.0
        return float(((fallen - self._step)[long_enough] / by_model[long_enough]).max())

    @property
    def words(self) -> str:
        """Return how much faster than modelled the battery empties, in words; empty if it does not."""
        if self.factor < 1.05:
            return ""
        return message(
            "the battery empties {factor} times as fast as its model says",
            context="log",
            factor=Number(f"{self.factor:.1f}"),
        )


def _damped(modelled: float, spent: float) -> float:
    """Return the rate since the beginning, damped while there is little evidence."""
    missing = max(0.0, LEAST - modelled)
    return (spent + missing) / (modelled + missing)
