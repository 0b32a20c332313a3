"""Time and energy of the work at one place, excluding drives, and the reward of a visit."""

from __future__ import annotations

import itertools
import math

from fieldhand.forecast.mission_state import Work
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task.plan import Act, Node, Recharge


def service_of(node: Node, robot: RobotProfile) -> tuple[float, float]:
    """Return seconds and joules of a node's actions and waits on its longest branch.

    An ``If`` counts with the longer of its two sides, a ``Try`` with its body and its otherwise, a ``Repeat`` with all
    its rounds. A nested ``ForEach`` counts ``at_most`` visits, or one if the site determines their number. Drives and
    idle power are not counted, nor is an ``Optional``, which is decided separately.

    Raises:
        KeyError: The robot lacks an action, which does not happen with a checked Task.
    """
    if node.act is not None:
        action = robot.action[node.act.action]
        return (node.act.count * action.duration_s, node.act.count * action.energy_j)
    if node.recharge is not None:
        return _charging(node.recharge, robot)
    if node.is_optional_step:
        return (0.0, 0.0)
    if node.dwell_s:
        return (node.dwell_s, 0.0)
    done = itertools.takewhile(lambda child: not child.ends_plan, node.children)
    seconds, joules = zip((0.0, 0.0), *(service_of(child, robot) for child in done), strict=True)
    together = max if node.is_choice else sum
    times = (1 if node.rounds is None else node.rounds) * (1 if node.at_most is None else node.at_most)
    return (times * together(seconds), times * together(joules))


def _charging(node: Recharge, robot: RobotProfile) -> tuple[float, float]:
    """Return seconds and joules of a charge from the reserve. The charger supplies the robot's idle power."""
    charging, energy = robot.energy.charging, robot.energy
    if charging is None:
        return (0.0, 0.0)
    until = charging.until_percent if node.until_percent is None else node.until_percent
    full_s = float(charging.seconds(energy.reserve_percent, until, energy.capacity_j))
    seconds = full_s if node.duration_s is None else node.duration_s
    return (charging.around_s + seconds, charging.around_j - seconds * energy.idle_w)


def retry_work(node: Act, robot: RobotProfile) -> Work:
    """Return the work of all retries of a failing capture, including the waits between them."""
    action = robot.action[node.action]
    retries = robot.retries if action.retries is None else action.retries
    wait_s = robot.patience.retry_wait_s if action.retry_wait_s is None else action.retry_wait_s
    return Work(seconds=retries * (action.duration_s + wait_s), joules=retries * action.energy_j)


def work_of(node: Node, robot: RobotProfile) -> Work:
    """Return :func:`service_of` as work."""
    seconds, joules = service_of(node, robot)
    return Work(seconds=seconds, joules=joules)


def reward_of(node: Node, place: Place, site: Site) -> float:
    """Return the reward of a visit: the tree attribute named by the for-each (0 if the tree lacks it), by default 1."""
    if not node.rewarded_by:
        return 1.0
    tree = site.by_id.get(place.id) if place.kind == "tree" else None
    value = None if tree is None else tree.properties.get(node.rewarded_by)
    if not isinstance(value, int | float) or not math.isfinite(value):
        return 0.0
    return max(0.0, float(value))
