"""Budget decisions on mandatory work, and the report of work that is given up (shed)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from fieldhand.errors import PlaceError
from fieldhand.execution.active_mission import ActiveMission, Ending
from fieldhand.execution.docking import ChargeFirst
from fieldhand.forecast.mission_state import Verdict, Visit, VisitChoice
from fieldhand.forecast.service import service_of
from fieldhand.language import message
from fieldhand.site.model import Place
from fieldhand.task import plan
from fieldhand.task.nodes.base import GivenUp
from fieldhand.task.plan import Node
from fieldhand.task.results import Shed
from fieldhand.task.run import StackFrame


class PlanOver(Exception):
    """Raised when the plan is over before its last node; :attr:`ActiveMission.ending` is its ending."""


def mandatory_visit(mission: ActiveMission, place: Place, work: Node) -> Visit:
    """Return a mandatory visit in the form that the guard expects."""
    seconds, joules = service_of(work, mission.robot)
    return Visit(place=place, service_s=seconds, service_j=joules, pace_m_s=mission.run.pace_m_s)


def mandatory_visits_left(mission: ActiveMission) -> list[Visit]:
    """Return the mandatory visits still to come of the open loops, innermost first."""
    tours = [frame.tour for frame in mission.run.outwards() if frame.tour is not None and not frame.node.is_optional]
    return [visit for tour in tours for visit in tour.still_to_come()]


def admit(mission: ActiveMission, visit: Visit, *, refused: Sequence[Place]) -> None:
    """Ask the guard whether mandatory work may be done, and carry out its refusal.

    Inside an optional visit or step, only that is given up. Otherwise the mission turns home, and all remaining work is
    reported as given up.

    Args:
        mission: The mission; its current node is about to drive or act.
        visit: The drive and the work in question.
        refused: Places of the node that stay undone if the guard refuses.

    Raises:
        GivenUp: The current optional visit or step is given up.
        Over: The mission turns home.
        ChargeFirst: The battery has to be charged first; then the guard is to be asked again.
    """
    verdict = mission.guard.admit(mission.state(), visit, mandatory_visits_left(mission))
    if verdict.go:
        return
    if verdict.charge_to:
        raise ChargeFirst(verdict.reason, verdict.charge_to)
    optional = mission.run.optional
    if optional is not None:
        at = optional.tour.place if optional.tour is not None else None
        report_shed(mission, optional.node.id, [at or visit.place], verdict, optional=True)
        raise GivenUp(optional.node.id)
    report_shed(mission, mission.run.frame.node.id, refused, verdict, optional=False)
    _miss(mission, mission.run.frames[:-1], verdict)
    mission.end(Ending(status="returned", exit="faulted", then=mission.exit_for("low_budget"), reason=verdict.reason))
    raise PlanOver


def shed_unreachable(mission: ActiveMission, why: str) -> str:
    """Give up the current optional visit or step because no way is left to it.

    Returns:
        Id of the optional node; empty if there is none, or if a nearer try/otherwise catches the fault.
    """
    for frame in mission.run.outwards():
        if frame.instead:
            return ""
        if frame.node.is_optional:
            places = [] if frame.tour is None or frame.tour.place is None else [frame.tour.place]
            never = VisitChoice(index=None, reason=why, cause="unreachable")
            report_shed(mission, frame.node.id, places, never, optional=True)
            return frame.node.id
    return ""


def shed_rest(mission: ActiveMission, place: Place | None, verdict: Verdict) -> None:
    """Report the current work and all later work as given up.

    Args:
        mission: The mission.
        place: Place of the current drive or action, if there is one.
        verdict: Reason.
    """
    frames = mission.run.frames
    if not frames:
        return
    optional = mission.run.optional
    if optional is not None:
        tour = optional.tour
        places = [] if tour is None else [*([] if tour.place is None else [tour.place]), *tour.undone()]
        report_shed(mission, optional.node.id, places, verdict, optional=True)
        frames = frames[: frames.index(optional)]
    else:
        report_shed(mission, frames[-1].node.id, [] if place is None else [place], verdict, optional=False)
    _miss(mission, frames, verdict)


def _miss(mission: ActiveMission, frames: Sequence[StackFrame], verdict: Verdict) -> None:
    """Report the work after the current node, which will not be reached."""
    why = message("not reached: {why}", context="log", why=verdict.reason)
    missed = Verdict(go=False, reason=why, chance_short=verdict.chance_short, cause=verdict.cause)
    for node, places, optional in _left_undone(mission, frames):
        report_shed(mission, node.id, places, missed, optional=optional)


def _left_undone(mission: ActiveMission, frames: Iterable[StackFrame]) -> Iterator[tuple[Node, Sequence[Place], bool]]:
    """Yield the remaining work of the current nodes: (node, places as far as known, True if optional)."""
    for frame in reversed(list(frames)):
        if frame.tour is not None and (undone := frame.tour.undone()):
            yield frame.node, undone, frame.node.is_optional
        for later in frame.left:
            yield from _work_of(later, mission)


def _work_of(node: Node, mission: ActiveMission) -> Iterator[tuple[Node, Sequence[Place], bool]]:
    if node.is_series:
        for step in node.children:
            yield from _work_of(step, mission)
    elif not node.ends_plan:
        places = first_places_of(node, mission) if node.is_optional_step else _places_of(node, mission)
        yield node, places, node.is_optional


def first_places_of(node: Node, mission: ActiveMission) -> tuple[Place, ...]:
    """Return the places at which a node begins, as far as they are known now."""
    first = next((inner for inner in plan.walk(node) if inner.selector is not None), node)
    return _places_of(first, mission)


def _places_of(node: Node, mission: ActiveMission) -> tuple[Place, ...]:
    selector = node.selector
    if selector is None or selector.relative:
        return ()
    try:
        return mission.resolve(selector)
    except PlaceError:
        return ()


def report_shed(
    mission: ActiveMission,
    node: str,
    places: Sequence[Place],
    verdict: Verdict | VisitChoice,
    *,
    optional: bool,
) -> None:
    """Report work that is given up, with the reason."""
    mission.emit(
        Shed(
            t=mission.t,
            node=node,
            places=tuple(p.id for p in places),
            optional=optional,
            reason=verdict.reason,
            chance_short=verdict.chance_short,
            cause=verdict.cause,
            names_places=isinstance(verdict, VisitChoice) and verdict.names_places,
        )
    )
