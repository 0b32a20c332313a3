"""What a Task will take on every branch: metres, seconds and charge as distributions, and chances of running short."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast import routes
from fieldhand.forecast.branches import branches
from fieldhand.forecast.drawn import DRAWS
from fieldhand.forecast.limits import Resource, ResourceKind, resources_of, speed_of
from fieldhand.forecast.steps import Decision, Walk
from fieldhand.language import message
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task.frames import Task
from fieldhand.task.plan import AnyOrder, ForEach, If, Node, Optional, Repeat, Sequence, Try, is_optional
from fieldhand.task.words import say_rounded

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Figure:
    """A random amount: its mean, and what it exceeds once in ten missions (90th percentile)."""

    mean: float
    p90: float


@dataclass(frozen=True, kw_only=True)
class Chance:
    """The chance of using more of a resource than there is.

    Attributes:
        kind: Which budget, or ``reserve``.
        limit: Metres, seconds, or percent of a full battery.
        accepted: The failure probability that the Task accepts.
    """

    kind: ResourceKind
    limit: float
    accepted: float
    chance: float

    @property
    def exceeded(self) -> bool:
        """Whether the chance is more than is accepted, beyond what the number of draws can tell."""
        noise = 2.0 * np.sqrt(self.accepted * (1.0 - self.accepted) / DRAWS)
        return bool(self.chance > self.accepted + noise)


@dataclass(frozen=True, kw_only=True)
class BranchEstimate:
    """One branch.

    Attributes:
        decisions: What was answered on it.
        metres, seconds, percent: What it takes; percent of a full battery.
        chances: For each budget, and then for the battery's reserve.
        captures: Number of captures on it.
        visits: Optional visits and steps that missions make on average.
        shed: Places of those for which the budget will hardly last.
        walk: The branch itself.
    """

    decisions: tuple[Decision, ...]
    metres: Figure
    seconds: Figure
    percent: Figure
    chances: tuple[Chance, ...]
    captures: int
    visits: float
    shed: tuple[Place, ...]
    walk: Walk


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """What a Task will take.

    Attributes:
        branches: Every branch that was looked at; the first is the one on which every condition holds.
        worst: The branch most likely to run short, and among equals the one that takes longest.
        complete: Whether every branch was looked at.
        problems: What stands in the way of carrying it out within its limits, as sentences.
    """

    branches: tuple[BranchEstimate, ...]
    worst: BranchEstimate
    complete: bool
    problems: tuple[str, ...]

    def as_record(self) -> dict[str, object]:
        """The figures as JSON: the worst branch, and how many branches there are."""
        worst = self.worst
        return {
            "branches": len(self.branches),
            "complete": self.complete,
            "distance_m": asdict(worst.metres),
            "duration_s": asdict(worst.seconds),
            "battery_percent": asdict(worst.percent),
            "captures": worst.captures,
            "limits": [asdict(chance) for chance in worst.chances],
            "optional": [
                {"node": step.node.id, "expected": step.outlook.visits, "chances": dict(step.outlook.chances)}
                for step in worst.walk.steps
                if step.outlook is not None
            ],
            "problems": list(self.problems),
        }


@dataclass(frozen=True, kw_only=True)
class _Kept:
    """The last estimate of a site: approval asks again for what the plan was shown with."""

    robot: RobotProfile
    asked: tuple[Task, int, float]
    found: Estimate


def estimate(
    task: Task,
    site: Site,
    robot: RobotProfile,
    seed: int = 0,
    *,
    drives: Drives | None = None,
    charge_percent: float = 100.0,
) -> Estimate:
    """Estimate a Task on every branch by drawing the cost of each leg.

    A leg of ``d`` metres that costs ``c`` counts as ``c`` metres driven, so distance, time and energy are all random.
    Which optional visits a mission makes is decided by what decides on board.

    Args:
        task, site, robot: The mission.
        seed: The same seed gives the same estimate.
        drives: The ways of the site, if the caller has them.
        charge_percent: Charge at the beginning.

    Raises:
        PlaceError: A selector gives nothing on one of the branches.
        DriveFault: A place that cannot be reached.
    """
    asked = (task, seed, charge_percent)
    kept = site.memory.get("estimate")
    if isinstance(kept, _Kept) and kept.robot is robot and kept.asked == asked and drives is None:
        return kept.found
    ways = drives or routes.drives_for(site, robot)
    resources = resources_of(task.constraints, robot, charge_percent)
    found = branches(task, site, robot, drives=ways, charge_percent=charge_percent, seed=seed)
    speed = speed_of(task.constraints, robot)
    estimates = tuple(_branch(w, resources, robot, speed) for w in found.walks)
    worst = max(estimates, key=lambda b: (max(c.chance - c.accepted for c in b.chances), b.seconds.mean))
    if worst.visits and any(c.exceeded for c in worst.chances):
        # Optional visits can be left out, so what counts is whether the rest lasts without them.
        problems = estimate(
            mandatory_part(task), site, robot, seed, drives=ways, charge_percent=charge_percent
        ).problems
    else:
        problems = _problems(task, site, ways, resources, worst)
    made = Estimate(branches=estimates, worst=worst, complete=found.complete, problems=problems)
    if drives is None:
        site.memory["estimate"] = _Kept(robot=robot, asked=asked, found=made)
    return made


def mandatory_part(task: Task) -> Task:
    """The Task without its optional visits and steps."""
    return replace(task, composition=replace(task.composition, plan=_without_optional(task.composition.plan)))


def _without_optional(node: Node) -> Node:
    match node:
        case ForEach(optional=True) | Optional():
            return Sequence(id=node.id, steps=())
        case Sequence() | AnyOrder():
            return replace(node, steps=tuple(_without_optional(step) for step in node.steps))
        case ForEach() | Repeat():
            return replace(node, body=_without_optional(node.body))
        case If():
            other = None if node.otherwise is None else _without_optional(node.otherwise)
            return replace(node, then=_without_optional(node.then), otherwise=other)
        case Try():
            return replace(node, body=_without_optional(node.body), otherwise=_without_optional(node.otherwise))
        case _:
            return node


def _branch(walked: Walk, resources: tuple[Resource, ...], robot: RobotProfile, speed: float) -> BranchEstimate:
    used = walked.used
    assert used is not None  # noqa: S101  estimates draw missions on every walk
    metres, seconds = used.metres, used.metres / speed + used.seconds
    driving, idling = robot.percent(1.0, 0.0), robot.percent(0.0, 1.0)
    percent = driving * metres + idling * seconds + robot.percent(0.0, 0.0, 1.0) * used.joules
    amount = {"distance_m": metres, "duration_s": seconds, "energy_percent": percent, "reserve": percent}
    lists = [s for s in walked.steps if is_optional(s.node) and s.kind == "visit-list"]
    return BranchEstimate(
        decisions=walked.decisions,
        metres=_figure(metres),
        seconds=_figure(seconds),
        percent=_figure(percent),
        chances=tuple(
            Chance(
                kind=r.kind,
                limit=r.limit,
                accepted=r.failure_probability,
                chance=float((amount[r.kind] > r.limit * (1 + 1e-9)).mean()),
            )
            for r in resources
        ),
        captures=sum(s.captures for s in walked.steps),
        visits=sum(s.outlook.visits for s in lists if s.outlook is not None),
        shed=tuple(p for s in lists for p in s.shed),
        walk=walked,
    )


def _figure(draws: Floats) -> Figure:
    return Figure(mean=float(draws.mean()), p90=float(np.quantile(draws, 0.9)))


def _problems(
    task: Task, site: Site, drives: Drives, resources: tuple[Resource, ...], worst: BranchEstimate
) -> tuple[str, ...]:
    """Sentences about limits that the mission will not keep."""
    found = []
    home = site.home(task.composition.nominal, site.start)
    alone = 0.0 if home.xy == site.start.xy else drives.between(site.start, home).length_m
    for resource, chance in zip(resources, worst.chances, strict=True):
        name, unit = _WORDS[resource.kind]
        need = alone * resource.per_metre
        if need > resource.limit * (1 + 1e-9):
            found.append(
                message(
                    "{budget} of {limit} {unit} is too small: driving home from the start alone takes {need} {unit} on"
                    " average",
                    budget=name,
                    limit=say_rounded(resource.limit),
                    unit=unit,
                    need=say_rounded(need),
                )
            )
        elif chance.exceeded and not worst.visits:
            used = {"distance_m": worst.metres, "duration_s": worst.seconds}.get(resource.kind, worst.percent)
            found.append(
                message(
                    "{budget} of {limit} {unit} does not last for what must be done: it takes {need} {unit} on average,"
                    " {chance}% chance of running short where {accepted}% is accepted",
                    budget=name,
                    limit=say_rounded(resource.limit),
                    unit=unit,
                    need=say_rounded(used.mean),
                    chance=say_rounded(100 * chance.chance),
                    accepted=say_rounded(100 * resource.failure_probability),
                )
            )
    return tuple(found)


_WORDS: dict[ResourceKind, tuple[str, str]] = {
    "distance_m": (message("the distance budget"), "m"),
    "duration_s": (message("the time budget"), "s"),
    "energy_percent": (message("the energy budget"), message("% of the battery")),
    "reserve": (message("the charge above the reserve"), message("% of the battery")),
}
