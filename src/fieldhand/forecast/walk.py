"""A Task walked through without a robot: where it drives, in which order, what it does there, along one branch."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.forecast import routes
from fieldhand.forecast.drawn import Drawn
from fieldhand.forecast.steps import Answer, Walk, never
from fieldhand.forecast.walker import Walker
from fieldhand.forecast.ways import cost_model
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from fieldhand.forecast.expected import Expected
    from fieldhand.site.drives import Drives


def walk(
    task: Task,
    site: Site,
    robot: RobotProfile,
    *,
    holds: Answer,
    fails: Answer = never,
    drives: Drives | None = None,
    charge_percent: float = 100.0,
    seed: int | None = None,
    kept: dict[object, Expected] | None = None,
) -> Walk:
    """Walk a Task from the start of the site to its exit.

    Args:
        task: What to walk.
        site, robot: Where and with what.
        holds: Asked for the id of each ``If`` that is reached, and of a loop with ``until`` after each of its rounds.
        fails: Asked for the id of each action inside a ``Try``; what is outside one does not fail in a forecast.
        drives: The ways of the site, if the caller has them; they remember what they found.
        charge_percent: Charge at the beginning.
        seed: Of missions that are drawn along the walk (:attr:`Walk.used`); None for none.
        kept: What other walks of the same mission found of optional visits; added to.

    Raises:
        PlaceError: A selector gives nothing, or several places where one is needed; ``where`` names the node.
        DriveFault: A place that cannot be reached.
        TaskError: It comes to more than ``MAX_NODES`` nodes.
    """
    ways = drives or routes.drives_for(site, robot)
    drawn = None if seed is None else Drawn(cost_model(robot), seed)
    walker = Walker(task, site, robot, ways, holds, fails, charge_percent, drawn=drawn, kept=kept)
    return walker.run((task.composition.plan,))
