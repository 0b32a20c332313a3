"""Check of the share that an assumed way home takes of the budget for optional visits."""

from __future__ import annotations

from fieldhand.errors import DriveFault
from fieldhand.forecast.resource_limits import resource_limits
from fieldhand.forecast.visit_order import drives_for, start_place
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task, Then
from fieldhand.task.plan import walk

#: Fraction of a budget above which a way home that was not requested is left out.
MAX_SHARE = 1 / 3


def excessive_way_home(task: Task, site: Site, robot: RobotProfile, then: Then) -> float | None:
    """Return the length of the way home in metres, if it takes too much of a budget for optional visits.

    A mission that visits as many trees as its budget allows would otherwise spend the budget on the way home.

    Args:
        task: Task with its budgets; only one with optional visits is checked.
        then: The assumed exit.

    Returns:
        None if the way home is short enough, or no drive is needed.
    """
    optional = any(n.is_optional and n.visits_each for n in walk(task.composition.plan))
    if not task.constraints.budgets or not optional:
        return None
    drives = drives_for(site, robot, task.constraints)
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
