"""Time and energy of the work at one place, excluding drives, and the reward of a visit."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

from fieldhand.forecast.mission_state import Work
from fieldhand.robot.model import Action, RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task.plan import Act, Node, Recharge

#: Mean angle in degrees of turning to a plant and back: of every second one by 180 degrees each way.
_MEAN_TURN_DEG = 180.0

#: Share of the places of a ranking with which the worth of a visit halves.
_HALVES_WITH = 0.05


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
        return (node.act.count * action.duration_s + _turning_s(action, robot), node.act.count * action.energy_j)
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


def _turning_s(action: Action, robot: RobotProfile) -> float:
    """Return the mean seconds of turning on the spot for a camera and back."""
    if action.camera is None or robot.turn_deg_s is None:
        return 0.0
    return _MEAN_TURN_DEG / robot.turn_deg_s


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
    value = _value_of(node.rewarded_by, place, site)
    return 0.0 if value is None else max(0.0, value)


def rewards_of(node: Node, places: Sequence[Place], site: Site) -> list[float]:
    """Return the rewards of the visits of a for-each.

    By rank, the first is worth 1, and the worth halves with every 5 % of the places, so that a drive to a good one is
    worth more than several visits on the way. Equal values share the best of their ranks; a place without a value is
    worth nothing.
    """
    first = node.rewarded_first
    if not node.rewarded_by or first == "value":
        return [reward_of(node, place, site) for place in places]
    values = [_value_of(node.rewarded_by, place, site) for place in places]
    known = sorted((value for value in values if value is not None), reverse=first == "highest")
    ranks: dict[float, int] = {}
    for rank, value in enumerate(known, start=1):
        ranks.setdefault(value, rank)
    return [0.0 if value is None else 0.5 ** ((ranks[value] - 1) / (_HALVES_WITH * len(known))) for value in values]


def _value_of(attribute: str, place: Place, site: Site) -> float | None:
    """Return the number that an attribute of a tree is; None without one."""
    tree = site.by_id.get(place.id) if place.kind == "tree" else None
    value = None if tree is None else tree.properties.get(attribute)
    return float(value) if isinstance(value, int | float) and math.isfinite(value) else None
