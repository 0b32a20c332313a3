"""The random mission of a seed: a scene, a plan, and limits relative to what the plan needs, so that many bind."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from fieldhand.errors import DriveFault, PlaceError
from fieldhand.forecast.mission_state import Spent
from fieldhand.forecast.resource_limits import reserve_percent, speed_of
from fieldhand.forecast.walk_branch import walk_branch
from fieldhand.forecast.walk_steps import NodeAnswer
from fieldhand.robot.capabilities import measures_of
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task import plan
from fieldhand.task.build import FAULTED_EXITS, make_task
from fieldhand.task.frames import Budget, BudgetKind, Constraints, FaultedExit, Resource, Task, Then
from fieldhand.task.plan import ForEach, Node
from fieldhand_bench.families import FAMILIES, RandomChoices
from fieldhand_bench.scenes import MOST_TREES, random_robot, random_site

#: Accepted failure probabilities.
PF = (0.05, 0.1, 0.2)

#: Limits of a mission by name: budgets and share of missions. ``charge`` starts with so little that the reserve binds.
LIMITED: Mapping[str, tuple[tuple[BudgetKind, ...], float]] = {
    "distance": (("distance_m",), 0.25),
    "time": (("duration_s",), 0.25),
    "energy": (("energy_percent",), 0.2),
    "two budgets": ((), 0.15),
    "charge": ((), 0.15),
}
_KINDS: tuple[BudgetKind, ...] = ("distance_m", "duration_s", "energy_percent")
_HOMES: tuple[tuple[Then, float], ...] = (("return_to_end", 0.45), ("return_to_start", 0.3), ("stay", 0.25))

#: Ranges of limit over requirement. Mandatory work needs the whole requirement, so its range begins higher.
_OPTIONAL, _MANDATORY = (0.3, 1.5), (0.7, 1.8)
#: Percent of the battery that a mission limited by its charge needs; the capacity is scaled to match.
_NEEDS_PERCENT = (4.0, 40.0)


@dataclass(frozen=True, kw_only=True)
class Draft:
    """A mission before it is approved.

    Attributes:
        seed: Random seed of the whole mission.
        attempt: Number of the draw with that seed, from 0; drafts that are not approved are drawn again.
        family: A name of :data:`fieldhand_bench.families.FAMILIES`.
        limited: A name of :data:`LIMITED`.
        factor: Limit divided by the mean requirement of everything that is requested.
        failure_probability: Accepted probability of exceeding each limit.
        charge_percent: Battery charge at the start, percent.
        flight_seed: Random seed of the simulation.
    """

    seed: int
    attempt: int
    family: str
    limited: str
    factor: float
    failure_probability: float
    site: Site
    robot: RobotProfile
    task: Task
    charge_percent: float
    flight_seed: int


def family_of(seed: int) -> str:
    """Return the family of a seed; successive seeds cycle through the families, so that all are equally common."""
    return tuple(FAMILIES)[seed % len(FAMILIES)]


def draw(seed: int, attempt: int = 0, most_trees: int = MOST_TREES) -> Draft | None:
    """Return the mission of a seed, or None if this draw requests something that the site does not have."""
    rng = np.random.default_rng([1872, seed, attempt])
    site, robot = random_site(rng, most_trees), random_robot(rng)
    family = family_of(seed)
    task = _task(rng, FAMILIES[family](RandomChoices(rng, site, robot)), site, robot)
    try:
        needed = needs(task, site, robot)
    except (PlaceError, DriveFault):
        return None
    names = tuple(LIMITED)
    limited = names[int(rng.choice(len(names), p=[share for _, share in LIMITED.values()]))]
    pf = float(rng.choice(PF))
    low, high = _MANDATORY if family == "mandatory" else _OPTIONAL
    factor = float(rng.uniform(low, high))
    charge = 100.0
    if limited == "charge":
        # The reserve has no probability of its own: it uses that of the budgets, or the default without any.
        pf = Budget.failure_probability
        share = float(rng.uniform(*_NEEDS_PERCENT))
        capacity = max(robot.energy.capacity_j * needed.percent / share, 1.0)
        robot = replace(robot, energy=replace(robot.energy, capacity_j=capacity))
        charge = min(100.0, reserve_percent(task.constraints, robot) + share * factor)
    else:
        task = replace(task, constraints=replace(task.constraints, budgets=_budgets(rng, limited, needed, factor, pf)))
    return Draft(
        seed=seed,
        attempt=attempt,
        family=family,
        limited=limited,
        factor=factor,
        failure_probability=pf,
        site=site,
        robot=robot,
        task=task,
        charge_percent=charge,
        flight_seed=int(rng.integers(2**31)),
    )


def needs(task: Task, site: Site, robot: RobotProfile) -> Spent:
    """Return the mean requirement of a Task without limits, all optional visits included."""
    whole = replace(task.composition, plan=_all_of(task.composition.plan))
    everything = replace(task, composition=whole, constraints=replace(task.constraints, budgets=()))
    walked = walk_branch(everything, site, robot, holds=_longest(whole.plan))
    metres = sum(walked.legs_m)
    work_s, work_j = walked.work
    seconds = metres / speed_of(task.constraints, robot) + work_s
    return Spent(metres=metres, seconds=seconds, percent=robot.percent(metres, seconds, work_j))


def _task(rng: np.random.Generator, root: Node, site: Site, robot: RobotProfile) -> Task:
    homes = [then for then, _ in _HOMES]
    nominal = homes[int(rng.choice(len(homes), p=[share for _, share in _HOMES]))]
    # As in planned missions: on a low budget drive to the end, or to the start if the request says so.
    low: Then = "return_to_end" if nominal == "stay" and rng.random() < 0.5 else nominal
    exits = tuple(FaultedExit(fault=e.fault, then=low) if e.fault == "low_budget" else e for e in FAULTED_EXITS)
    return make_task(
        request="drawn by chance",
        plan=root,
        measures=measures_of(robot),
        resources=(
            Resource(kind="robot", name=robot.name, sha256=robot.sha256),
            Resource(kind="site", name=site.name, sha256=site.sha256),
        ),
        constraints=Constraints(
            reserve_percent=round(float(rng.uniform(5.0, 30.0)), 1) if rng.random() < 0.3 else None,
            speed_m_s=round(robot.speed_m_s * float(rng.uniform(0.5, 0.95)), 2) if rng.random() < 0.2 else None,
        ),
        nominal=nominal,
        faulted=exits,
    )


def _budgets(rng: np.random.Generator, limited: str, needed: Spent, factor: float, pf: float) -> tuple[Budget, ...]:
    kinds = LIMITED[limited][0] or tuple(_KINDS[k] for k in sorted(rng.choice(3, size=2, replace=False).tolist()))
    amount = {"distance_m": needed.metres, "duration_s": needed.seconds, "energy_percent": needed.percent}
    budgets = []
    for kind in kinds:
        wanted = amount[kind] * factor * (float(rng.uniform(0.85, 1.2)) if len(kinds) > 1 else 1.0)
        budgets.append(Budget(kind=kind, limit=max(round(wanted, 2), 0.01), failure_probability=pf))
    return tuple(budgets)


def _all_of(node: Node) -> Node:
    """Return the plan with every optional visit made mandatory."""
    whole = node.with_children([_all_of(child) for child in node.children])
    return replace(whole, optional=False) if isinstance(whole, ForEach) else whole


def _longest(root: Node) -> NodeAnswer:
    """Return answers for the longest branch: every condition adds its work, and no loop ends early."""
    branching = {n.id for n in plan.walk(root) if n.is_choice}
    return lambda node_id: node_id in branching
