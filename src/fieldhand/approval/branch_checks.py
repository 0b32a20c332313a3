"""Problems on the branches of a mission, with an independent check of every drive against zones and rows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from fieldhand.approval.problem import PlanProblem, node_in
from fieldhand.errors import DriveFault
from fieldhand.forecast.branches import Branches
from fieldhand.forecast.estimate import Estimate
from fieldhand.forecast.walk_steps import Walk, WalkStep
from fieldhand.language import message
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task
from fieldhand.wording.branches import say_decisions
from fieldhand.wording.steps import say_place

#: Metres by which a drive may enter a keep-out zone or leave the boundary, to allow for rounding.
TOLERANCE_M = 0.01


def branch_problems(explored: Branches, task: Task, site: Site, robot: RobotProfile) -> Iterator[PlanProblem]:
    """Yield the problems of every branch: unreachable places, tests of readings never taken, forbidden drives."""
    for broken in explored.broken:
        error, on = broken.error, say_decisions(broken.decisions, task, robot)
        what = message("{what} (on the branch: {branch})", what=error.what, branch=on) if on else error.what
        node, where = node_in(error.where)
        node = broken.node if not node and isinstance(error, DriveFault) else node
        yield PlanProblem(node=node, where=where, what=what, advice=error.advice)
    walks = (*explored.walks, *explored.optional_walks)
    yield from _unread(walks, task, robot)
    steps = (*(s for w in walks for s in w.steps), *(s for b in explored.broken for s in b.steps))
    for node, through in driven_through(steps, site):
        yield PlanProblem(
            node=node,
            where=site.name,
            what=message("the drive there goes {through}", through=through),
            advice=message("choose other trees, or another way"),
        )
    if not explored.complete:
        yield PlanProblem(
            where=message("plan"),
            what=message("the plan has more branches than the {count} that were checked", count=len(explored.walks)),
            advice=message("nest fewer conditions, or supervise the mission"),
            severity="warning",
        )


def exit_problems(forecast: Estimate, site: Site) -> Iterator[PlanProblem]:
    """Yield the problems of the exit routes after faults."""
    for place, home, error in forecast.exits.broken:
        yield PlanProblem(
            where=site.name,
            what=message(
                "after a fault at {place} there is no way to {home}: {why}",
                place=say_place(place),
                home=say_place(home),
                why=error.what,
            ),
            advice=message("correct the site; otherwise the robot will stop where it is at that moment"),
            severity="warning",
        )
    for node, through in driven_through(forecast.exits.steps, site):
        yield PlanProblem(
            node=node,
            where=site.name,
            what=message("the way home from there after a fault goes {through}", through=through),
            advice=message("choose other trees, or another way"),
        )


def _unread(walks: Sequence[Walk], task: Task, robot: RobotProfile) -> Iterator[PlanProblem]:
    """Yield tests of readings that are missing on a branch; warnings if only a fault or the budget leads there."""
    found: dict[tuple[str, str], Walk] = {}
    for walked in sorted(walks, key=_troubled):
        for node, reading in walked.unread:
            found.setdefault((node, reading), walked)
    for (node, reading), walked in found.items():
        on = say_decisions(walked.decisions, task, robot)
        what = message("it tests the reading '{reading}', which has not been taken by then", reading=reading)
        yield PlanProblem(
            node=node,
            where=message("plan"),
            what=message("{what} (on the branch: {branch})", what=what, branch=on) if on else what,
            advice=message(
                "take the reading on every branch before it is tested; a test of an unknown reading is not met"
            ),
            severity="warning" if _troubled(walked) else "error",
        )


def _troubled(walked: Walk) -> bool:
    """Return True if an action failed on the branch or the budget ran out for an optional step."""
    return any(d.answer is (d.kind != "taken") for d in walked.decisions if d.kind != "holds")


def driven_through(walked: Iterable[WalkStep], site: Site) -> tuple[tuple[str, str], ...]:
    """Return each forbidden crossing: node id of the drive and description ("through the keep-out “pond”")."""
    rows = [row for row in site.planting.rows if len(row.trees) > 1]
    if not site.zones and not rows:
        return ()
    from shapely import STRtree
    from shapely.geometry import LineString
    from shapely.ops import unary_union

    tree_lines = STRtree([LineString(site.xy[row.trees]) for row in rows])

    # Driving along an edge is allowed: only the interior of a keep-out zone and the exterior of the site count.
    keep_outs = [(z.name, z.polygon.buffer(-TOLERANCE_M)) for z in site.zones_of("keep_out")]
    boundaries = site.zones_of("boundary")
    inside = unary_union([b.polygon for b in boundaries]).buffer(TOLERANCE_M) if boundaries else None
    found: dict[tuple[str, str], None] = {}
    seen: set[tuple[tuple[float, float], ...]] = set()
    for step in walked:
        if step.drive is None or step.drive.points in seen:
            continue
        seen.add(step.drive.points)
        line = LineString(step.drive.points)
        for k in tree_lines.query(line, predicate="intersects").tolist():
            found[step.node.id, message("through the trees of row {row}", row=rows[k].name)] = None
        for name, polygon in keep_outs:
            if line.intersects(polygon) and line.intersection(polygon).length > TOLERANCE_M:
                found[step.node.id, message("through the keep-out “{zone}”", zone=name)] = None
        if inside is not None and line.difference(inside).length > TOLERANCE_M:
            found[step.node.id, message("outside the boundary")] = None
    return tuple(found)
