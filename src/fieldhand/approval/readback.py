"""The read-back: the Task in plain language, resolved for its site and robot, for a person to approve.

It lists the steps, one line each, then the limits, the behaviour on faults, the assumptions, and the expected
consumption.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from fieldhand.forecast.estimate import BranchEstimate, Estimate, Figure
from fieldhand.forecast.resource_limits import ResourceKind, reserve_percent
from fieldhand.forecast.sampling_rounds import SamplingForecast
from fieldhand.forecast.walk_steps import Walk
from fieldhand.language import counted, joined, message, recalled
from fieldhand.language.words import capitalised, listed, say_duration, say_name, say_number, say_rounded
from fieldhand.places.explanation import notes
from fieldhand.robot.model import RobotProfile
from fieldhand.short_repr import short_repr
from fieldhand.site.model import Site
from fieldhand.task.build import FAULTED_EXITS
from fieldhand.task.earlier import site_of
from fieldhand.task.frames import Budget, FaultedExit, Task, Then
from fieldhand.wording.branches import FAULTS, say_decisions
from fieldhand.wording.cameras import camera_notes
from fieldhand.wording.earlier import say_earlier
from fieldhand.wording.recharging import say_charges, say_energy_limits, say_far_charging
from fieldhand.wording.resolved_places import gather
from fieldhand.wording.steps import ReadBackLine, say_exit_after, write_lines
from fieldhand.wording.timing import say_timing
from fieldhand.wording.watches import wait_limit_s
from fieldhand.wording.ways import say_ways, way_notes

__all__ = ["ReadBack", "ReadBackLine", "Totals", "read_back"]


@dataclass(frozen=True, kw_only=True)
class Totals:
    """Mean and 90th percentile of the consumption on the most demanding branch.

    Attributes:
        metres, seconds, percent: Distance, time, and percent of a full battery, including the drive home.
        captures: Number of captures.
        charges: Number of charges of the battery; None if the mission does not recharge.
        branches: Number of branches examined.
        worst: Sentences that describe that branch and its probability of running short.
    """

    metres: Figure
    seconds: Figure
    percent: Figure
    captures: int
    branches: int
    worst: tuple[str, ...] = ()
    charges: Figure | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class ReadBack:
    """A Task in plain language.

    Attributes:
        lines: The steps and the exit.
        times: Times at which the mission begins or runs again, one sentence each; empty if it begins when started.
        earlier: What it takes from earlier missions, one sentence each; empty if it does not depend on them.
        limits: Budgets and reserve, one sentence each.
        faults: Behaviour on faults, one sentence each.
        assumptions: Assumptions made in interpreting the request.
        notes: Limitations of the resolved places: a tie, the end of a row, trees without data.
        totals: Expected consumption.
        usual: Default sentences of ``limits`` and ``faults``, present unless the request overrides them.
    """

    lines: tuple[ReadBackLine, ...]
    limits: tuple[str, ...]
    faults: tuple[str, ...]
    assumptions: tuple[str, ...]
    notes: tuple[str, ...]
    totals: Totals
    usual: frozenset[str] = frozenset()
    times: tuple[str, ...] = ()
    earlier: tuple[str, ...] = ()

    __repr__ = short_repr

    def text_lines(self, *, usual: bool = True) -> tuple[str, ...]:
        """Return the read-back for a terminal: numbered steps, then the rest.

        Args:
            usual: Include the default limits and exits.
        """
        left_out = frozenset() if usual else self.usual
        return (
            *(_numbered(line) for line in self.lines),
            "",
            *(_indented(message("When: {text}", text=text)) for text in self.times),
            *(_indented(message("Earlier missions: {text}", text=text)) for text in self.earlier),
            *(_indented(message("Limit: {text}", text=text)) for text in self.limits if text not in left_out),
            *(_indented(text) for text in self.faults if text not in left_out),
            *(_indented(message("Assumed: {text}", text=text)) for text in self.assumptions),
            *(_indented(message("Note: {text}", text=text)) for text in self.notes),
            *(_indented(text) for text in say_totals(self.totals)),
        )


def read_back(task: Task, site: Site, robot: RobotProfile, estimate: Estimate) -> ReadBack:
    """Return the read-back of a Task.

    Args:
        task: The Task.
        site, robot: Site and robot that will carry out the Task.
        estimate: Estimate of the mission, whose branches supply the resolved places.
    """
    site = site_of(task, site)
    walks = [branch.walk for branch in estimate.branches]
    found = gather(task, walks, max((c.chance for c in estimate.worst.chances), default=0.0))
    limits, faults = _limits(task, robot), _faults(task, site)
    return ReadBack(
        lines=write_lines(task, site, robot, found),
        limits=limits,
        faults=faults,
        assumptions=tuple(recalled(text, "assumption") for text in task.command.assumptions),
        notes=(
            *_notes(walks, site),
            *map(_say_sampling, estimate.sampling),
            *_waits(task, robot),
            *say_far_charging(task.constraints, robot, estimate.worst.charged_to),
            *way_notes(task.constraints, robot),
            *camera_notes(walks, robot),
        ),
        totals=_totals(estimate, task, robot),
        usual=_usual(task, limits, faults),
        earlier=say_earlier(task, site),
        times=() if task.timing is None else say_timing(task.timing),
    )


def say_totals(totals: Totals) -> tuple[str, ...]:
    """Return the expected consumption as sentences."""
    m, s, p = totals.metres, totals.seconds, totals.percent
    time = say_duration(s.mean)
    if totals.charges is not None:
        charges = say_charges(totals.charges.mean, totals.charges.p90)
        time = message("{charges}, {time}", charges=charges, time=time)
    total = counted(
        "{count} capture, about {metres} m, {time}, {percent} of the battery.",
        "{count} captures, about {metres} m, {time}, {percent} of the battery.",
        totals.captures,
        metres=say_rounded(m.mean),
        time=time,
        percent=_percent(p.mean),
    )
    high = message(
        "Nine times out of ten it takes no more than {metres} m, {time}, {percent}.",
        metres=say_rounded(m.p90),
        time=say_duration(s.p90),
        percent=_percent(p.p90),
    )
    if totals.branches == 1:
        return message("In all: {totals}", totals=total), high, *totals.worst
    branches = message(
        "In all, on the most demanding of {count} branches: {totals}", count=totals.branches, totals=total
    )
    return branches, high, *totals.worst


def _percent(value: float) -> str:
    """Return a share in percent, rounded to a value above zero unless the share is zero."""
    return message("less than 1 %") if 0 < value < 0.5 else message("{number} %", number=say_rounded(value))


def say_budget(budget: Budget, *, home: bool = True) -> str:
    """Return a budget as a sentence; ``home`` is True if the mission drives to an exit place at its end."""
    match budget.kind:
        case "distance_m":
            amount: str = message("{number} m of driving", number=say_number(budget.limit))
        case "duration_s":
            amount = say_duration(budget.limit)
        case "energy_percent":
            amount = message("{number} % of a full battery", number=say_number(budget.limit))
    chance = say_number(100 * budget.failure_probability)
    if home:
        return message(
            "at most {amount}, the way home included (accepted chance of needing more: {chance} %).",
            amount=amount,
            chance=chance,
        )
    return message("at most {amount} (accepted chance of needing more: {chance} %).", amount=amount, chance=chance)


def _limits(task: Task, robot: RobotProfile) -> tuple[str, ...]:
    reserve = say_number(reserve_percent(task.constraints, robot))
    home = task.composition.nominal != "stay"
    found = [say_budget(b, home=home) for b in task.constraints.budgets]
    if task.constraints.reserve_percent is None:
        own = message("at least {percent} % charge is left at the end (the robot's own reserve).", percent=reserve)
        found.append(own)
    else:
        found.append(message("at least {percent} % charge is left at the end (as the Task asks).", percent=reserve))
    found.extend(say_energy_limits(task.constraints, robot))
    speed = task.constraints.speed_m_s
    if speed is not None:
        found.append(message("at most {speed} m/s.", speed=say_number(speed)))
    return (*found, *say_ways(task.constraints, robot))


def _usual(task: Task, limits: Sequence[str], faults: Sequence[str]) -> frozenset[str]:
    """Return the limits and faults that the Task has by default."""
    own = limits[len(task.constraints.budgets) :][:1] if task.constraints.reserve_percent is None else ()
    return frozenset({*own, *(faults if set(task.composition.faulted) in _usual_exits(task) else ())})


def _usual_exits(task: Task) -> tuple[set[FaultedExit], ...]:
    """Return the default exits: the common ones, and those with the mission's own end on low budget."""
    home = task.composition.nominal
    return (
        set(FAULTED_EXITS),
        {replace(e, then=home) if e.fault == "low_budget" else e for e in FAULTED_EXITS},
    )


def _faults(task: Task, site: Site) -> tuple[str, ...]:
    """Return the behaviour on faults; faults with the same exit share a sentence."""
    by_end: dict[Then, list[str]] = {}
    for taken in task.composition.faulted:
        by_end.setdefault(taken.then, []).append(FAULTS[taken.fault])
    return tuple(
        message("If {faults}: {exit}.", faults=listed(faults, "or"), exit=say_exit_after(then, site))
        for then, faults in by_end.items()
    )


def _notes(walks: Sequence[Walk], site: Site) -> tuple[str, ...]:
    """Return the notes of each selector, once a node, from the most likely branch that reaches it."""
    seen: set[str] = set()
    found: dict[str, None] = {}
    for step in (s for walked in walks for s in walked.steps):
        selector = step.node.selector
        if selector is None or step.node.id in seen:
            continue
        seen.add(step.node.id)
        if step.node.work is not None and step.node.work.on_ground:
            continue
        found.update((message("{note}.", note=capitalised(note)), None) for note in notes(selector, site, step.context))
    return tuple(found)


def _waits(task: Task, robot: RobotProfile) -> tuple[str, ...]:
    """Return a note on waiting for events, which the forecast leaves out."""
    longest = [wait_limit_s(watch, robot) for watch in task.composition.watches if watch.response == "wait"]
    slow: tuple[str, ...] = ()
    if any(watch.response == "slow" for watch in task.composition.watches):
        slow = (message("The figures are without events: driving slowly while one holds takes longer."),)
    if not longest:
        return slow
    time = say_duration(max(longest))
    return (
        *slow,
        message("The figures are without events: each wait adds up to {time} and what idling uses.", time=time),
    )


def _say_sampling(sampling: SamplingForecast) -> str:
    """Return how many readings a mean will probably take as a sentence."""
    return message(
        "With the usual spread of {quantity}, the mean takes about {median} readings, nine times out of ten no more"
        " than {high}, and {most} at most; it is known by then with a probability of {chance} %.",
        quantity=say_name(sampling.quantity),
        median=sampling.p50,
        high=sampling.p90,
        most=sampling.at_most,
        chance=say_rounded(100 * sampling.known),
    )


def _worst(estimate: Estimate, task: Task, robot: RobotProfile) -> tuple[str, ...]:
    """Return sentences that describe the most demanding branch and its probability of exceeding each limit."""
    worst = estimate.worst
    # If no sampled mission ran short, the probability is still not zero: it is reported as less than one percent.
    shares = [_percent(max(100 * c.chance, 0.1)) for c in worst.chances]
    limits = [_LIMITS[c.kind] for c in worst.chances]
    short = [message("{chance} of {limit}", chance=s, limit=of) for s, of in zip(shares, limits, strict=True)]
    chance = message("Chance of running short there: {chances}.", chances=listed(short))
    decided = say_decisions(worst.decisions, task, robot)
    if len(estimate.branches) == 1 or not decided:
        return (chance,)
    return (message("The most demanding branch: {branch}.", branch=decided), chance)


_LIMITS: dict[ResourceKind, str] = {
    "distance_m": message("the distance"),
    "duration_s": message("the time"),
    "energy_percent": message("the energy"),
    "reserve": message("the charge above the reserve"),
}


def _totals(estimate: Estimate, task: Task, robot: RobotProfile) -> Totals:
    worst: BranchEstimate = estimate.worst
    return Totals(
        metres=worst.metres,
        seconds=worst.seconds,
        percent=worst.percent,
        captures=worst.captures,
        branches=len(estimate.branches),
        worst=_worst(estimate, task, robot),
        charges=worst.charges,
    )


def _numbered(line: ReadBackLine) -> str:
    number = f"{line.number:>3}." if line.number is not None else "    "
    return joined("", ("     " * line.indent, number, " ", line.text))


def _indented(text: str) -> str:
    return joined("", ("  ", text))
