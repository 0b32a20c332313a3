"""Walk a Task along one branch without a robot, to find its drives, visiting order and work."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.forecast import visit_order
from fieldhand.forecast.optional_work import LikelyOptionalWork
from fieldhand.forecast.request_handler import ForecastHandler, OptionalWorkPolicy
from fieldhand.forecast.walk_state import Answers, ReadingsAnswer, nothing
from fieldhand.forecast.walk_steps import NodeAnswer, Walk, never
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.earlier import site_of_run
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives


def walk_branch(
    task: Task,
    site: Site,
    robot: RobotProfile,
    *,
    holds: NodeAnswer,
    fails: NodeAnswer = never,
    measured: ReadingsAnswer = nothing,
    drives: Drives | None = None,
    charge_percent: float = 100.0,
    optional: OptionalWorkPolicy | None = None,
) -> Walk:
    """Walk a Task from the start of the site to its exit with given answers, even contradictory ones.

    Args:
        task: The Task.
        site, robot: The site and the robot.
        holds: Called with the id of each ``If`` that is reached, and of a loop with ``until`` after each of its rounds.
        fails: Called with the id of each action inside a ``Try``; actions outside of one never fail in a forecast.
        measured: Called with the id of each action whose readings the plan uses as a series; unknown by default.
        drives: Drives between places of the site; None to compute them.
        charge_percent: Battery charge at the start of the mission, 0 to 100.
        optional: Policy for optional visits and steps; by default the most probable ones are made.

    Raises:
        PlaceError: A selector gives no place, or several where one is needed; ``where`` names the node.
        DriveFault: A place cannot be reached.
        TaskError: The walk exceeds ``MAX_NODES`` nodes.
    """
    site = site_of_run(task, site)
    ways = drives or visit_order.drives_for(site, robot, task.constraints)
    walker = ForecastHandler(
        task,
        site,
        robot,
        ways,
        Answers(holds=holds, fails=fails, measured=measured),
        charge_percent,
        optional=optional or LikelyOptionalWork({}),
    )
    return walker.run((task.composition.plan,))
