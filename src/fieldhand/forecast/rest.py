"""What still has to be done after a node of a plan: the mandatory steps that follow, and the way home.

A mission's state does not say in which round of which loop it is. What is left of a for-each around the node are its
places at which the mission has not stopped; where these cannot be told (places relative to the robot), and for further
rounds of a repeat, nothing is set aside. Of an any-order set, the steps are left that begin at a place not yet visited.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.errors import DriveFault, PlaceError
from fieldhand.forecast import routes
from fieldhand.forecast.limits import speed_of
from fieldhand.forecast.steps import Answer
from fieldhand.forecast.walk import Walker
from fieldhand.robot.model import RobotProfile
from fieldhand.site.context import Context
from fieldhand.site.model import Place, Site
from fieldhand.task import plan
from fieldhand.task.frames import Task
from fieldhand.task.plan import AnyOrder, ForEach, Node
from fieldhand.task.selectors import is_relative

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

Following = Node | tuple[ForEach, tuple[Place, ...]]

_MAX_CONDITIONS = 4


@dataclass(frozen=True, kw_only=True)
class Rest:
    """What follows, on the branch that takes most.

    Attributes:
        first: Where it begins: the first place that is driven to; None where nothing more is driven.
        legs_m: Legs from there on, the way home included; the leg to ``first`` is not.
        seconds, joules: Of all actions.
        mandatory: Whether there is more in it than the way home.
    """

    first: Place | None
    legs_m: tuple[float, ...] = ()
    seconds: float = 0.0
    joules: float = 0.0
    mandatory: bool = False


def rest_after(
    task: Task,
    site: Site,
    robot: RobotProfile,
    drives: Drives,
    node_id: str,
    context: Context,
    *,
    loops: bool = True,
) -> Rest:
    """What must be done after a node, what is optional left out, on the branch that takes most.

    Args:
        task, site, robot, drives: The mission.
        node_id: The node that is being done.
        context: Where the robot is and has been.
        loops: Whether to add what is left of the loops around the node; not where the caller knows better.
    """
    nodes = following(task.composition.plan, node_id, site, context, loops=loops)
    speed = speed_of(task.constraints, robot)
    worst, most = Rest(first=None), -1.0
    inner = [x[0] if isinstance(x, tuple) else x for x in nodes]
    for holds in every_answer(inner):
        found = _walk_rest(Walker(task, site, robot, drives, holds, optional=False, context=context), nodes)
        seconds = sum(found.legs_m) / speed + found.seconds
        if found.first is not None:
            seconds += drives.between(context.here, found.first).length_m / speed
        if seconds > most:
            worst, most = found, seconds
    return worst


def following(root: Node, node_id: str, site: Site, context: Context, *, loops: bool = True) -> tuple[Following, ...]:
    """The nodes that come after one, in their order; a for-each that is under way with the places it has left."""
    way = routes.way_to(root, node_id)
    found: list[Following] = []
    for inner, outer in itertools.pairwise(reversed(way)):
        match outer:
            case plan.Sequence(steps=steps):
                position = next(i for i, step in enumerate(steps) if step is inner)
                found.extend(steps[position + 1 :])
            case AnyOrder(steps=steps):
                found.extend(s for s in steps if s is not inner and _begins_at_new_place(s, site, context))
            case ForEach(optional=False) if loops:
                left = _left_of(outer, site, context)
                if left:
                    found.append((outer, left))
            case _:
                pass
    return tuple(found)


def _walk_rest(walker: Walker, nodes: Sequence[Following]) -> Rest:
    try:
        walked = walker.run(nodes)
    except (PlaceError, DriveFault):
        # What cannot be resolved from here may be once the robot is there; then the way home alone is set aside.
        walker = Walker(
            walker.task,
            walker.site,
            walker.robot,
            walker.drives,
            lambda _: False,
            optional=False,
            context=walker.beginning,
        )
        walked = walker.run(())
    # Not the walk's own legs: where it begins by staying where it is, the robot will have to come back there.
    stops = walker.stops
    seconds, joules = walked.work
    return Rest(
        first=stops[0] if stops else None,
        legs_m=tuple(walker.drives.between(a, b).length_m for a, b in itertools.pairwise(stops) if a.xy != b.xy),
        seconds=seconds,
        joules=joules,
        mandatory=any(s.kind in ("drive", "act") for s in walked.steps),
    )


def every_answer(nodes: Sequence[Node]) -> list[Answer]:
    """Every way to answer the first few conditions of some nodes; those beyond them hold, or none of them does."""
    asked = [n.id for node in nodes for n in plan.walk(node) if plan.condition_of(n) is not None]
    if not asked:
        return [lambda _: False]
    some = asked[:_MAX_CONDITIONS]
    beyond = (True, False) if len(asked) > len(some) else (False,)
    return [
        _told(dict(zip(some, answers, strict=True)), default)
        for answers in itertools.product((True, False), repeat=len(some))
        for default in beyond
    ]


def _told(answers: dict[str, bool], default: bool) -> Answer:
    return lambda node_id: answers.get(node_id, default)


def _left_of(node: ForEach, site: Site, context: Context) -> tuple[Place, ...]:
    from fieldhand.site.places import resolve

    if is_relative(node.select):
        return ()
    try:
        places = resolve(node.select, site, context)
    except PlaceError:
        return ()
    left = tuple(p for p in places if p.id not in context.visited)
    return left if node.at_most is None else left[: max(0, node.at_most - (len(places) - len(left)))]


def _begins_at_new_place(node: Node, site: Site, context: Context) -> bool:
    try:
        places = routes.first_places(node, site, context)
    except PlaceError:
        return False
    return any(p.id not in context.visited for p in places)
