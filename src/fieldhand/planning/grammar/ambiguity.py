"""The question of a request that can be planned in several ways: where the plans differ, and what each would do."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from fieldhand.language import Number, joined, message
from fieldhand.language.words import capitalised
from fieldhand.planning.planner import Answer, Planned, Reason
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.plan import Node, Span, walk
from fieldhand.wording.steps import ReadBackLine, write_lines
from fieldhand.wording.ways import say_ways

#: Maximum number of answers to choose from; plans that differ in more ways are told apart one step at a time.
_MOST_ANSWERS = 5


@dataclass(frozen=True, kw_only=True)
class PlanQuestion:
    """A question that tells plans of one request apart.

    Attributes:
        question: The question, as a sentence.
        said: Character range of the request that it is about.
        plans: For each answer the plans that it leaves, most likely first.
    """

    question: str
    said: Span
    plans: Mapping[str, tuple[Planned, ...]]


def question_between(plans: Sequence[Planned], request: str, site: Site, robot: RobotProfile) -> PlanQuestion | None:
    """Return the question between plans; None if their read-backs do not differ.

    Args:
        plans: Plans of the request, most likely first.
        request: Request as typed.
        site, robot: Site and robot of the mission.
    """
    written = [write_lines(plan.task, site, robot, {}) for plan in plans]
    texts = [[line.text for line in lines] for lines in written]
    first = next((k for k in range(min(map(len, texts))) if len({text[k] for text in texts}) > 1), None)
    if first is None:
        return _question_of_branch(plans, written, request)
    last = 0
    ends = [[(line.indent, line.text) for line in lines] for lines in written]
    while all(len(end) > first + 1 + last for end in ends) and len({end[-1 - last] for end in ends}) == 1:
        last += 1
    while last and any(text[-1 - last].endswith(":") for text in texts):
        last -= 1  # what a condition decides is told with it
    answers: list[str] = [joined(" ", text[first : len(text) - last]) for text in texts]
    if len(set(answers)) > _MOST_ANSWERS:
        answers = [text[first] for text in texts]
    answers = [_with_speed(answer, plan) for answer, plan in zip(answers, plans, strict=True)]
    left: dict[str, tuple[Planned, ...]] = {}
    for answer, plan in zip(answers, plans, strict=True):
        left[answer] = (*left.get(answer, ()), plan)
    start, end = _said_of_watches(plans, first) or _said(plans, [lines[first] for lines in written], request)
    asked = message("'{said}': which is meant?", context="question", said=request[start:end])
    return PlanQuestion(question=asked, said=(start, end), plans=left)


def _with_speed(answer: str, plan: Planned) -> str:
    """Return an answer with the driving speed of the whole mission, which the steps do not state."""
    speed = plan.task.constraints.speed_m_s
    if speed is None:
        return answer
    whole = message("Drive no faster than {speed} m/s on the whole mission.", speed=Number(f"{speed:g}"))
    return joined(" ", (answer, whole))


def _said_of_watches(plans: Sequence[Planned], line: int) -> Span | None:
    """Return the range of the request that states the watches of a line; None if it is a line of the plan."""
    watches = [plan.task.composition.watches[line : line + 1] for plan in plans]
    spans = [span for found in watches for watch in found for span in watch.said]
    return (min(start for start, _ in spans), max(end for _, end in spans)) if spans and all(watches) else None


def _question_of_branch(
    plans: Sequence[Planned], written: Sequence[Sequence[ReadBackLine]], request: str
) -> PlanQuestion | None:
    """Return the question between plans of the same steps, of which one stands in a branch or behind it."""
    depths = [[line.indent for line in lines] for lines in written]
    first = next((k for k in range(min(map(len, depths))) if len({depth[k] for depth in depths}) > 1), None)
    if first is None:
        return _question_of_limits(plans, request)
    left: dict[str, tuple[Planned, ...]] = {}
    for plan, lines in zip(plans, written, strict=True):
        line = lines[first]
        heads = [head.text for head in lines[:first] if head.indent < line.indent]
        answer = joined(" ", (heads[-1], line.text)) if heads else message("In each case: {step}", step=line.text)
        left[answer] = (*left.get(answer, ()), plan)
    start, end = _said(plans, [lines[first] for lines in written], request)
    asked = message("'{said}': which is meant?", context="question", said=request[start:end])
    return PlanQuestion(question=asked, said=(start, end), plans=left)


def _question_of_limits(plans: Sequence[Planned], request: str) -> PlanQuestion | None:
    """Return the question between plans of the same steps that use or leave so much of the battery."""
    left: dict[str, tuple[Planned, ...]] = {}
    spans: list[Span] = []
    for plan in plans:
        limits = plan.task.constraints
        spans += (*limits.reserve_said, *(span for budget in limits.budgets for span in budget.said))
        used = next((budget.limit for budget in limits.budgets if budget.kind == "energy_percent"), None)
        if limits.reserve_percent is not None:
            kept = Number(f"{limits.reserve_percent:g}")
            answer = message("At least {percent} % of the battery is left at the end.", percent=kept)
        elif used is not None:
            answer = message("The mission uses at most {percent} % of the battery.", percent=Number(f"{used:g}"))
        else:
            return _question_of_ways(plans, request)
        left[answer] = (*left.get(answer, ()), plan)
    if len(left) < 2:
        return _question_of_ways(plans, request)
    start, end = min(start for start, _ in spans), max(end for _, end in spans)
    asked = message("'{said}': which is meant?", context="question", said=request[start:end])
    return PlanQuestion(question=asked, said=(start, end), plans=left)


def _question_of_ways(plans: Sequence[Planned], request: str) -> PlanQuestion | None:
    """Return the question between plans of the same steps that keep away from other places."""
    left: dict[str, tuple[Planned, ...]] = {}
    for plan in plans:
        answer = capitalised(joined(" ", say_ways(plan.task.constraints)))
        left[answer] = (*left.get(answer, ()), plan)
    rules = [plan.task.constraints for plan in plans]
    spans = [span for rule in rules for avoid in rule.avoid for span in avoid.said]
    spans += [span for rule in rules for gate in rule.only_gates for span in gate.said]
    if len(left) < 2 or not spans:
        return None
    start, end = min(start for start, _ in spans), max(end for _, end in spans)
    asked = message("'{said}': which is meant?", context="question", said=request[start:end])
    return PlanQuestion(question=asked, said=(start, end), plans=left)


def _said(plans: Sequence[Planned], lines: Sequence[ReadBackLine], request: str) -> Span:
    """Return the range of the request from which the lines come at which the plans differ."""
    spans: list[Span] = []
    for plan, line in zip(plans, lines, strict=True):
        nodes = {node.id: node for node in walk(plan.task.composition.plan)}
        for name in (line.node, *line.also):
            spans += _words_of(nodes[name]) if name in nodes else ()
    if not spans:
        return (0, len(request.rstrip()))
    return (min(start for start, _ in spans), max(end for _, end in spans))


def _words_of(node: Node) -> tuple[Span, ...]:
    return (*node.said, *node.at_said)


def chosen_answer(given: str, choices: Sequence[str]) -> str | None:
    """Return the choice that an answer names: as a whole, or by words that only this one contains."""
    said = given.strip().lower()
    whole = [choice for choice in choices if choice.lower() == said]
    part = [choice for choice in choices if said and re.search(rf"(?<!\w){re.escape(said)}(?!\w)", choice.lower())]
    named = whole or part
    return named[0] if len(named) == 1 else None


def not_an_answer(given: Answer, choices: Sequence[str]) -> Reason:
    """Return the reason why words do not answer a question."""
    what = message("'{answer}' does not answer '{question}'", answer=given.answer, question=given.question)
    quoted = joined(", ", (message("'{said}'", said=choice) for choice in choices))
    return Reason(what=what, advice=message("choose: {choices}", choices=quoted))
