"""Where each answer to a question would lead: the request is planned with it, and its places are looked up."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from fieldhand.errors import DriveFault, PlaceError, TaskError
from fieldhand.forecast.walk_branch import walk_branch as walk_through
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.planning.english.faults import Question, Unclear
from fieldhand.planning.english.rewording import Worded
from fieldhand.planning.planner import Answer, Outcome, Planned
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task.frames import Task
from fieldhand.task.plan import Node, Span, walk

#: Plans a request as it is worded, with the answers that were taken into it.
Read = Callable[[Worded, tuple[Answer, ...]], Outcome]


def outcomes_of_choices(
    question: Question, worded: Worded, taken: tuple[Answer, ...], read: Read
) -> tuple[Outcome | None, ...]:
    """Return for each choice the outcome that it leads to; None if its words are open, or lead to another question.

    Args:
        question: What is asked.
        worded, taken: The request as it is read so far, and the answers in it.
        read: Plans it.
    """
    found: list[Outcome | None] = []
    for choice, words in question.answers():
        answered = (*taken, Answer(question=question.question, answer=choice))
        found.append(_outcome(read, worded.with_words(question.said, words), answered) if words else None)
    return tuple(found)


def places_of_choices(
    question: Question, worded: Worded, outcomes: Sequence[Outcome | None], site: Site, robot: RobotProfile
) -> tuple[tuple[Place, ...], ...]:
    """For each choice the places that the words asked about would mean; empty for a choice that leads to no plan yet.

    Args:
        question: What is asked.
        worded: The request as it is read so far.
        outcomes: Outcome of each choice.
        site, robot: Where and with what.

    Returns:
        Nothing at all where the choices do not differ in their places: there is nothing to show then.
    """
    said = worded.span(question.said)
    return different_places(
        [outcome if isinstance(outcome, Planned) else None for outcome in outcomes], said, site, robot
    )


def different_places(
    plans: Sequence[Planned | None], said: Span, site: Site, robot: RobotProfile
) -> tuple[tuple[Place, ...], ...]:
    """Return for each plan the places that some words of its request mean; nothing if they do not differ."""
    found = [_places(plan.task, said, site, robot) if plan is not None else () for plan in plans]
    return tuple(found) if len({frozenset(p.id for p in places) for places in found}) > 1 else ()


def _outcome(read: Read, worded: Worded, answered: tuple[Answer, ...]) -> Outcome | None:
    """Return the outcome of a request with an answer; None if it is still open or cannot be done."""
    try:
        return read(worded, answered)
    except (Unclear, Question):
        return None


def _places(task: Task, said: Span, site: Site, robot: RobotProfile) -> tuple[Place, ...]:
    """The places of the nodes that came from some words; of all nodes where none did."""
    nodes = [n for n in walk(task.composition.plan) if n.selector is not None]
    nodes = [n for n in nodes if any(s < said[1] and said[0] < e for s, e in _words_of(n))] or nodes
    try:
        found = list(_resolved(nodes, site) or _reached(nodes, task, site, robot))
    except (PlaceError, DriveFault, TaskError):
        return ()
    return tuple({(p.kind, p.id): p for p in found}.values())


def _words_of(node: Node) -> tuple[Span, ...]:
    return (*node.said, *node.at_said)


def _resolved(nodes: list[Node], site: Site) -> list[Place]:
    """The places of selectors that mean the same wherever the robot is; none if one of them does not."""
    selectors = [s for n in nodes if (s := n.selector) is not None]
    if any(s.relative for s in selectors):
        return []
    return [place for s in selectors for place in resolve(s, site, Context(here=site.start))]


def _reached(nodes: list[Node], task: Task, site: Site, robot: RobotProfile) -> Iterator[Place]:
    """The places to which a walk through the plan comes at some nodes, if every condition holds."""
    if any(n.visits_each and n.is_optional for n in walk(task.composition.plan)):
        return  # to choose among visits takes longer than anyone waits for a question
    ids = {node.id for node in nodes}
    for step in walk_through(task, site, robot, holds=lambda _: True).steps:
        if step.node.id in ids and step.kind in ("drive", "act", "visit-list"):
            yield from step.places
