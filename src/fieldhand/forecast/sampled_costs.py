"""Sampled costs of a walk: many missions at once, each with independent leg costs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast.mission_state import Work
from fieldhand.orienteering.costs import CostModel

if TYPE_CHECKING:
    from fieldhand.orienteering.preview import Preview

Floats = NDArray[np.float64]

#: Default number of sampled missions.
DRAWS = 2000

#: Number of legs sampled at a time for all missions, so that they fit the processor cache.
_AT_A_TIME = 64


@dataclass(frozen=True, kw_only=True, eq=False)
class SampledCharging:
    """The charges of each sampled mission, shape (missions,) each.

    Attributes:
        charges: Number of charges.
        docked_s: Seconds at the charger, during which it supplies the robot.
        left: Charge in percent at the end.
        lowest: Lowest charge in percent on arrival at the charger or at the end.
    """

    charges: Floats
    docked_s: Floats
    left: Floats
    lowest: Floats


@dataclass(frozen=True, kw_only=True, eq=False)
class SampledUse:
    """Resources used by each sampled mission, shape (missions,) each.

    Attributes:
        metres: Cost of the legs in metres.
        seconds, joules: Time and energy of actions and charging, without driving and idle power.
        charging: What was charged; None for missions that do not recharge.
    """

    metres: Floats
    seconds: Floats
    joules: Floats
    charging: SampledCharging | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class SampledVisits:
    """The optional visits of each sampled mission, with the work at each candidate place."""

    preview: Preview
    works: tuple[Work, ...]

    @property
    def work(self) -> tuple[Floats, Floats, Floats]:
        """Return metres, seconds and joules of the work at the visited places for each mission."""
        each = [self.works[vertex - 1] for vertex in self.preview.vertices.tolist()]
        visited = self.preview.visited.astype(np.float64)
        return (
            visited @ np.array([w.metres for w in each], dtype=np.float64),
            visited @ np.array([w.seconds for w in each], dtype=np.float64),
            visited @ np.array([w.joules for w in each], dtype=np.float64),
        )


class LegCostSamples:
    """Sampled leg costs shared by all walks of a mission: equal legs cost the same on every branch.

    Common random numbers: differences between branches are not due to sampling, and common legs are sampled only once.

    Args:
        costs: Cost model of a leg of length 1.
        seed: Seed of the leg costs.
        draws: Number of missions.
    """

    def __init__(self, costs: CostModel, seed: int, draws: int = DRAWS) -> None:
        self.costs, self.seed, self.draws = costs, seed, draws
        self._known: dict[tuple[int, tuple[float, ...]], Floats] = {}

    def cost(self, first: int, legs: tuple[float, ...]) -> Floats:
        """Return the total cost of consecutive legs for each mission in metres, shape (missions,).

        Args:
            first: Number of preceding legs on the walk.
            legs: Their lengths in metres.
        """
        known = self._known.get((first, legs))
        if known is None:
            known = np.zeros(self.draws)
            rng = np.random.default_rng([self.seed, first])
            for k in range(0, len(legs), _AT_A_TIME):
                some = np.array(legs[k : k + _AT_A_TIME])
                known += some @ self.costs.draw(rng, len(some) * self.draws).reshape(len(some), self.draws)
            self._known[first, legs] = known
        return known


class MissionSamples:
    """Missions sampled along one walk.

    Args:
        leg_costs: Sampled costs of the legs.
    """

    def __init__(self, leg_costs: LegCostSamples) -> None:
        self._leg_costs, self._legs = leg_costs, 0
        self._pending: list[float] = []
        self._metres: Floats = np.zeros(leg_costs.draws)
        self._work = Work()
        self._seconds: Floats | float = 0.0
        self._joules: Floats | float = 0.0
        self._leaving: Floats | None = None

    @property
    def seed(self) -> int:
        """Return the seed."""
        return self._leg_costs.seed

    @property
    def draws(self) -> int:
        """Return the number of missions."""
        return self._leg_costs.draws

    def leg(self, number: int, *, detour: bool = False) -> Floats:
        """Return the cost of a leg of 1 m for each mission, by its number on the walk; another one for a detour."""
        rng = np.random.default_rng([self.seed, 1 + detour, number])
        return self._leg_costs.costs.draw(rng, self.draws)

    @property
    def metres(self) -> Floats:
        """Return the cost of the legs so far for each mission in metres, shape (missions,)."""
        if self._pending:
            self._metres = self._metres + self._leg_costs.cost(self._legs, tuple(self._pending))
            self._legs, self._pending = self._legs + len(self._pending), []
        return self._metres

    @property
    def used(self) -> SampledUse:
        """Return the resources used so far."""
        none = np.zeros(self._leg_costs.draws)
        return SampledUse(
            metres=self.metres,
            seconds=none + (self._work.seconds + self._seconds),
            joules=none + (self._work.joules + self._joules),
        )

    def drive(self, metres: float) -> None:
        """Add a leg for all missions; after optional visits it begins at each mission's last visit."""
        if self._leaving is not None:
            self._metres = self.metres + self._leaving
            self._leaving = None
        else:
            self._pending.append(metres)

    def work(self, work: Work) -> None:
        """Add work for all missions."""
        self._work = self._work + work

    def visit(self, preview: Preview, works: Sequence[Work]) -> None:
        """Add each mission's optional visits with their work; the preview's vertices are numbered from 1."""
        metres, seconds, joules = SampledVisits(preview=preview, works=tuple(works)).work
        self._metres = self.metres + preview.legs + metres
        self._seconds = self._seconds + seconds
        self._joules = self._joules + joules
        self._leaving = preview.last
