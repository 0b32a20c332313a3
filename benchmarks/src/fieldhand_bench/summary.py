"""Many missions in figures: limits exceeded against what was accepted, what was given up, what was got."""

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

#: More failures than are accepted come about by chance this often at most before they are held against the guard.
_BY_CHANCE = 0.025
_Z = 1.959964

#: A mission that used less of every limit than this, and left visits or work out for the budget, is worth a look.
_UNUSED = 0.65
#: Seconds of a decision that is worth a look.
_SLOW_S = 1.0


@dataclass(frozen=True, kw_only=True)
class Group:
    """Missions that have something in common.

    Attributes:
        failures: Missions that exceeded a budget or the reserve.
        rate: Their part.
        interval: Its 95 % confidence interval (Wilson).
        accepted: The mean of the missions' accepted probabilities.
        most: Failures beyond which chance explains them no more (97.5th percentile, were each mission to fail with
            just its accepted probability).
        visits: Optional visits, the mean over missions.
        beyond_forecast: Visits made less visits forecast at approval, the mean over missions that have any.
        reward_share: Reward over that of the best route were all legs' costs their means, the mean over missions.
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
        """Whether there were no more failures than are accepted, within what chance explains."""
        return self.failures <= self.most


@dataclass(frozen=True, kw_only=True)
class Times:
    """How long decisions took, in milliseconds of processor time."""

    count: int
    median_ms: float
    p99_ms: float
    worst_ms: float


@dataclass(frozen=True, kw_only=True)
class Summary:
    """What came of all missions.

    Attributes:
        promises: All missions; those in which driving home at once was safe enough, so that a guard can keep its
            promise; of these those whose mandatory part was, those approved with a warning, and those in which a limit
            made a difference; the others.
        families, limits, probabilities: The missions of the second group by what they were.
        refused: Draws that were not approved; they were not flown.
        gave_up: Missions in which work that had to be done was given up, all with a reason.
        given_up: Pieces of that work.
        silent: Work that had to be done and was given up without a word: "seed: node at place".
        lost: Missions that a fault ended (an empty battery).
        wrong: Loops that visited a place twice, ends elsewhere than asked for, logs that do not fit the plan.
        first, choices, admissions: The guard's first decision of a mission; later choices of an optional visit; later
            answers about mandatory work.
    """

    promises: tuple[Group, ...]
    families: tuple[Group, ...]
    limits: tuple[Group, ...]
    probabilities: tuple[Group, ...]
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
        """Whether limits were kept as promised, nothing was given up in silence, and every log fits its plan."""
        _, possible, within, *_ = self.promises
        return possible.kept and within.kept and not self.silent and not self.wrong


def summarize(trials: Sequence[Trial]) -> Summary:
    """The figures of some missions, one at least."""
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


def group(name: str, trials: Sequence[Trial]) -> Group:
    """Some missions in figures; none is a group, too."""
    failures = sum(t.failed for t in trials)
    rate = failures / len(trials) if trials else 0.0
    accepted = [t.failure_probability for t in trials]
    choosing = [t for t in trials if t.forecast.visits or t.ruling.visits]
    shares = [t.ruling.reward / t.certain.reward for t in trials if t.certain.reward > 0]
    return Group(
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
    """The number of failures that chance exceeds once in forty times, were each mission to fail with its probability.

    The distribution is that of a sum of different coins (Poisson binomial), worked out coin by coin.
    """
    chances: NDArray[np.float64] = np.ones(1)
    for probability in accepted:
        chances = np.convolve(chances, [1.0 - probability, probability])
    return int(np.argmax(np.cumsum(chances) >= 1.0 - _BY_CHANCE))


def wrongs(trial: Trial) -> tuple[str, ...]:
    """What a mission must never show, whatever its limits."""
    ruling = trial.ruling
    twice = tuple(f"visited twice by {what}" for what in ruling.doubled)
    return (*twice, *((ruling.misplaced,) if ruling.misplaced else ()), *ruling.odd)


def worth_looking_at(trials: Sequence[Trial], count: int) -> tuple[tuple[Trial, str], ...]:
    """The missions that a person who improves the guard should look at first, each with why."""
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
    """Whether a limit made a difference: something was given up for it, or it was exceeded."""
    return bool(trial.ruling.left_out or trial.ruling.given_up or trial.failed)


def _with(trials: Sequence[Trial], promise: str) -> list[Trial]:
    return [t for t in trials if t.promise == promise]


def _by(trials: Sequence[Trial], names: Iterable[str], of: Callable[[Trial], str]) -> tuple[Group, ...]:
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
