"""Sampled costs of a walk: many missions at once, each with independent leg costs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast.mission_state import Work
from fieldhand.orienteering.costs import CostModel

if TYPE_CHECKING:
    from fieldhand.forecast.charged_visits import ChargedVisits
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
        stranding: Probability of falling to the stop level on the way to the charger or home, given all costs but that
            of the last leg.
        charged_to: Highest charge in percent up to which the plan was interrupted to charge; 0 if it was not.
    """

    charges: Floats
    docked_s: Floats
    left: Floats
    lowest: Floats
    stranding: Floats
    charged_to: Floats


@dataclass(frozen=True, kw_only=True, eq=False)
class SampledUse:
    """Resources used by each sampled mission, shape (missions,) each.

    Attributes:
        metres: Cost of the legs in metres.
        seconds, joules: Time and energy of actions and charging, without driving and idle power; with the time of
            waits, and that by which slower drives exceed the mission's speed.
        charging: What was charged; None for missions that do not recharge.
    """

    metres: Floats
    seconds: Floats
    joules: Floats
    charging: SampledCharging | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class SampledVisits:
    """The optional visits of each sampled mission, with the work at each candidate place.

    Attributes:
        slower_s_per_m: Seconds per metre that the drives take beyond those of the mission's speed.
        charged: The missions after their visits, with what they charged in between; None if they do not recharge.
    """

    preview: Preview
    works: tuple[Work, ...]
    slower_s_per_m: float = 0.0
    charged: ChargedVisits | None = None

    @property
    def work(self) -> tuple[Floats, Floats, Floats]:
        """Return metres, seconds and joules of the work at the visited places for each mission."""
        each = [self.works[vertex - 1] for vertex in self.preview.vertices.tolist()]
        visited: Floats = self.preview.visited.astype(np.float64)
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
        self._slower = 0.0
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

    def leg(self, number: int, *, detour: int = 0) -> Floats:
        """Return the cost of a leg of 1 m for each mission, by its number on the walk; others for its detours."""
        rng = np.random.default_rng([self.seed, 1 + detour, number])
        return self._leg_costs.costs.draw(rng, self.draws)

    @property
    def metres(self) -> Floats:
        """Return the cost of the legs so far for each mission in metres, shape (missions,)."""
        if self._pending:
            self._add(self._leg_costs.cost(self._legs, tuple(self._pending)), self._slower)
            self._legs, self._pending = self._legs + len(self._pending), []
        return self._metres

    def _add(self, cost: Floats, slower_s_per_m: float) -> None:
        self._metres = self._metres + cost
        if slower_s_per_m:
            self._seconds = self._seconds + cost * slower_s_per_m

    @property
    def used(self) -> SampledUse:
        """Return the resources used so far."""
        none, metres = np.zeros(self._leg_costs.draws), self.metres
        return SampledUse(
            metres=metres,
            seconds=none + (self._work.seconds + self._seconds),
            joules=none + (self._work.joules + self._joules),
        )

    def drive(self, metres: float, slower_s_per_m: float = 0.0) -> None:
        """Add a leg for all missions; after optional visits it begins at each mission's last visit.

        Args:
            metres: Length of the leg.
            slower_s_per_m: Seconds per metre that the leg takes beyond those of the mission's speed.
        """
        if slower_s_per_m != self._slower:
            _ = self.metres  # the legs before it were driven at another speed
            self._slower = slower_s_per_m
        if self._leaving is not None:
            _ = self.metres
            self._add(self._leaving, slower_s_per_m)
            self._leaving = None
        else:
            self._pending.append(metres)

    def work(self, work: Work) -> None:
        """Add work for all missions; the metres driven in it are not random."""
        self._work = self._work + Work(seconds=work.seconds, joules=work.joules)
        self._metres = self._metres + work.metres

    def visit(self, visits: SampledVisits) -> None:
        """Add each mission's optional visits with their work; the preview's vertices are numbered from 1."""
        metres, seconds, joules = visits.work
        _ = self.metres
        self._add(visits.preview.legs + metres, visits.slower_s_per_m)
        self._seconds = self._seconds + seconds
        self._joules = self._joules + joules
        self._leaving = visits.preview.last
