"""What a mission uses along a walk, as a distribution: many missions at once, each with its own luck."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast.state import Work
from fieldhand.orienteering.costs import CostModel

if TYPE_CHECKING:
    from fieldhand.orienteering.preview import Preview

Floats = NDArray[np.float64]

#: Missions that are drawn.
DRAWS = 2000


@dataclass(frozen=True, kw_only=True, eq=False)
class Used:
    """What each of some missions uses, shape (missions,) each.

    Attributes:
        metres: What the legs cost.
        seconds, joules: Of actions.
    """

    metres: Floats
    seconds: Floats
    joules: Floats


class Drawn:
    """Missions along one walk.

    Args:
        costs: What a leg of length 1 costs.
        seed: Of what the legs cost.
    """

    def __init__(self, costs: CostModel, seed: int) -> None:
        self._costs, self.seed, self._rng = costs, seed, np.random.default_rng(seed)
        self.metres, self._seconds, self._joules = np.zeros(DRAWS), np.zeros(DRAWS), np.zeros(DRAWS)
        self._leaving: Floats | None = None

    @property
    def used(self) -> Used:
        """So far."""
        return Used(metres=self.metres, seconds=self._seconds, joules=self._joules)

    def drive(self, metres: float) -> None:
        """All of them drive a leg; the one after optional visits begins where each mission made its last."""
        if self._leaving is not None:
            self.metres = self.metres + self._leaving
            self._leaving = None
        else:
            self.metres = self.metres + metres * self._costs.draw(self._rng, DRAWS)

    def work(self, work: Work) -> None:
        """All of them do some work."""
        self._seconds, self._joules = self._seconds + work.seconds, self._joules + work.joules

    def visit(self, preview: Preview, works: Sequence[Work]) -> None:
        """Each makes its optional visits, with the work at each of them; the preview's vertices count from 1."""
        each = [works[vertex - 1] for vertex in preview.vertices.tolist()]
        self.metres = self.metres + preview.legs + preview.visited @ np.array([w.metres for w in each])
        self._seconds = self._seconds + preview.visited @ np.array([w.seconds for w in each])
        self._joules = self._joules + preview.visited @ np.array([w.joules for w in each])
        self._leaving = preview.last
