"""Protocol of a solver that is prepared for a problem and then decides in any number of missions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from fieldhand.orienteering.policy import State

#: Returns the next vertex of a mission.
Decide = Callable[[State], int]


class PreparedSolver(Protocol):
    """A solver that has been prepared for a problem. It must be picklable: missions are driven in other processes."""

    def mission(self, seed: int) -> Decide:
        """Return the decisions of one mission, which does not depend on the missions before it.

        Args:
            seed: Seed of everything that is random in the mission's decisions.
        """
        ...
