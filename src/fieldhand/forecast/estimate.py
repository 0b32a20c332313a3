"""Estimate of a Task on every branch: distributions of distance, time and charge, and overrun probabilities."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.forecast import visit_order
from fieldhand.forecast.branch_estimate import BranchEstimate, Figure, estimate_branch
from fieldhand.forecast.branches import Branches, branches
from fieldhand.forecast.fault_exits import FaultExits, fault_exits
from fieldhand.forecast.resource_limits import ResourceKind, ResourceLimit, resource_limits
from fieldhand.forecast.route_cost import cost_model
from fieldhand.forecast.sampled_costs import DRAWS, LegCostSamples
from fieldhand.forecast.sampling_rounds import SamplingForecast, sampling_forecasts
from fieldhand.language import message
from fieldhand.language.words import say_rounded
from fieldhand.robot.model import RobotProfile
from fieldhand.short_repr import short_repr
from fieldhand.site.earlier_missions import EarlierMissions
from fieldhand.site.model import Site
from fieldhand.task.earlier import site_of_run
from fieldhand.task.frames import Task
from fieldhand.task.plan import InOrder, Node

if TYPE_CHECKING:
    from fieldhand.site.closed_ground import ClosedGround
    from fieldhand.site.drives import Drives

__all__ = ["BranchEstimate", "Estimate", "Figure", "estimate", "explore", "limit_problems", "mandatory_part"]


@dataclass(frozen=True, kw_only=True, repr=False)
class Estimate:
    """The estimate of a Task, from missions sampled along every branch.

    Attributes:
        branches: Estimates of the explored branches; the first is the one on which every condition holds.
        worst: The branch most likely to exceed a limit; among equals, the longest one.
        faulted: For each fault after which the robot drives home, the longest branch up to that fault and home.
        explored: The explored branches, including walks with prescribed optional visits.
        exits: Drives home after faults.
        problems: Problems that prevent the Task from being carried out within its limits, one sentence each.
        charge_percent: Battery charge at the start of the mission, 0 to 100.
        closed: Ground that the mission keeps out of.
        sampling: Number of readings of each loop that ends once a mean is known.
    """

    branches: tuple[BranchEstimate, ...]
    worst: BranchEstimate
    faulted: tuple[BranchEstimate, ...]
    explored: Branches
    exits: FaultExits
    problems: tuple[str, ...]
    charge_percent: float = 100.0
    closed: tuple[ClosedGround, ...] = ()
    sampling: tuple[SamplingForecast, ...] = ()

    __repr__ = short_repr

    @property
    def complete(self) -> bool:
        """Return True if no place, drive or extreme of resource use can have been missed."""
        return self.explored.complete

    def as_record(self, *, every: bool = False) -> dict[str, object]:
        """Return the estimate as JSON: the worst branch and the number of branches; with ``every``, all of them."""
        worst = self.worst
        record: dict[str, object] = {
            "branches": len(self.branches),
            "coverage": self.explored.coverage,
            "complete": self.complete,
            "draws": worst.chances[-1].draws,
            "charge_percent": self.charge_percent,
            **worst.as_record(),
            "optional": [
                {
                    "node": step.node.id,
                    "expected": step.visit_forecast.visits,
                    "chances": dict(step.visit_forecast.chances),
                }
                for step in worst.walk.steps
                if step.visit_forecast is not None
            ],
            "optional_branches": len(self.explored.optional_walks),
            "exits": {"places": self.exits.places, "looked_at": self.exits.looked_at},
            "faulted": [branch.as_record() for branch in self.faulted],
            "problems": list(self.problems),
        }
        if self.sampling:
            record["sampling"] = [asdict(one) for one in self.sampling]
        return record | {"every_branch": [branch.as_record() for branch in self.branches]} if every else record


@dataclass(frozen=True, kw_only=True)
class _CachedBranches:
    """Cache of the branches last explored on a site: approval needs those that were shown with the plan."""

    robot: RobotProfile
    asked: tuple[Task, int, float, int, EarlierMissions | None]
    explored: Branches
    leg_costs: LegCostSamples
    estimate: Estimate | None = None


def explore(
    task: Task, site: Site, robot: RobotProfile, seed: int = 0, *, charge_percent: float = 100.0, draws: int = DRAWS
) -> Branches:
    """Walk every branch of a Task with sampled missions; a repeated call returns the cached result."""
    return _explored(task, site, robot, seed, charge_percent, draws).explored


def _explored(
    task: Task, site: Site, robot: RobotProfile, seed: int, charge_percent: float, draws: int
) -> _CachedBranches:
    asked = (task, seed, charge_percent, draws, site.earlier)
    kept = site.cache.get("estimate")
    if isinstance(kept, _CachedBranches) and kept.robot is robot and kept.asked == asked:
        return kept
    leg_costs = LegCostSamples(cost_model(robot), seed, draws)
    found = branches(task, site, robot, charge_percent=charge_percent, leg_costs=leg_costs, seed=seed)
    made = site.cache["estimate"] = _CachedBranches(robot=robot, asked=asked, explored=found, leg_costs=leg_costs)
    return made


def estimate(
    task: Task,
    site: Site,
    robot: RobotProfile,
    seed: int = 0,
    *,
    charge_percent: float = 100.0,
    draws: int = DRAWS,
) -> Estimate:
    """Estimate a Task on every branch by Monte Carlo sampling of the leg costs.

    A leg of ``d`` metres that costs ``c`` counts as ``c`` metres driven, so distance, time and energy are all random.
    Optional visits are chosen by the same policy as on board (:mod:`fieldhand.orienteering`).

    Args:
        task, site, robot: Task, site and robot of the mission.
        seed: Random seed; the same seed gives the same estimate.
        charge_percent: Battery charge at the start of the mission, 0 to 100.
        draws: Number of missions sampled along each branch.

    Raises:
        PlaceError: A selector gives no place on one of the branches.
        DriveFault: A place cannot be reached.
        TaskError: A branch exceeds the maximum number of nodes.
    """
    site = site_of_run(task, site)
    kept = _explored(task, site, robot, seed, charge_percent, draws)
    if kept.estimate is not None:
        return kept.estimate
    if kept.explored.broken:
        raise kept.explored.broken[0].error
    made = _estimated(kept, task, site, robot, charge_percent)
    site.cache["estimate"] = replace(kept, estimate=made)
    return made


def _estimated(kept: _CachedBranches, task: Task, site: Site, robot: RobotProfile, charge_percent: float) -> Estimate:
    found, drives = kept.explored, visit_order.drives_for(site, robot, task.constraints)
    resources = resource_limits(task.constraints, robot, charge_percent)
    estimates = tuple(estimate_branch(w, resources, task.constraints, robot, charge_percent) for w in found.walks)
    worst = _worst(estimates)
    ways_home = fault_exits(task, site, robot, drives, found.walks, found.optional_walks, kept.leg_costs)
    problems: tuple[str, ...] = ()
    if any(b.visits and c.exceeded for b in estimates for c in b.chances):
        # Optional visits can be left out, so the mandatory work is checked first without them.
        problems = _of_mandatory(kept, task, site, robot, charge_percent)
    problems = problems or limit_problems(task, site, drives, resources, estimates)
    return Estimate(
        branches=estimates,
        worst=worst,
        faulted=tuple(
            estimate_branch(walked, resources, task.constraints, robot, charge_percent, fault)
            for fault, walked in ways_home.worst
        ),
        explored=found,
        exits=ways_home,
        problems=problems,
        charge_percent=charge_percent,
        closed=drives.closed,
        sampling=sampling_forecasts(task, robot, found.walks, kept.leg_costs.seed),
    )


def _of_mandatory(
    kept: _CachedBranches, task: Task, site: Site, robot: RobotProfile, charge_percent: float
) -> tuple[str, ...]:
    """Return the problems of a Task without its optional work."""
    part = mandatory_part(task)
    resources = resource_limits(part.constraints, robot, charge_percent)
    found = branches(
        part, site, robot, charge_percent=charge_percent, leg_costs=kept.leg_costs, seed=kept.leg_costs.seed
    )
    estimates = [estimate_branch(w, resources, part.constraints, robot, charge_percent) for w in found.walks]
    return limit_problems(part, site, visit_order.drives_for(site, robot, part.constraints), resources, estimates)


def _worst(estimates: Sequence[BranchEstimate]) -> BranchEstimate:
    return max(estimates, key=lambda b: (max(c.chance - c.accepted for c in b.chances), b.seconds.mean))


def mandatory_part(task: Task) -> Task:
    """Return the Task without its optional visits and steps."""
    return replace(task, composition=replace(task.composition, plan=_without_optional(task.composition.plan)))


def _without_optional(node: Node) -> Node:
    if node.is_optional:
        return InOrder(id=node.id, steps=())
    return node.with_children([_without_optional(child) for child in node.children])


def limit_problems(
    task: Task, site: Site, drives: Drives, resources: tuple[ResourceLimit, ...], estimates: Sequence[BranchEstimate]
) -> tuple[str, ...]:
    """Return a sentence about each limit that the mission will exceed, for the branch most likely to exceed it."""
    found = []
    home = site.home(task.composition.nominal, site.start)
    alone = 0.0 if home.xy == site.start.xy else drives.between(site.start, home).length_m
    for number, resource in enumerate(resources):
        worst = max(estimates, key=lambda b: b.chances[number].chance)
        chance = worst.chances[number]
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
        elif chance.exceeded and resource.kind == "reserve" and worst.charges is not None:
            found.append(
                message(
                    "the charge may fall below the reserve before the robot is at the charger or home: {chance} %"
                    " chance, but only {accepted} % is accepted",
                    chance=say_rounded(100 * chance.chance),
                    accepted=say_rounded(100 * resource.failure_probability),
                )
            )
        elif chance.exceeded and worst.visits:
            found.append(
                message(
                    "{budget} of {limit} {unit} may not be enough for the visits that are forecast: {chance}% chance of"
                    " running short, but only {accepted}% is accepted",
                    budget=name,
                    limit=say_rounded(resource.limit),
                    unit=unit,
                    chance=say_rounded(100 * chance.chance),
                    accepted=say_rounded(100 * resource.failure_probability),
                )
            )
        elif chance.exceeded:
            used = {"distance_m": worst.metres, "duration_s": worst.seconds}.get(resource.kind, worst.percent)
            found.append(
                message(
                    "{budget} of {limit} {unit} is not enough for what must be done: it takes {need} {unit} on average"
                    " and up to {high} {unit} nine times out of ten, {chance} % chance of running short, but"
                    " only {accepted} % is accepted",
                    budget=name,
                    limit=say_rounded(resource.limit),
                    unit=unit,
                    need=say_rounded(used.mean),
                    high=say_rounded(used.p90),
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
