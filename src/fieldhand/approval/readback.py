"""The read-back: the Task in plain words as this site and this robot will have it, for a person to sign.

First the steps, one line each; then the limits, what happens when something goes wrong, what was assumed, and what it
will take.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fieldhand.approval.resolved import gather
from fieldhand.approval.sentences import Line, say_exit, write_lines
from fieldhand.forecast.estimate import BranchEstimate, Estimate, Figure
from fieldhand.forecast.limits import reserve_percent
from fieldhand.forecast.steps import Walk
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.site.places import notes
from fieldhand.task.frames import Budget, Fault, Task
from fieldhand.task.plan import selector_of
from fieldhand.task.words import capitalised, listed, say_count, say_duration, say_number

__all__ = ["Line", "ReadBack", "Totals", "read_back"]

_FAULTS: dict[Fault, str] = {
    "action_failed": "an action fails for good",
    "drive_failed": "a way cannot be driven",
    "low_budget": "what is left only just lasts for the way home",
    "aborted": "somebody aborts the mission",
}


@dataclass(frozen=True, kw_only=True)
class Totals:
    """What the mission takes on the branch that takes most of what is short: mean, and 90th percentile.

    Attributes:
        metres, seconds, percent: Distance, time, and percent of a full battery, the way home included.
        captures: Number of captures.
        branches: How many branches were looked at.
    """

    metres: Figure
    seconds: Figure
    percent: Figure
    captures: int
    branches: int


@dataclass(frozen=True, kw_only=True)
class ReadBack:
    """A Task in words.

    Attributes:
        lines: The steps and the exit.
        limits: Budgets and reserve, a sentence each.
        faults: What happens when something goes wrong, a sentence each.
        assumptions: What was assumed in reading the request.
        notes: What a person may not expect of where it leads: a tie, the end of a row, trees of which nothing is known.
        totals: What it takes.
    """

    lines: tuple[Line, ...]
    limits: tuple[str, ...]
    faults: tuple[str, ...]
    assumptions: tuple[str, ...]
    notes: tuple[str, ...]
    totals: Totals

    def text_lines(self) -> tuple[str, ...]:
        """The whole read-back for a terminal: steps with their numbers, then the rest."""
        return (
            *(_numbered(line) for line in self.lines),
            "",
            *(f"  Limit: {text}" for text in self.limits),
            *(f"  {text}" for text in self.faults),
            *(f"  Assumed: {text}" for text in self.assumptions),
            *(f"  Note: {text}" for text in self.notes),
            *(f"  {text}" for text in say_totals(self.totals)),
        )


def read_back(task: Task, site: Site, robot: RobotProfile, estimate: Estimate) -> ReadBack:
    """Say a Task in words.

    Args:
        task: The Task.
        site, robot: Where and with what it will be carried out.
        estimate: Its estimate there; its branches tell what each selector comes to.
    """
    walks = [branch.walk for branch in estimate.branches]
    found = gather(task, walks, max((c.chance for c in estimate.worst.chances), default=0.0))
    return ReadBack(
        lines=write_lines(task, site, robot, found),
        limits=_limits(task, robot),
        faults=_faults(task, site),
        assumptions=task.command.assumptions,
        notes=_notes(walks, site),
        totals=_totals(estimate),
    )


def say_totals(totals: Totals) -> tuple[str, ...]:
    """What it takes, as sentences."""
    m, s, p = totals.metres, totals.seconds, totals.percent
    mean = f"{m.mean:.0f} m, {say_duration(s.mean)}, {p.mean:.0f} % of the battery"
    high = f"{m.p90:.0f} m, {say_duration(s.p90)}, {p.p90:.0f} %"
    which = f" on the most demanding of {totals.branches} branches" if totals.branches > 1 else ""
    return (
        f"In all{which}: {say_count(totals.captures, 'capture')}, about {mean}.",
        f"Nine times out of ten it takes no more than {high}.",
    )


def say_budget(budget: Budget, *, home: bool = True) -> str:
    """A budget as a sentence. ``home``: whether the mission goes anywhere when it is done."""
    match budget.kind:
        case "distance_m":
            amount = f"{say_number(budget.limit)} m of driving"
        case "duration_s":
            amount = say_duration(budget.limit)
        case "energy_percent":
            amount = f"{say_number(budget.limit)} % of a full battery"
    chance = say_number(100 * budget.failure_probability)
    way = ", the way home included" if home else ""
    return f"at most {amount}{way} (accepted chance of needing more: {chance} %)."


def _limits(task: Task, robot: RobotProfile) -> tuple[str, ...]:
    reserve = reserve_percent(task.constraints, robot)
    whose = "the robot's own reserve" if task.constraints.reserve_percent is None else "as the Task asks"
    home = task.composition.nominal != "stay"
    found = [say_budget(b, home=home) for b in task.constraints.budgets]
    found.append(f"at least {say_number(reserve)} % charge is left at the end ({whose}).")
    speed = task.constraints.speed_m_s
    if speed is not None:
        found.append(f"at most {say_number(speed)} m/s.")
    return tuple(found)


def _faults(task: Task, site: Site) -> tuple[str, ...]:
    """What happens about faults; those with the same end share a sentence."""
    by_end: dict[str, list[str]] = {}
    for taken in task.composition.faulted:
        does = say_exit(taken.then, site).rstrip(".")
        where = "stop and wait there" if taken.then == "stay" else does[:1].lower() + does[1:]
        by_end.setdefault(where, []).append(_FAULTS[taken.fault])
    return tuple(f"If {listed(faults, 'or')}: {end}." for end, faults in by_end.items())


def _notes(walks: Sequence[Walk], site: Site) -> tuple[str, ...]:
    """Of each selector as it is met on the likeliest branch that has it, once a node."""
    seen: set[str] = set()
    found: dict[str, None] = {}
    for step in (s for walked in walks for s in walked.steps):
        selector = selector_of(step.node)
        if selector is None or step.node.id in seen:
            continue
        seen.add(step.node.id)
        found.update((capitalised(note).rstrip(".") + ".", None) for note in notes(selector, site, step.context))
    return tuple(found)


def _totals(estimate: Estimate) -> Totals:
    worst: BranchEstimate = estimate.worst
    return Totals(
        metres=worst.metres,
        seconds=worst.seconds,
        percent=worst.percent,
        captures=worst.captures,
        branches=len(estimate.branches),
    )


def _numbered(line: Line) -> str:
    margin = "     " * line.indent
    return f"{margin}{line.number:>3}. {line.text}" if line.number is not None else f"{margin}     {line.text}"
