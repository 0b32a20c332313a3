"""Ask whether words that are not understood may be left out, where everything else of a request can be planned."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import chain, islice

from fieldhand.language import joined, message
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.ambiguity import chosen_answer
from fieldhand.planning.grammar.english import ENGLISH
from fieldhand.planning.grammar.planned import NAME
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Reason, Refused
from fieldhand.planning.refusals.optional_words import OptionalWords
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.plan import Span
from fieldhand.wording.steps import write_lines

#: Plans the request without the words of a range.
PlanWithout = Callable[[Span], Outcome]

#: Maximum number of clauses and of phrases that are tried, and of words of a request in which they are sought.
_MOST_TRIES, _MOST_WORDS = 6, 150


def asked_to_leave_out(
    request: str,
    refused: Refused,
    plan: PlanWithout,
    answers: Sequence[Answer],
    site: Site,
    robot: RobotProfile,
) -> Outcome:
    """Return the question whether some words may be left out, what its answer leads to, or the refusal as it is.

    A clause that tells something is asked about, and a phrase that describes something. Words with a command, a
    condition, a limit or a prohibition are never left out, and neither are those that the robot or the site makes
    impossible.

    Args:
        request: Request as typed.
        refused: Its refusal.
        plan: Plans the request without the words of a range.
        answers: Answers to questions about the request.
        site, robot: Site and robot of the mission.
    """
    if any(reason.final for reason in refused.reasons):
        return refused
    words = ENGLISH.words_of(request)
    if len(words) > _MOST_WORDS:
        return refused
    stuck = sorted({k for reason in refused.reasons for k in _numbers(reason, words)})
    optional = OptionalWords.of(words, site, robot)
    asked: Outcome = refused
    for said in chain(
        islice(optional.clauses_with(stuck), _MOST_TRIES), islice(optional.phrases_with(stuck), _MOST_TRIES)
    ):
        outcome = plan((words[said[0]].start, words[said[-1]].end))
        if isinstance(outcome, Refused):
            continue
        told = optional.stated(said)
        question = message(
            "'{said}' is not understood. May it be left out?",
            context="question",
            said=request[words[told[0]].start : words[told[-1]].end],
        )
        choices = (_without(outcome, site, robot),)
        given = next((answer for answer in answers if answer.question == question), None)
        if given is not None and chosen_answer(given.answer, choices) is not None:
            return _told(outcome, given) if isinstance(outcome, Planned) else outcome
        if isinstance(outcome, Planned):
            return Clarify(question=question, choices=choices, planner=NAME, otherwise=refused)
        if asked is refused:  # words without which the rest can be planned come first
            asked = Clarify(question=question, choices=choices, planner=NAME, otherwise=refused)
    return asked


def _told(planned: Planned, given: Answer) -> Planned:
    """Return a plan that states the answer which allowed to leave words out."""
    command = planned.task.command
    command = replace(command, assumptions=(given.sentence(), *command.assumptions))
    return replace(planned, task=replace(planned.task, command=command))


def _numbers(reason: Reason, words: Sequence[Word]) -> Sequence[int]:
    """Return the numbers of the unknown words that a reason is about, or of the word at which reading stopped."""
    found = [k for k, word in enumerate(words) if any(s < word.end and word.start < e for s, e in reason.said)]
    return found if reason.unknown else found[:1]


def _without(outcome: Planned | Clarify, site: Site, robot: RobotProfile) -> str:
    """Return the answer that leaves words out, with the steps that are left, or the question about them."""
    if isinstance(outcome, Clarify):
        return message("Leave it out; then: {question}", question=outcome.question)
    steps = joined(" ", [line.text for line in write_lines(outcome.task, site, robot, {})])
    return message("Leave it out: {steps}", steps=steps)
