"""Budget decisions on mandatory work, and the report of work that is given up (shed)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Literal

from fieldhand.errors import PlaceError
from fieldhand.execution.attempt import Attempt, Ending
from fieldhand.forecast.mission_state import Verdict, Visit, VisitChoice
from fieldhand.forecast.service import service_of
from fieldhand.language import message
from fieldhand.site.model import Place
from fieldhand.task import plan
from fieldhand.task.nodes.base import GivenUp
from fieldhand.task.plan import Node
from fieldhand.task.results import Shed
from fieldhand.task.run import StackFrame


class Over(Exception):
    """Raised when the plan is over before its last node; :attr:`Attempt.ending` is its ending."""


def visit_to(attempt: Attempt, place: Place, work: Node) -> Visit:
    """Return a mandatory visit in the form that the guard expects."""
    seconds, joules = service_of(work, attempt.robot)
    return Visit(place=place, service_s=seconds, service_j=joules)


def to_come(attempt: Attempt) -> list[Visit]:
    """Return the mandatory visits still to come of the open loops, innermost first."""
    tours = [frame.tour for frame in attempt.run.outwards() if frame.tour is not None and not frame.node.is_optional]
    return [visit for tour in tours for visit in tour.still_to_come()]


def admit(attempt: Attempt, visit: Visit, *, refused: Sequence[Place]) -> None:
    """Ask the guard whether mandatory work may be done, and carry out its refusal.

    Inside an optional visit or step, only that is given up. Otherwise the mission turns home, and all remaining work is
    reported as given up.

    Args:
        attempt: The mission; its current node is about to drive or act.
        visit: The drive and the work in question.
        refused: Places of the node that stay undone if the guard refuses.

    Raises:
        GivenUp: The current optional visit or step is given up.
        Over: The mission turns home.
    """
    verdict = attempt.guard.admit(attempt.state(), visit, to_come(attempt))
    if verdict.go:
        return
    optional = attempt.run.optional
    if optional is not None:
        at = optional.tour.place if optional.tour is not None else None
        shed(attempt, optional.node.id, [at or visit.place], verdict, optional=True)
        raise GivenUp(optional.node.id)
    shed(attempt, attempt.run.frame.node.id, refused, verdict, optional=False)
    _miss(attempt, attempt.run.frames[:-1], verdict)
    attempt.end(Ending(status="returned", exit="faulted", then=attempt.exit_for("low_budget"), reason=verdict.reason))
    raise Over


def give_up_unreachable(attempt: Attempt, why: str) -> str:
    """Give up the current optional visit or step because no way is left to it.

    Returns:
        Id of the optional node; empty if there is none, or if a nearer try/otherwise catches the fault.
    """
    for frame in attempt.run.outwards():
        if frame.instead:
            return ""
        if frame.node.is_optional:
            places = [] if frame.tour is None or frame.tour.place is None else [frame.tour.place]
            never = VisitChoice(index=None, reason=why)
            shed(attempt, frame.node.id, places, never, optional=True, cause="unreachable")
            return frame.node.id
    return ""


def give_up_rest(attempt: Attempt, place: Place | None, verdict: Verdict) -> None:
    """Report the current work and all later work as given up.

    Args:
        attempt: The mission.
        place: Place of the current drive or action, if there is one.
        verdict: Reason.
    """
    frames = attempt.run.frames
    if not frames:
        return
    optional = attempt.run.optional
    if optional is not None:
        tour = optional.tour
        places = [] if tour is None else [*([] if tour.place is None else [tour.place]), *tour.undone()]
        shed(attempt, optional.node.id, places, verdict, optional=True)
        frames = frames[: frames.index(optional)]
    else:
        shed(attempt, frames[-1].node.id, [] if place is None else [place], verdict, optional=False)
    _miss(attempt, frames, verdict)


def _miss(attempt: Attempt, frames: Sequence[StackFrame], verdict: Verdict) -> None:
    """Report the work after the current node, which will not be reached."""
    why = message("not reached: {why}", context="log", why=verdict.reason)
    missed = Verdict(go=False, reason=why, chance_short=verdict.chance_short)
    for node, places, optional in _left_undone(attempt, frames):
        shed(attempt, node.id, places, missed, optional=optional)


def _left_undone(attempt: Attempt, frames: Iterable[StackFrame]) -> Iterator[tuple[Node, Sequence[Place], bool]]:
    """Yield the remaining work of the current nodes: (node, places as far as known, True if optional)."""
    for frame in reversed(list(frames)):
        if frame.tour is not None and (undone := frame.tour.undone()):
            yield frame.node, undone, frame.node.is_optional
        for later in frame.left:
            yield from _work_of(later, attempt)


def _work_of(node: Node, attempt: Attempt) -> Iterator[tuple[Node, Sequence[Place], bool]]:
    if node.is_series:
        for step in node.children:
            yield from _work_of(step, attempt)
    elif not node.ends_plan:
        places = first_places_of(node, attempt) if node.is_optional_step else _places_of(node, attempt)
        yield node, places, node.is_optional


def first_places_of(node: Node, attempt: Attempt) -> tuple[Place, ...]:
    """Return the places at which a node begins, as far as they are known now."""
    first = next((inner for inner in plan.walk(node) if inner.selector is not None), node)
    return _places_of(first, attempt)


def _places_of(node: Node, attempt: Attempt) -> tuple[Place, ...]:
    selector = node.selector
    if selector is None or selector.relative:
        return ()
    try:
        return attempt.resolve(selector)
    except PlaceError:
        return ()


def shed(
    attempt: Attempt,
    node: str,
    places: Sequence[Place],
    verdict: Verdict | VisitChoice,
    *,
    optional: bool,
    cause: Literal["budget", "unreachable"] = "budget",
) -> None:
    """Report work that is given up, with the reason."""
    attempt.emit(
        Shed(
            t=attempt.t,
            node=node,
            places=tuple(p.id for p in places),
            optional=optional,
            reason=verdict.reason,
            chance_short=verdict.chance_short,
            cause=cause,
        )
    )
