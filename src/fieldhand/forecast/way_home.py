"""Check whether an assumed way home takes too large a share of a budget for optional visits."""

from __future__ import annotations

from fieldhand.errors import DriveFault
from fieldhand.forecast.resource_limits import resource_limits
from fieldhand.forecast.visit_order import drives_for, start_place
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task, Then
from fieldhand.task.plan import walk

#: The way home may take this part of a budget before it is left out of a mission that did not ask for it.
MAX_SHARE = 1 / 3


def excessive_way_home(task: Task, site: Site, robot: RobotProfile, then: Then) -> float | None:
    """Return the metres of the way home from the start if it takes much of a budget for optional visits.

    A mission that visits as many trees as a budget allows would spend the budget on the way home in place of trees.

    Args:
        task: With its budgets; only one with optional visits is looked at.
        then: The exit that is assumed.

    Returns:
        None where the way home is worth it, or leads nowhere.
    """
    optional = any(n.is_optional and n.visits_each for n in walk(task.composition.plan))
    if not task.constraints.budgets or not optional:
        return None
    drives = drives_for(site, robot)
    start = start_place(drives)
    home = site.home(then, start)
    if home.xy == start.xy:
        return None
    try:
        metres = drives.between(start, home).length_m
    except DriveFault:
        return None
    for resource in resource_limits(task.constraints, robot):
        if resource.kind == "reserve":
            continue
        if metres * resource.per_metre > MAX_SHARE * resource.limit:
            return metres
    return None
