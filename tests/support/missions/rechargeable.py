"""A husky that can recharge, and one call that reviews a plan, approves it and simulates it."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from typing import Any

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.robot.capabilities import measures_of
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.build import make_task
from fieldhand.task.frames import Constraints, Resource, Task
from fieldhand.task.plan import Node
from fieldhand.task.results import Event

#: ``energy.charging`` of the profile: 400 W, less towards a full battery.
CHARGING: dict[str, Any] = {
    "dock": {"duration_s": 40, "energy_j": 800},
    "undock": {"duration_s": 20},
    "curve": [[0, 400], [80, 400], [100, 60]],
    "until_percent": 90,
}


@cache
def rechargeable(capacity_j: float = 150_000, alpha: float = 0.5, retries: int = 1, **charging: float) -> RobotProfile:
    """Return a husky with a charger, of which some values may differ, and a battery for about ten minutes."""
    return RobotProfile.load(
        "husky",
        changes={
            "energy": {"capacity_j": capacity_j, "charging": {**CHARGING, **charging}},
            "leg_cost": {"alpha": alpha},
            "retries": retries,
        },
    )


def task_of(plan: Node, site: Site, robot: RobotProfile, request: str = "x", **constraints: Any) -> Task:
    """Return a Task with these constraints."""
    return make_task(
        request=request,
        plan=plan,
        measures=measures_of(robot),
        resources=(
            Resource(kind="site", name=site.name, sha256=site.sha256),
            Resource(kind="robot", name=robot.name, sha256=robot.sha256),
        ),
        constraints=Constraints(**constraints),
    )


def simulated(task: Task, site: Site, robot: RobotProfile, seed: int = 0, world: World | None = None) -> mission.Run:
    """Return the simulated mission of a Task whose checks find no error."""
    approved = mission.authorize(mission.review(task, site, robot), by="tests", confirmed=EveryWarning())
    return mission.simulate(approved, seed=seed, world=world)


def kinds(events: Iterable[Event]) -> tuple[str, ...]:
    """Return the kinds of events in order, without drives and levels."""
    return tuple(e.event for e in events if e.event not in ("drive", "arrive", "limit", "visiting"))
