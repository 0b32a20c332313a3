"""Build a Task in Python, from plan nodes and selectors, without a planner."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.robot.capabilities import measures_of
from fieldhand.robot.model import RobotProfile
from fieldhand.site.earlier_missions import EarlierMissions
from fieldhand.site.model import Site
from fieldhand.task.build import make_task
from fieldhand.task.earlier import with_earlier
from fieldhand.task.frames import Budget, Constraints, Resource, Task, Then
from fieldhand.task.plan import Node
from fieldhand.task.watches import Watch
from fieldhand.task.ways import Avoid, OnlyGate, SlowNear


def build_task(
    plan: Node,
    site: Site,
    robot: RobotProfile,
    *,
    request: str = "",
    budgets: Sequence[Budget] = (),
    reserve_percent: float | None = None,
    then: Then = "return_to_end",
    avoid: Sequence[Avoid] = (),
    only_gates: Sequence[str] = (),
    watches: Sequence[Watch] = (),
    slow: Sequence[SlowNear] = (),
    earlier: EarlierMissions | None = None,
) -> Task:
    """Build a Task for a site and a robot; :func:`review` checks it as it checks every Task.

    Args:
        plan: The plan, made of :mod:`fieldhand.task.plan` nodes; their ids are assigned here and may be left empty.
        site: Site that the Task is for.
        robot: Robot that the Task is for.
        request: What the Task is for, in words; they appear on maps and in reports.
        budgets: Limits of distance, time or energy for the whole mission, the way home included.
        reserve_percent: Charge that must be left at the end, in percent; None for the robot's own reserve.
        then: Where the robot goes when the plan is done.
        avoid: Places that the robot keeps away from.
        only_gates: Names of the gates that it may pass; empty for all gates.
        watches: Conditions checked throughout the mission, each with its response.
        slow: Places at which the robot drives slowly.
        earlier: What earlier missions did on the site; the Task contains what its plan depends on.
    """
    task = make_task(
        request=request,
        plan=plan,
        measures=measures_of(robot),
        resources=(
            Resource(kind="robot", name=robot.name, sha256=robot.sha256),
            Resource(kind="site", name=site.name, sha256=site.sha256),
        ),
        constraints=Constraints(
            budgets=tuple(budgets),
            reserve_percent=reserve_percent,
            avoid=tuple(avoid),
            only_gates=tuple(OnlyGate(gate=gate) for gate in only_gates),
            slow=tuple(slow),
        ),
        nominal=then,
        watches=tuple(watches),
    )
    return task if earlier is None else with_earlier(task, earlier)
