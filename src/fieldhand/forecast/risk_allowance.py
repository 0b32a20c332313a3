"""The accepted failure probability of a mission, shared between mandatory work and optional visits.

Mandatory work comes first: the probability that it alone runs short is subtracted from the probability that the Task
accepts. The remainder may be spent on optional visits. Each run of them (a for-each, an optional step) may raise the
current overrun probability of the whole mission by at most its share. Each such increase is an expectation over all
future leg costs, so the overrun probability of the mission is at most that of the mandatory work plus the sum of the
increases, whatever the actual costs during each run.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

#: Fraction of the accepted probability that optional visits may use if mandatory work alone exceeds it; mandatory work
#: is then held to the remainder.
OPTIONAL_SHARE = 0.1


@dataclass(frozen=True, kw_only=True)
class RiskAllowance:
    """The probability of running short that optional visits may still add to a mission.

    Attributes:
        accepted: For each limit the overrun probability that the Task accepts.
        left: For each limit the probability that may still be added.
        mandatory_fits: True if the mandatory work kept to the accepted probability when first checked.
    """

    accepted: tuple[float, ...]
    left: tuple[float, ...]
    mandatory_fits: bool

    @staticmethod
    def at_start(accepted: Sequence[float], mandatory: Floats) -> RiskAllowance:
        """Return the allowance at the beginning of a mission.

        Args:
            accepted: For each limit the accepted overrun probability.
            mandatory: For each limit the overrun probability of the mandatory work alone.
        """
        bound = np.asarray(accepted, dtype=np.float64)
        lasts = bool((mandatory <= bound * (1 + 1e-9)).all())
        left = np.maximum(bound - mandatory, 0.0) if lasts else OPTIONAL_SHARE * bound
        return RiskAllowance(accepted=tuple(bound.tolist()), left=tuple(left.tolist()), mandatory_fits=lasts)

    def share(self, runs: int) -> float:
        """Return the probability that the next of ``runs`` remaining runs of optional visits may add."""
        return min(self.left) / max(runs, 1)

    def reduced_by(self, added: float) -> RiskAllowance:
        """Return the allowance after a run that is expected to add a given probability."""
        return replace(self, left=tuple(max(0.0, x - max(0.0, added)) for x in self.left))
