"""Check what a mission keeps away from and where it drives slowly.

These places exist on the site, and start, end and the places of the plan can still be reached.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from fieldhand.approval.problem import PlanProblem
from fieldhand.errors import PlaceError
from fieldhand.forecast.closed_ground import avoided, say_avoided
from fieldhand.forecast.slow_ground import say_slow_ground, slow_problem
from fieldhand.forecast.visit_order import drives_for
from fieldhand.language import message
from fieldhand.language.words import say_gate
from fieldhand.places.wording import say_places
from fieldhand.robot.model import RobotProfile
from fieldhand.site.drives import Drives
from fieldhand.site.model import Place, Site
from fieldhand.task.frames import Task
from fieldhand.wording.steps import say_place

Closed = list[tuple[Place, str]]


def way_problems(task: Task, site: Site, robot: RobotProfile) -> Iterator[PlanProblem]:
    """Yield the problems of what a mission keeps away from: it is unknown, without extent, or contains the start."""
    constraints = task.constraints
    for slow in constraints.slow:
        if (error := slow_problem(slow, site, robot)) is not None:
            where = message("drive slowly {where}", where=say_slow_ground(slow))
            yield PlanProblem(where=where, what=error.what, advice=error.advice)
    if not (constraints.avoid or constraints.only_gates):
        return
    whole = drives_for(site, robot)
    unknown = False
    for avoid in constraints.avoid:
        try:
            avoided(avoid, whole)
        except PlaceError as error:
            unknown = True
            yield PlanProblem(
                where=message("avoid {places}", places=say_avoided(avoid.places)), what=error.what, advice=error.advice
            )
    for only in constraints.only_gates:
        if not any(gate.place.id == only.gate for gate in site.gates):
            unknown = True
            names = say_places(tuple(say_gate(gate.place.id) for gate in site.gates))
            has = message("it has {gates}", gates=names) if site.gates else message("it has no gates")
            yield PlanProblem(
                where=message("only through {gate}", gate=say_gate(only.gate)),
                what=message("the site has no such gate"),
                advice=has,
            )
    if unknown:
        return
    reason = drives_for(site, robot, constraints).problem(site.start)
    if reason and not whole.problem(site.start):
        yield PlanProblem(
            where=site.name,
            what=message("{place}, where the robot begins, is {reason}", place=say_place(site.start), reason=reason),
            advice=message("keep away from less, or let the mission start elsewhere"),
        )


def by_rules(closed: Closed, whole: Drives) -> tuple[Closed, Closed]:
    """Return the unreachable places that only the mission's own rules close, and the others.

    Args:
        closed: Unreachable places, each with the reason.
        whole: Drives without those rules.
    """
    anyway = whole.problems([place for place, _ in closed])
    ruled = [one for one, reason in zip(closed, anyway, strict=True) if not reason]
    return ruled, [one for one, reason in zip(closed, anyway, strict=True) if reason]


def rule_problems(closed: Closed, node: str, site: Site) -> Iterator[PlanProblem]:
    """Yield one problem for all places of a node that are closed for the same reason."""
    for reason in dict.fromkeys(reason for _, reason in closed):
        places = [place for place, why in closed if why == reason]
        if len(places) == 1:
            what = message("{place} is {reason}", place=say_place(places[0]), reason=reason)
        else:
            what = message("{places} are {reason}", places=_say_places(places), reason=reason)
        yield PlanProblem(
            node=node,
            where=site.name,
            what=what,
            advice=message("leave out these places, or let the robot drive there"),
        )


def _say_places(places: Sequence[Place]) -> str:
    if all(place.kind == "tree" for place in places):
        return message("the trees {trees}", trees=say_places(tuple(place.id for place in places), few=5))
    return say_places(tuple(say_place(place) for place in places), few=5)
