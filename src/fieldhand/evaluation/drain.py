"""How much faster than its model says a battery empties, learned from what has been spent."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.forecast.state import Spent
from fieldhand.robot.model import RobotProfile

#: Percent of the battery by the model. What is missing to that much evidence counts as spent by the model: a meter that
#: shows whole percents says little at the beginning.
LEAST = 2.0

#: Percent by the model over which the latest pace is measured: a battery may go bad half-way.
RECENT = 4.0

#: What the battery takes beyond its model is taken for so much more.
CAUTION = 1.1

#: A factor that has changed by less than this part is the same.
_SAME = 0.01


class Drain:
    """Compares a battery with its model.

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

    def learn(self, spent: Spent) -> None:
        """Look at what has been spent since the mission began; the faster of the whole and its latest part counts."""
        modelled = self._model.percent(spent.metres, spent.seconds, spent.joules)
        if modelled > self._seen[-1][0]:
            self._seen.append((modelled, spent.percent))
        while len(self._seen) > 2 and modelled - self._seen[1][0] >= RECENT:
            self._seen.pop(0)
        before_model, before_spent = self._seen[0]
        pace = max(_pace(modelled, spent.percent), _pace(modelled - before_model, spent.percent - before_spent))
        factor = max(1.0, 1.0 + CAUTION * (pace - 1.0))
        if abs(factor - self.factor) > _SAME * self.factor:
            self.factor = factor
            energy = self._model.energy
            self.robot = replace(self._model, energy=replace(energy, capacity_j=energy.capacity_j / factor))

    def __str__(self) -> str:
        return f"the battery empties {self.factor:.1f} times as fast as its model says" if self.factor >= 1.05 else ""


def _pace(modelled: float, spent: float) -> float:
    missing = max(0.0, LEAST - modelled)
    return (spent + missing) / (modelled + missing)
