"""Protocol of a solver that is prepared once for a problem and then decides in any number of missions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from fieldhand.orienteering.policy import State

#: Returns the next vertex of a mission.
NextVertex = Callable[[State], int]


class PreparedSolver(Protocol):
    """A solver prepared for one problem. It must be picklable, because missions are simulated in other processes."""

    def mission(self, seed: int) -> NextVertex:
        """Return the decision function of a new mission, independent of earlier missions.

        Args:
            seed: Seed of all random choices in the mission's decisions.
        """
        ...
