"""Simulate one mission many times and compare the results with its forecast."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime

import numpy as np
from numpy.typing import NDArray

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning
from fieldhand.compatibility import UTC
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
    """The result of one simulated mission. It can be sent to another process.

    Attributes:
        seed: Random seed of the simulation and the guard.
        exceeded: Kinds of the limits that were exceeded.
        visits: Number of completed optional visits.
        metres, seconds, percent: Distance driven, duration, and battery charge used.
        cpu_s: Processor time of the mission, seconds.
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
    """Simulated missions compared with their forecast.

    Attributes:
        accepted, forecast: Accepted and forecast probability of exceeding the most critical limit.
        missions, failures: Number of missions, and of those that exceeded any limit.
        interval: 95 % confidence interval of the observed failure probability (Wilson).
        visits_forecast, visits, visits_spread: Forecast mean, observed mean and standard deviation of optional visits.
        kept: Optional visits of missions within all limits, as a mean over all missions.
        within: For metres, seconds and percent, the fractions of missions within the forecast median and within the
            forecast 90th percentile.
        review_s, mission_s: Processor time of checks and forecast, and mean processor time of a mission, seconds.
        warnings: Warnings that approval asks to confirm.
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
        """Return True if the number of failures is not significantly above the accepted probability."""
        from scipy.stats import binom

        return self.failures <= int(binom.ppf(1.0 - _BY_CHANCE, self.missions, self.accepted))

    @property
    def agrees(self) -> bool:
        """Return True if the forecast probability lies within the confidence interval of the observed one."""
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
    """Forecast a mission, simulate it with each seed, and compare.

    Args:
        task, site, robot: Mission; its warnings count as confirmed.
        seeds: Random seeds of the simulations.
        jobs: Number of processes; -1 for one per processor.
        tell: Function called with each finished mission.

    Raises:
        NotApprovedError: A check fails.
    """
    began = time.process_time()
    review = mission.review(task, site, robot)
    review_s = time.process_time() - began
    flown = []
    for one in fly_again(task, site, robot, seeds, jobs=jobs):
        tell(one)
        flown.append(one)
    assert review.estimate is not None  # noqa: S101  an approved mission has one
    return summarized(review.estimate.worst, flown, review_s=review_s, warnings=review.warnings)


def fly_again(task: Task, site: Site, robot: RobotProfile, seeds: Sequence[int], *, jobs: int = 1) -> Iterator[Mission]:
    """Simulate a mission with each seed; yield the results in that order as soon as available.

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
    """Compare simulated missions with the forecast of the worst branch."""
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
