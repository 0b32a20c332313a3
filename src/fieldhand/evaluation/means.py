"""What a mission has, what ways take of it, and how much chance of running short is still to be given away."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast.allowance import Allowance
from fieldhand.forecast.distances import Distances
from fieldhand.forecast.limits import Resource, resources_of
from fieldhand.forecast.rest import Rest, rest_after
from fieldhand.forecast.state import MissionState, Visit
from fieldhand.forecast.ways import Way, chances_short
from fieldhand.robot.model import RobotProfile
from fieldhand.site.context import Context
from fieldhand.site.model import Place, Site
from fieldhand.task.build import exit_of
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

Floats = NDArray[np.float64]


class Means:
    """The means of one mission.

    Args:
        task, site, robot: The mission.
        drives: The ways of the site.
        charge_percent: Charge at the beginning.

    Attributes:
        accepted: For each limit the chance of running short that the Task accepts.
        distances: Between places, asked for once.
    """

    def __init__(self, task: Task, site: Site, robot: RobotProfile, drives: Drives, charge_percent: float) -> None:
        self.task, self.site, self.robot, self.drives = task, site, robot, drives
        limits = resources_of(task.constraints, robot, charge_percent)
        self.accepted: Floats = np.array([r.failure_probability for r in limits])
        self.distances = Distances(drives)
        self._allowance: Allowance | None = None

    def allowance(self, mandatory: Floats) -> Allowance:
        """What may still be added to the chance of running short.

        Args:
            mandatory: For each limit the chance that what must be done runs short; only the first answer counts.
        """
        if self._allowance is None:
            self._allowance = Allowance.before(self.accepted.tolist(), mandatory)
        return self._allowance

    def add(self, chance: float) -> None:
        """Take what a run of optional visits is expected to add off the allowance."""
        if self._allowance is not None:
            self._allowance = self._allowance.less(chance)

    def resources(self, state: MissionState) -> tuple[Resource, ...]:
        """The limits as they are now: the battery is asked what is left in it, not what should be."""
        charge = state.charge_percent + state.spent.percent
        return resources_of(self.task.constraints, self.robot, charge)

    def chances(self, way: Way, state: MissionState) -> Floats:
        """For each limit the chance that a way takes more than is left."""
        return chances_short(way, self.resources(state), self.robot, state.spent)

    def length(self, a: Place, b: Place) -> float:
        """Metres of the drive between two places.

        Raises:
            DriveFault: There is no way.
        """
        return 0.0 if a.xy == b.xy else self.drives.between(a, b).length_m

    def home(self, at: Place) -> Place:
        """Where the robot goes when little is left; it stays where there is no way to that (approval warned of it)."""
        home = self.site.home(exit_of(self.task, "low_budget"), at)
        return home if self.distances.linked(at, home) else at

    def rest(self, node: str, context: Context, rounds: Mapping[str, int], to_come: Sequence[Visit] = ()) -> Rest:
        """What must be done after a node (:func:`fieldhand.forecast.rest.rest_after`)."""
        return rest_after(self.task, self.site, self.robot, self.drives, node, context, to_come=to_come, rounds=rounds)
