"""The accepted failure probability of a mission, shared between mandatory work and optional visits.

What must be done comes first: the chance that it alone runs short is taken off what the Task accepts. The rest may be
spent on optional visits. Each run of them (a for-each, an optional step) may raise the chance of the whole mission, as
it stands then, by its share at most. Such a rise is an expectation over all that may still happen; so the chance of
the mission is at most that of what must be done and all the rises together, whatever luck each run meets with.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

#: What optional visits may take of the accepted chance where what must be done needs more than all of it; the rest is
#: what must be done held to.
OPTIONAL_SHARE = 0.1


@dataclass(frozen=True, kw_only=True)
class RiskAllowance:
    """The probability of running short that optional visits may still add to a mission.

    Attributes:
        accepted: For each limit the chance that the Task accepts.
        left: For each limit what may still be added.
        mandatory_fits: True if the mandatory work kept to the accepted probability when first checked.
    """

    accepted: tuple[float, ...]
    left: tuple[float, ...]
    mandatory_fits: bool

    @staticmethod
    def at_start(accepted: Sequence[float], mandatory: Floats) -> RiskAllowance:
        """Return the allowance at the beginning of a mission.

        Args:
            accepted: For each limit.
            mandatory: For each limit the chance that what must be done runs short of it.
        """
        bound = np.asarray(accepted, dtype=np.float64)
        lasts = bool((mandatory <= bound * (1 + 1e-9)).all())
        left = np.maximum(bound - mandatory, 0.0) if lasts else OPTIONAL_SHARE * bound
        return RiskAllowance(accepted=tuple(bound.tolist()), left=tuple(left.tolist()), mandatory_fits=lasts)

    def share(self, runs: int) -> float:
        """Return what the next of some runs of optional visits may add."""
        return min(self.left) / max(runs, 1)

    def reduced_by(self, added: float) -> RiskAllowance:
        """Return the allowance after a run that is expected to add a given probability."""
        return replace(self, left=tuple(max(0.0, x - max(0.0, added)) for x in self.left))
