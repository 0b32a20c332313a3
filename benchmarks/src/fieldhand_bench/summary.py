"""Statistics of many missions: failures against accepted probabilities, work given up, visits and rewards."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand_bench.draw import LIMITED, PF
from fieldhand_bench.families import FAMILIES
from fieldhand_bench.fly import Trial
from fieldhand_bench.orienteering.run import wilson

#: Significance level of the test for more failures than accepted.
_BY_CHANCE = 0.025
_Z = 1.959964

#: A mission that gave up work or visits although it used less than this fraction of every limit is worth a look.
_UNUSED = 0.65
#: Duration from which a decision is worth a look, seconds.
_SLOW_S = 1.0


@dataclass(frozen=True, kw_only=True)
class TrialGroup:
    """Statistics of missions that have something in common.

    Attributes:
        name: Name of the group.
        missions: Number of missions.
        failures: Number of missions that exceeded a budget or the reserve.
        rate: Fraction of missions that failed.
        interval: 95 % confidence interval of ``rate`` (Wilson).
        accepted: Mean of the missions' accepted failure probabilities.
        most: 97.5th percentile of the number of failures if each mission fails with its accepted probability.
        visits: Mean number of completed optional visits.
        beyond_forecast: Mean of completed visits minus visits forecast, over missions with optional visits.
        reward_share: Mean of the reward divided by that of the best route if every leg costs its mean.
    """

    name: str
    missions: int
    failures: int
    rate: float
    interval: tuple[float, float]
    accepted: float
    most: int
    visits: float
    beyond_forecast: float | None
    reward_share: float | None

    @property
    def kept(self) -> bool:
        """Return True if the number of failures is not significantly above the accepted probabilities."""
        return self.failures <= self.most


@dataclass(frozen=True, kw_only=True)
class Times:
    """Durations of decisions, in milliseconds of processor time."""

    count: int
    median_ms: float
    p99_ms: float
    worst_ms: float


@dataclass(frozen=True, kw_only=True)
class Summary:
    """Statistics of all missions.

    Attributes:
        promises: Groups by risk at approval: all missions; those in which driving home at once was safe, so that a
            guard can keep its promise; of these, those whose mandatory work was safe, those approved with a warning,
            and those in which a limit had an effect; and the missions in which driving home was not safe.
        families, limits, probabilities: Missions of the second group by family, limit and accepted probability.
        refused: Number of drafts that were not approved and not simulated.
        gave_up: Number of missions in which mandatory work was given up with a reason.
        given_up: Number of pieces of mandatory work given up with a reason.
        silent: Mandatory work that was given up without a reason: "seed: node at place".
        lost: Number of missions ended by a fault (an empty battery).
        wrong: Places visited twice by a loop, wrong ends, and logs that do not fit the plan.
        first, choices, admissions: Durations of the guard's first decision of a mission, of later choices of an
            optional visit, and of later decisions on mandatory work.
    """

    promises: tuple[TrialGroup, ...]
    families: tuple[TrialGroup, ...]
    limits: tuple[TrialGroup, ...]
    probabilities: tuple[TrialGroup, ...]
    refused: int
    gave_up: int
    given_up: int
    silent: tuple[str, ...]
    lost: int
    wrong: tuple[str, ...]
    first: Times
    choices: Times
    admissions: Times

    @property
    def passed(self) -> bool:
        """Return True if limits were kept as promised, nothing was given up in silence, and every log fits its plan."""
        _, possible, within, *_ = self.promises
        return possible.kept and within.kept and not self.silent and not self.wrong


def summarize(trials: Sequence[Trial]) -> Summary:
    """Compute the statistics of one or more missions."""
    possible = [t for t in trials if t.promise != "hopeless"]
    return Summary(
        promises=(
            group("all", trials),
            group("home alone is safe", possible),
            group("- must-do is safe", _with(trials, "within")),
            group("- warned", _with(trials, "warned")),
            group("- a limit binds", [t for t in possible if _bound(t)]),
            group("home alone is not", _with(trials, "hopeless")),
        ),
        families=_by(possible, FAMILIES, lambda t: t.family),
        limits=_by(possible, LIMITED, lambda t: t.limited),
        probabilities=_by(possible, map(str, PF), lambda t: str(t.failure_probability)),
        refused=sum(len(t.refused) for t in trials),
        gave_up=sum(bool(t.ruling.given_up) for t in trials),
        given_up=sum(len(t.ruling.given_up) for t in trials),
        silent=tuple(f"{t.seed}: {what}" for t in trials for what in t.ruling.silent),
        lost=sum(bool(t.ruling.faulted) for t in trials),
        wrong=tuple(f"{t.seed}: {what}" for t in trials for what in wrongs(t)),
        first=_times([t.first_s for t in trials]),
        choices=_times([s for t in trials for s in t.choices_s]),
        admissions=_times([s for t in trials for s in t.admissions_s]),
    )


def group(name: str, trials: Sequence[Trial]) -> TrialGroup:
    """Compute the statistics of a group of missions, which may be empty."""
    failures = sum(t.failed for t in trials)
    rate = failures / len(trials) if trials else 0.0
    accepted = [t.failure_probability for t in trials]
    choosing = [t for t in trials if t.forecast.visits or t.ruling.visits]
    shares = [t.ruling.reward / t.certain.reward for t in trials if t.certain.reward > 0]
    return TrialGroup(
        name=name,
        missions=len(trials),
        failures=failures,
        rate=rate,
        interval=wilson(rate, len(trials)) if trials else (0.0, 1.0),
        accepted=float(np.mean(accepted)) if trials else 0.0,
        most=most_failures(accepted),
        visits=float(np.mean([t.ruling.visits for t in trials])) if trials else 0.0,
        beyond_forecast=(float(np.mean([t.ruling.visits - t.forecast.visits for t in choosing])) if choosing else None),
        reward_share=float(np.mean(shares)) if shares else None,
    )


def most_failures(accepted: Sequence[float]) -> int:
    """Return the 97.5th percentile of the number of failures if each mission fails with its accepted probability.

    That number has a Poisson binomial distribution, computed by convolution.
    """
    chances: NDArray[np.float64] = np.ones(1)
    for probability in accepted:
        chances = np.convolve(chances, [1.0 - probability, probability])
    return int(np.argmax(np.cumsum(chances) >= 1.0 - _BY_CHANCE))


def wrongs(trial: Trial) -> tuple[str, ...]:
    """Return errors that no mission may have, whatever its limits."""
    ruling = trial.ruling
    twice = tuple(f"visited twice by {what}" for what in ruling.doubled)
    return (*twice, *((ruling.misplaced,) if ruling.misplaced else ()), *ruling.odd)


def worth_looking_at(trials: Sequence[Trial], count: int) -> tuple[tuple[Trial, str], ...]:
    """Return the missions to be examined first when improving the guard, each with the reason."""
    found = [(weight, trial, why) for trial in trials for weight, why in _remarks(trial)]
    best: dict[int, tuple[float, Trial, str]] = {}
    for one in sorted(found, key=lambda f: (-f[0], f[1].seed)):
        best.setdefault(one[1].seed, one)
    return tuple((trial, why) for _, trial, why in list(best.values())[:count])


def _remarks(trial: Trial) -> Iterable[tuple[float, str]]:
    ruling = trial.ruling
    most = max(use.share for use in ruling.uses)
    binding = max(ruling.uses, key=lambda use: use.share)
    used = f"{most:.0%} of {binding.kind}"
    for what in ruling.silent:
        yield 100.0, f"given up in silence: {what}"
    for what in wrongs(trial):
        yield 90.0, what
    if ruling.faulted:
        yield 60.0, f"a fault ended it: {ruling.faulted}"
    if trial.failed and trial.promise != "hopeless":
        yield 40.0 + min(10.0, 10.0 * (most - 1.0)), f"{used} used, {trial.failure_probability:.0%} accepted"
    if ruling.given_up and trial.promise == "within":
        yield (
            50.0 - 10.0 * most,
            f"gave up {len(ruling.given_up)} of {len(ruling.given_up) + ruling.done} that had to be done, forecast"
            f" to be safe; {used} used",
        )
    elif ruling.given_up and most < _UNUSED:
        yield 35.0 - 10.0 * most, f"gave up {len(ruling.given_up)} that had to be done; only {used} used"
    if ruling.left_out and most < _UNUSED:
        yield 30.0 - 10.0 * most, f"left out {ruling.left_out} visits, made {ruling.visits}; only {used} used"
    if ruling.caution is not None and ruling.caution < trial.failure_probability / 2:
        yield (
            32.0 - 10.0 * most,
            f"gave up {ruling.left_out + len(ruling.given_up)} at a chance of {ruling.caution:.1%} of running short,"
            f" {trial.failure_probability:.0%} accepted; {ruling.visits} of {trial.forecast.visits} visits made",
        )
    short = trial.forecast.visits - ruling.visits
    if short > 2 and ruling.visits < 0.6 * trial.forecast.visits and ruling.left_out:
        yield (
            20.0 + short / trial.forecast.visits,
            f"{ruling.visits} visits where {trial.forecast.visits} were forecast; {used} used",
        )
    slowest = max([trial.first_s, *trial.choices_s, *trial.admissions_s])
    if slowest > _SLOW_S:
        yield 10.0 + slowest, f"a decision took {slowest:.1f} s ({trial.trees} trees)"


def _bound(trial: Trial) -> bool:
    """Return True if a limit had an effect: work or visits were given up, or it was exceeded."""
    return bool(trial.ruling.left_out or trial.ruling.given_up or trial.failed)


def _with(trials: Sequence[Trial], promise: str) -> list[Trial]:
    return [t for t in trials if t.promise == promise]


def _by(trials: Sequence[Trial], names: Iterable[str], of: Callable[[Trial], str]) -> tuple[TrialGroup, ...]:
    there = Counter(of(t) for t in trials)
    return tuple(group(name, [t for t in trials if of(t) == name]) for name in names if there[name])


def _times(seconds: Sequence[float]) -> Times:
    if not seconds:
        return Times(count=0, median_ms=0.0, p99_ms=0.0, worst_ms=0.0)
    ms = 1e3 * np.asarray(seconds)
    return Times(
        count=len(ms),
        median_ms=float(np.median(ms)),
        p99_ms=float(np.quantile(ms, 0.99)),
        worst_ms=float(ms.max()),
    )
