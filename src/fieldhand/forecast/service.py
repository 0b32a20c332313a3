"""What the work at one place takes, drives not included, and what a visit is worth."""

from __future__ import annotations

import math

from fieldhand.forecast.state import Work
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task.plan import Act, AnyOrder, ForEach, If, Node, Repeat, Sequence, Stop, Try


def service_of(node: Node, robot: RobotProfile) -> tuple[float, float]:
    """Seconds and joules of a node's actions on its longest branch.

    An ``If`` counts the longer of its two sides, a ``Try`` its body and then its otherwise, a ``Repeat`` all of its
    rounds. A ``ForEach`` inside counts its ``at_most`` visits, or one where the site decides how many there are. Drives
    inside the node are not counted, and neither is idle power, nor an ``Optional``: it is decided on by itself.

    Raises:
        KeyError: An action that the robot does not have; a Task that was checked names none.
    """
    match node:
        case Act():
            action = robot.action[node.action]
            return (node.count * action.duration_s, node.count * action.energy_j)
        case Sequence(steps=steps) | AnyOrder(steps=steps):
            seconds = joules = 0.0
            for step in steps:
                if isinstance(step, Stop):
                    break
                more_s, more_j = service_of(step, robot)
                seconds, joules = seconds + more_s, joules + more_j
            return (seconds, joules)
        case Repeat(times=times, body=body):
            seconds, joules = service_of(body, robot)
            return (times * seconds, times * joules)
        case ForEach(at_most=at_most, body=body):
            seconds, joules = service_of(body, robot)
            visits = 1 if at_most is None else at_most
            return (visits * seconds, visits * joules)
        case If(then=then, otherwise=otherwise):
            one = service_of(then, robot)
            two = (0.0, 0.0) if otherwise is None else service_of(otherwise, robot)
            return (max(one[0], two[0]), max(one[1], two[1]))
        case Try(body=body, otherwise=fallback):
            one, two = service_of(body, robot), service_of(fallback, robot)
            return (one[0] + two[0], one[1] + two[1])
        case _:
            return (0.0, 0.0)


def tried_again(node: Act, robot: RobotProfile) -> Work:
    """What it takes to try a capture again as often as the robot does, with the waits between, until it has failed."""
    action = robot.action[node.action]
    retries = robot.retries if action.retries is None else action.retries
    wait_s = robot.patience.retry_wait_s if action.retry_wait_s is None else action.retry_wait_s
    return Work(seconds=retries * (action.duration_s + wait_s), joules=retries * action.energy_j)


def work_of(node: Node, robot: RobotProfile) -> Work:
    """:func:`service_of` as work."""
    seconds, joules = service_of(node, robot)
    return Work(seconds=seconds, joules=joules)


def reward_of(node: ForEach, place: Place, site: Site) -> float:
    """What a visit is worth: the tree's attribute that the for-each names (0 where it has none), else 1."""
    if not node.reward:
        return 1.0
    tree = site.by_id.get(place.id) if place.kind == "tree" else None
    value = None if tree is None else tree.properties.get(node.reward)
    if not isinstance(value, int | float) or not math.isfinite(value):
        return 0.0
    return max(0.0, float(value))
