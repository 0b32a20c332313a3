"""The overrun probability accepted for one visit where the mandatory work exceeds the budget.

The robot makes one visit after another as long as driving to the next one and straight home runs short with at most a
certain probability. Each visit takes that risk again, so the probability per visit must be lower than the one accepted
for the whole mission. It is found by simulating many missions.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast.mission_state import Visit
from fieldhand.forecast.risk_allowance import OPTIONAL_SHARE
from fieldhand.orienteering.costs import CostModel
from fieldhand.orienteering.overrun import quantile_table, standardised_quantile
from fieldhand.site.model import Place

Floats = NDArray[np.float64]

_DRAWS = 2000
#: Multiples of the accepted probability that are tried. Few missions come to a visit that is riskier than what is
#: accepted for all of them, so such a visit may be made.
_PARTS = np.geomspace(5.0, 0.02, 34)
#: Highest probability accepted for one visit: beyond it, going on fails more often than not.
_EVEN = 0.5
#: Number of visits before the first one out of reach for which the way home is computed.
_LOOKED_AT = 200
#: Distance beyond which no robot comes, as a multiple of the metres left.
_FARTHEST = 2.0


@dataclass(frozen=True, kw_only=True, eq=False)
class VisitRisk:
    """The situation in which the accepted probability of a visit is computed.

    Attributes:
        here: The robot's place.
        stops: Mandatory visits in their order.
        length: Function that returns the driving distance between two places in metres.
        home: Function that returns the home place for a place.
        service: Work at each stop as equivalent metres of driving, shape (stops, limits).
        left: Metres left of each limit, shape (limits,).
        costs: Cost model of a leg of length 1.
    """

    here: Place
    stops: Sequence[Visit]
    length: Callable[[Place, Place], float]
    home: Callable[[Place], Place]
    service: Floats
    left: Floats
    costs: CostModel

    def accepted_chance(self, accepted: Floats, rng: np.random.Generator) -> Floats:
        """Return for each limit the highest overrun probability accepted for one visit and the way home.

        Args:
            accepted: For each limit the probability accepted for the whole mission.
            rng: Random generator of the simulated missions.
        """
        legs, homes = self._lengths()
        factors = np.maximum(self.costs.draw(rng, _DRAWS * (2 * len(legs))), 0.0).reshape(2, len(legs), _DRAWS)
        for part in _PARTS:
            chances = np.minimum(part * accepted, np.maximum(_EVEN, accepted))
            failed = self._failed(chances, legs, homes, factors)
            if (failed <= (1.0 - OPTIONAL_SHARE) * accepted).all():
                return np.asarray(chances)
        return np.asarray(_PARTS[-1] * accepted)

    def _lengths(self) -> tuple[Floats, Floats]:
        """Return the metres to each stop within reach and home from it; 0 if the way home is not needed."""
        legs: list[float] = []
        driven, at = 0.0, self.here
        for stop, work in zip(self.stops, self.service, strict=True):
            legs.append(self.length(at, stop.place))
            driven, at = driven + legs[-1] + float(work.min()), stop.end
            if driven > _FARTHEST * float(self.left.max()):
                break
        homes = np.zeros(len(legs))
        for k in range(max(0, len(legs) - _LOOKED_AT), len(legs)):
            end = self.stops[k].end
            homes[k] = self.length(end, self.home(end))
        return np.array(legs), homes

    def _failed(self, chances: Floats, legs: Floats, homes: Floats, factors: Floats) -> Floats:
        """Return for each limit the fraction of missions that run short if each visit keeps to these probabilities."""
        left = np.repeat(self.left[None, :], _DRAWS, axis=0)
        under_way = np.ones(_DRAWS, dtype=bool)
        failed = np.zeros((_DRAWS, len(self.left)), dtype=bool)
        tables = [quantile_table(float(chance)) for chance in chances]
        second, third = self.costs.cumulants()
        was_home = self.length(self.here, self.home(self.here))
        for k, (leg, home) in enumerate(zip(legs, homes, strict=True)):
            variance, cubes = second * (leg**2 + home**2), third * (leg**3 + home**3)
            needs = [leg + home + np.sqrt(variance) * standardised_quantile(t, variance, cubes) for t in tables]
            goes = under_way & (left - self.service[k] >= np.array(needs)).all(axis=1)
            turns = under_way & ~goes
            failed[turns] = left[turns] - (was_home * factors[1, k, turns])[:, None] < 0.0
            left[goes] -= (leg * factors[0, k, goes])[:, None] + self.service[k]
            under_way, was_home = goes, home
        failed[under_way] = left[under_way] - (was_home * factors[1, -1, under_way])[:, None] < 0.0
        return np.asarray(failed.mean(axis=0))
