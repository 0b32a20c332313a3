"""Many simulations of one mission, over several processes: how often it succeeds, and what it takes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from fieldhand.mission.approve import ApprovedMission
from fieldhand.mission.execute import simulate
from fieldhand.mission.records import Records
from fieldhand.mission.seeds import checked_seed

if TYPE_CHECKING:
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.task.results import MissionStatus


#: Figures of a simulation that have quantiles.
SimulatedQuantity = Literal["travelled_m", "seconds", "charge_percent", "captures"]


@dataclass(frozen=True, kw_only=True)
class Simulation:
    """The figures of one simulation; :func:`simulate` with its seed gives its events.

    Attributes:
        seed: Seed of the simulation.
        status: Final status of the mission.
        success: True if every goal was met within every limit.
        goals_met, goals: Number of goals met, of all goals.
        exceeded: Names of the limits that were exceeded.
        captures: Number of captures that succeeded.
        travelled_m, seconds: Metres driven and seconds taken, the way home included.
        charge_percent: Charge at the end, in percent of a full battery.
    """

    seed: int
    status: MissionStatus
    success: bool
    goals_met: int
    goals: int
    exceeded: tuple[str, ...]
    captures: int
    travelled_m: float
    seconds: float
    charge_percent: float


class Simulations(Records[Simulation]):
    """Simulations of one mission, in the order of their seeds."""

    __slots__ = ()

    @property
    def success_rate(self) -> float:
        """Fraction of the simulations that succeeded; NaN if there is none."""
        return float(np.mean([run.success for run in self])) if self else float("nan")

    def quantiles(
        self,
        quantity: SimulatedQuantity,
        levels: tuple[float, ...] = (0.1, 0.5, 0.9),
    ) -> tuple[float, ...]:
        """Return quantiles of a figure over all simulations; NaN if there is none.

        Args:
            quantity: Name of the figure, a field of :class:`Simulation`.
            levels: Probabilities between 0 and 1.
        """
        values = [float(getattr(run, quantity)) for run in self]
        return tuple(float(q) for q in np.quantile(values, levels)) if values else (float("nan"),) * len(levels)

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {sum(run.success for run in self)} of {len(self)} succeeded>"

    def _repr_html_(self) -> str:
        """Return success rate and figures for a notebook."""
        from fieldhand.mission.notebook import html_of_simulations

        return html_of_simulations(self)


def fly_many(
    mission: ApprovedMission,
    seeds: int | Iterable[int] = 100,
    *,
    world: World | None = None,
    jobs: int = 1,
    client: Any = None,
) -> Simulations:
    """Simulate a mission once per seed; the result is the same for any number of processes.

    Args:
        mission: The approved mission.
        seeds: The seeds; a number n stands for 0 to n - 1.
        world: World of every simulation; by default nothing fails.
        jobs: Number of processes on this machine; -1 for one per processor.
        client: A ``dask.distributed.Client`` whose workers simulate, in place of processes here. They need the same
            version of Fieldhand.

    Raises:
        InputError: A seed is negative, or not a whole number.
        WorldError: The world does not fit the site or the robot.
    """
    chosen = range(seeds) if isinstance(seeds, int) else tuple(map(checked_seed, seeds))
    if client is not None:
        shared = client.scatter(mission, broadcast=True)
        futures = client.map(_simulated, chosen, mission=shared, world=world, pure=False)
        return Simulations(client.gather(futures))
    if jobs == 1:
        return Simulations(_simulated(seed, mission, world) for seed in chosen)
    from joblib import Parallel, delayed

    return Simulations(Parallel(n_jobs=jobs)(delayed(_simulated)(seed, mission, world) for seed in chosen))


def _simulated(seed: int, mission: ApprovedMission, world: World | None) -> Simulation:
    from fieldhand.task.results import Acted, Ended

    run = simulate(mission, world=world, seed=seed)
    ended = next(event for event in reversed(run.events) if isinstance(event, Ended))
    return Simulation(
        seed=seed,
        status=run.status,
        success=run.success,
        goals_met=sum(outcome.outcome == "success" for outcome in run.outcomes),
        goals=len(run.outcomes),
        exceeded=tuple(limit.kind for limit in run.assessment.exceeded),
        captures=sum(isinstance(event, Acted) and event.status == "success" for event in run.events),
        travelled_m=ended.travelled_m,
        seconds=ended.t,
        charge_percent=ended.charge_percent,
    )
