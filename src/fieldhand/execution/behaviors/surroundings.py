"""What a behavior sees of the tree around it: who catches its failure, which loops it is in, what comes after it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Literal, Protocol, runtime_checkable

from py_trees.behaviour import Behaviour
from py_trees.composites import Selector as PyTreesSelector
from py_trees.composites import Sequence as PyTreesSequence

from fieldhand.errors import BlockedFault, PlaceError
from fieldhand.execution.attempt import Attempt, Ending
from fieldhand.forecast.service import service_of
from fieldhand.forecast.state import Choice, Verdict, Visit
from fieldhand.language import message
from fieldhand.site.model import Place
from fieldhand.task import plan
from fieldhand.task.plan import Node
from fieldhand.task.results import Shed
from fieldhand.task.selectors import is_relative

if TYPE_CHECKING:
    from fieldhand.execution.behaviors.loops import ForEachPlace
    from fieldhand.execution.behaviors.shedding import DoIfItFits


@runtime_checkable
class HasNode(Protocol):
    """A behavior that stands for a plan node."""

    node: Node


def ancestors(behavior: Behaviour) -> Iterator[tuple[Behaviour, Behaviour]]:
    """(parent, the child of it that we come from), innermost first."""
    child, parent = behavior, behavior.parent
    while parent is not None:
        yield parent, child
        child, parent = parent, parent.parent


def is_caught(behavior: Behaviour) -> bool:
    """Whether a try/otherwise around the behavior goes on if it fails."""
    return any(
        isinstance(parent, PyTreesSelector) and child is parent.children[0] for parent, child in ancestors(behavior)
    )


def loops(behavior: Behaviour) -> Iterator[ForEachPlace]:
    """The for-each loops around a behavior, innermost first."""
    from fieldhand.execution.behaviors.loops import ForEachPlace

    for parent, _ in ancestors(behavior):
        if isinstance(parent, ForEachPlace):
            yield parent


def to_come_around(behavior: Behaviour) -> list[Visit]:
    """The mandatory visits that are still to come of the loops around a behavior, in their order."""
    return [visit for loop in loops(behavior) if not loop.node.optional for visit in loop.still_to_come()]


def optional_around(behavior: Behaviour) -> ForEachPlace | DoIfItFits | None:
    """The optional visit or step that a behavior is part of; there is at most one of them around it."""
    from fieldhand.execution.behaviors.loops import ForEachPlace
    from fieldhand.execution.behaviors.shedding import DoIfItFits

    for parent, _ in ancestors(behavior):
        if isinstance(parent, DoIfItFits) or (isinstance(parent, ForEachPlace) and parent.node.optional):
            return parent
    return None


def visit_to(attempt: Attempt, place: Place, work: Node) -> Visit:
    """A mandatory visit as the guard sees it."""
    seconds, joules = service_of(work, attempt.robot)
    return Visit(place=place, service_s=seconds, service_j=joules)


def admitted(
    behavior: Behaviour,
    node: Node,
    attempt: Attempt,
    visit: Visit,
    *,
    refused: Sequence[Place],
    later: Sequence[Visit] = (),
) -> bool:
    """Ask the guard about mandatory work; where it says no, do what follows from that.

    Inside an optional visit or step only that is given up. Else the mission turns home, and all that it will not do is
    said.

    Args:
        behavior, node: What is about to drive or act.
        attempt: The state of the mission.
        visit: The drive and the work that it is about.
        refused: Places of the node that stay undone if the guard says no.
        later: Visits of the node itself that come after this one; those of the loops around it are added.
    """
    verdict = attempt.guard.admit(attempt.state(node.id), visit, [*later, *to_come_around(behavior)])
    if verdict.go:
        return True
    optional = optional_around(behavior)
    if optional is not None:
        shed(attempt, optional.node.id, [optional.place or visit.place], verdict, optional=True)
        attempt.giving_up = optional.node.id
    else:
        turn_home(behavior, node, attempt, refused, verdict)
    return False


def gives_up_optional(behavior: Behaviour, attempt: Attempt, fault: BlockedFault) -> bool:
    """Give up the optional visit or step around a behavior that no way leads to; False where none is nearer than a
    try/otherwise that would catch the fault."""
    optional = optional_around(behavior)
    if optional is None:
        return False
    for parent, child in ancestors(behavior):
        if isinstance(parent, PyTreesSelector) and child is parent.children[0]:
            return False
        if parent is optional:
            break
    given_up = [optional.place] if optional.place is not None else []
    shed(attempt, optional.node.id, given_up, Choice(index=None, reason=fault.what), optional=True, cause="unreachable")
    attempt.giving_up = optional.node.id
    return True


def turn_home(behavior: Behaviour, node: Node, attempt: Attempt, places: Sequence[Place], verdict: Verdict) -> None:
    """Give up this node and all that would come after it, say so, and take the exit for a low budget."""
    shed(attempt, node.id, places, verdict, optional=False)
    missed = Verdict(go=False, reason=_not_reached(verdict), chance_short=verdict.chance_short)
    for undone, left, optional in left_undone(behavior, attempt):
        shed(attempt, undone.id, left, missed, optional=optional)
    attempt.end(Ending(status="returned", exit="faulted", then=attempt.exit_for("low_budget"), reason=verdict.reason))


def give_up_rest(behavior: Behaviour | None, attempt: Attempt, verdict: Verdict) -> None:
    """Say that the work in hand and all that would come after it is given up.

    Args:
        behavior: The leaf that was ticked last.
        attempt: The state of the mission.
        verdict: Why.
    """
    from fieldhand.execution.behaviors.leaves import Leaf
    from fieldhand.execution.behaviors.loops import ForEachPlace

    if behavior is None:
        return
    optional = optional_around(behavior)
    if optional is not None:
        places = [] if optional.place is None else [optional.place]
        if isinstance(optional, ForEachPlace):
            places += optional.undone()
        shed(attempt, optional.node.id, places, verdict, optional=True)
    elif isinstance(behavior, Leaf):
        shed(attempt, behavior.node.id, [] if behavior.place is None else [behavior.place], verdict, optional=False)
    missed = Verdict(go=False, reason=_not_reached(verdict))
    for undone, left, is_optional in left_undone(behavior if optional is None else optional, attempt):
        shed(attempt, undone.id, left, missed, optional=is_optional)


def _not_reached(verdict: Verdict) -> str:
    return message("not reached: {why}", context="log", why=verdict.reason)


def left_undone(behavior: Behaviour, attempt: Attempt) -> Iterator[tuple[Node, Sequence[Place], bool]]:
    """What stands after a behavior: (node, places as far as they are known now, whether it was optional)."""
    from fieldhand.execution.behaviors.loops import ForEachPlace, RepeatBody

    for parent, child in ancestors(behavior):
        if isinstance(parent, ForEachPlace):
            if undone := parent.undone():
                yield parent.node, undone, parent.node.optional
        elif isinstance(parent, RepeatBody):
            if parent.rounds_left:
                yield parent.node, (), False
        elif isinstance(parent, PyTreesSequence):
            for later in parent.children[parent.children.index(child) + 1 :]:
                if isinstance(later, HasNode):
                    yield from _work_of(later.node, attempt)


def _work_of(node: Node, attempt: Attempt) -> Iterator[tuple[Node, Sequence[Place], bool]]:
    match node:
        case plan.Sequence(steps=steps) | plan.AnyOrder(steps=steps):
            for step in steps:
                yield from _work_of(step, attempt)
        case plan.Stop():
            return
        case plan.Optional():
            yield node, first_places_of(node, attempt), True
        case _:
            yield node, _places_of(node, attempt), plan.is_optional(node)


def first_places_of(node: plan.Optional, attempt: Attempt) -> tuple[Place, ...]:
    """Where an optional step begins, as far as that is known now."""
    first = next((inner for inner in plan.walk(node.body) if plan.selector_of(inner) is not None), node)
    return _places_of(first, attempt)


def _places_of(node: Node, attempt: Attempt) -> tuple[Place, ...]:
    selector = plan.selector_of(node)
    if selector is None or is_relative(selector):
        return ()
    try:
        return attempt.resolve(selector)
    except PlaceError:
        return ()


def shed(
    attempt: Attempt,
    node: str,
    places: Sequence[Place],
    verdict: Verdict | Choice,
    *,
    optional: bool,
    cause: Literal["budget", "unreachable"] = "budget",
) -> None:
    """Say what is given up, and why."""
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
