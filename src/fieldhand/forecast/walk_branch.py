"""Walk a Task along one branch without a robot: drives, order and work."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.forecast import visit_order
from fieldhand.forecast.optional_work import LikelyOptionalWork
from fieldhand.forecast.request_handler import ForecastHandler, OptionalWorkPolicy
from fieldhand.forecast.walk_state import Answers
from fieldhand.forecast.walk_steps import Answer, Walk, never
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives


def walk_branch(
    task: Task,
    site: Site,
    robot: RobotProfile,
    *,
    holds: Answer,
    fails: Answer = never,
    drives: Drives | None = None,
    charge_percent: float = 100.0,
    optional: OptionalWorkPolicy | None = None,
) -> Walk:
    """Walk a Task from the start of the site to its exit for any answers, even on an impossible branch.

    Args:
        task: The Task.
        site, robot: The site and the robot.
        holds: Asked for the id of each ``If`` that is reached, and of a loop with ``until`` after each of its rounds.
        fails: Asked for the id of each action inside a ``Try``; what is outside one does not fail in a forecast.
        drives: The ways of the site, if the caller has them; they remember what they found.
        charge_percent: Charge at the beginning.
        optional: Decides on optional visits and steps; by default those are taken that missions probably do.

    Raises:
        PlaceError: A selector gives nothing, or several places where one is needed; ``where`` names the node.
        DriveFault: A place that cannot be reached.
        TaskError: It comes to more than ``MAX_NODES`` nodes.
    """
    ways = drives or visit_order.drives_for(site, robot)
    walker = ForecastHandler(
        task,
        site,
        robot,
        ways,
        Answers(holds=holds, fails=fails),
        charge_percent,
        optional=optional or LikelyOptionalWork({}),
    )
    return walker.run((task.composition.plan,))
