"""One request planned once and flown many times: what was forecast against what happened."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np
from numpy.typing import NDArray

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning
from fieldhand.forecast.branch_estimate import BranchEstimate, Figure
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task
from fieldhand.task.results import Ended
from fieldhand_bench.orienteering.run import wilson
from fieldhand_bench.referee import judge

Floats = NDArray[np.float64]

_APPROVED_AT = datetime(2026, 1, 1, tzinfo=UTC)
_BY_CHANCE = 0.025


@dataclass(frozen=True, kw_only=True)
class Mission:
    """One of the missions. It can be sent to another process.

    Attributes:
        seed: Of the simulation and the guard.
        exceeded: Limits that were exceeded.
        visits: Optional visits that were made.
        metres, seconds, percent: Driven, taken, and used of the battery.
        cpu_s: Processor time of the mission.
    """

    seed: int
    exceeded: tuple[str, ...]
    visits: int
    metres: float
    seconds: float
    percent: float
    cpu_s: float


@dataclass(frozen=True, kw_only=True)
class Compared:
    """Missions against their forecast.

    Attributes:
        accepted, forecast: The chance of exceeding the limit that is forecast to be likeliest exceeded, and what is
            accepted of it.
        missions, failures: Flown, and those that exceeded any limit.
        interval: Of the observed chance, 95 % (Wilson).
        visits_forecast, visits, visits_spread: Mean, mean and standard deviation.
        kept: Visits of missions within all limits, over all missions.
        within: For metres, seconds and percent the parts of the missions within the forecast median and within its
            90th percentile.
        review_s, mission_s: Processor time of checks and forecast, and of a mission on average.
        warnings: That approval asks to confirm.
    """

    accepted: float
    forecast: float
    missions: int
    failures: int
    interval: tuple[float, float]
    visits_forecast: float
    visits: float
    visits_spread: float
    kept: float
    within: tuple[tuple[str, float, float], ...]
    review_s: float
    mission_s: float
    warnings: tuple[str, ...]

    @property
    def is_kept(self) -> bool:
        """Return True if there were no more failures than chance explains where each has the accepted one."""
        from scipy.stats import binom

        return self.failures <= int(binom.ppf(1.0 - _BY_CHANCE, self.missions, self.accepted))

    @property
    def agrees(self) -> bool:
        """Return True if the forecast chance lies within the interval of the observed one."""
        return self.interval[0] <= self.forecast <= self.interval[1]


def compare(
    task: Task,
    site: Site,
    robot: RobotProfile,
    seeds: Sequence[int],
    *,
    jobs: int = 1,
    tell: Callable[[Mission], None] = lambda _: None,
) -> Compared:
    """Forecast a mission, fly it with each seed, and compare.

    Args:
        task, site, robot: The mission; its warnings count as confirmed.
        seeds: Of the missions.
        jobs: Processes; -1 for one on each processor.
        tell: Called with each mission that is over.

    Raises:
        NotApprovedError: A check fails.
    """
    began = time.process_time()
    found = mission.review(task, site, robot)
    review_s = time.process_time() - began
    flown = []
    for one in fly_again(task, site, robot, seeds, jobs=jobs):
        tell(one)
        flown.append(one)
    assert found.estimate is not None  # noqa: S101  a mission that was approved has one
    return summarized(found.estimate.worst, flown, review_s=review_s, warnings=found.warnings)


def fly_again(task: Task, site: Site, robot: RobotProfile, seeds: Sequence[int], *, jobs: int = 1) -> Iterator[Mission]:
    """Fly a mission with each seed; each as it is done, in their order.

    Raises:
        NotApprovedError: A check fails.
    """
    from joblib import Parallel, delayed

    approved = mission.authorize(
        mission.review(task, site, robot), by="the experiment", at=_APPROVED_AT, confirmed=EveryWarning()
    )

    def fly(seed: int) -> Mission:
        began = time.process_time()
        events = mission.simulate(approved, seed=seed).events
        ruling, ended = judge(task, site, robot, events), events[-1]
        assert isinstance(ended, Ended)  # noqa: S101  a simulated mission ends
        return Mission(
            seed=seed,
            exceeded=ruling.exceeded,
            visits=ruling.visits,
            metres=ended.travelled_m,
            seconds=ended.t,
            percent=100.0 - ended.charge_percent,
            cpu_s=time.process_time() - began,
        )

    yield from Parallel(n_jobs=jobs, return_as="generator")(delayed(fly)(seed) for seed in seeds)


def summarized(
    worst: BranchEstimate, flown: Sequence[Mission], *, review_s: float, warnings: tuple[str, ...]
) -> Compared:
    """Return missions against the branch that was forecast as the worst."""
    limit = max(worst.chances, key=lambda c: c.chance - c.accepted)
    visits = np.array([m.visits for m in flown], dtype=np.float64)
    failed = np.array([bool(m.exceeded) for m in flown])
    used: list[tuple[str, Figure, Floats]] = [
        ("metres", worst.metres, np.array([m.metres for m in flown])),
        ("seconds", worst.seconds, np.array([m.seconds for m in flown])),
        ("percent", worst.percent, np.array([m.percent for m in flown])),
    ]
    return Compared(
        accepted=limit.accepted,
        forecast=limit.chance,
        missions=len(flown),
        failures=int(failed.sum()),
        interval=wilson(float(failed.mean()), len(flown)),
        visits_forecast=worst.visits,
        visits=float(visits.mean()),
        visits_spread=float(visits.std()),
        kept=float(np.where(failed, 0.0, visits).mean()),
        within=tuple(
            (name, float((values <= figure.p50).mean()), float((values <= figure.p90).mean()))
            for name, figure, values in used
        ),
        review_s=review_s,
        mission_s=float(np.mean([m.cpu_s for m in flown])),
        warnings=warnings,
    )
