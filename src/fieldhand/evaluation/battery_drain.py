"""The rate at which a battery empties compared with its model, learned during the mission."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast.mission_state import Spent
from fieldhand.language import Number, message
from fieldhand.robot.model import RobotProfile

#: Percent of the battery by the model. What is missing to that much evidence counts as spent by the model: a meter that
#: shows whole percents says little at the beginning.
LEAST = 2.0

#: Percent that the meter must have fallen over a span for its pace to count, and how many of the meter's steps: a
#: battery may go bad half-way, and then it empties fast.
SPAN, STEPS = 1.0, 3.0

#: What the battery takes beyond its model is taken for so much more.
CAUTION = 1.1

#: A factor that has changed by less than this part is the same.
_SAME = 0.01

#: So many readings are kept; when there are more, every other one of them goes.
_KEPT = 256


class BatteryDrain:
    """Learns the drain of a battery relative to its model.

    Args:
        robot: With the model, as its profile says it.

    Attributes:
        factor: How many times as fast as the model says; never below 1, for a battery that lasts longer is no reason to
            be bold.
        robot: The robot with a model that is as fast.
    """

    def __init__(self, robot: RobotProfile) -> None:
        self._model = self.robot = robot
        self.factor = 1.0
        self._seen: list[tuple[float, float]] = [(0.0, 0.0)]
        self._step = SPAN

    def learn(self, spent: Spent) -> None:
        """Look at what has been spent since the mission began.

        The faster of two paces counts: that of the whole mission, and that of the span up to now in which the meter
        fell fastest and far enough to be believed, less one step of the meter.
        """
        modelled = self._model.percent(spent.metres, spent.seconds, spent.joules)
        self._remember(modelled, spent.percent)
        pace = max(_damped(modelled, spent.percent), self._latest(modelled, spent.percent))
        factor = max(1.0, 1.0 + CAUTION * (pace - 1.0))
        if abs(factor - self.factor) > _SAME * self.factor:
            self.factor = factor
            energy = self._model.energy
            self.robot = replace(self._model, energy=replace(energy, capacity_j=energy.capacity_j / factor))

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
        """Return how much faster than its model the battery empties, in words; empty if it does not."""
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
