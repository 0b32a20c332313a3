"""Requests for what an earlier mission did, which this request does not say: the person is asked for it."""

from __future__ import annotations

import re
from collections.abc import Sequence

from fieldhand.language import joined, message
from fieldhand.language.words import say_action
from fieldhand.planning.english.tokens import Word, ranges_of, words_of
from fieldhand.planning.grammar.planned import NAME
from fieldhand.planning.planner import Clarify, Refused
from fieldhand.robot.model import RobotProfile

_WORD = r"[\w'-]+"
_DAY = r"(?:mon|tues|wednes|thurs|fri|satur|sun)day"
_THEN = (
    rf"(?:(?:on )?(?:the )?(?:last|previous|earlier|other) {_WORD}|(?:on )?{_DAY}|yesterday(?: morning| afternoon)?"
    rf"|{_WORD} {_WORD} ago|before|always|usual|normal"
    rf"|(?:we|you|it|the robot) (?:usually |always )?(?:did|do|does)(?: (?:on |the )?(?:last )?{_WORD})?)"
)
_PATTERN = re.compile(
    r"(?<!\S)(?:(?:the )?(?:very )?same (?:(?:thing|things|job|work|round|again|stuff) )?"
    rf"(?:(?:in|at|on|for|with) (?:{_WORD} ){{1,4}}?|here |there )?as (?:in |for )?{_THEN}"
    rf"|(?:what|whatever) (?:you|we|it|the robot) (?:did|do) (?:{_WORD} ){{0,4}}?{_THEN}"
    rf"|repeat (?:what (?:{_WORD} ){{1,3}}?)?(?:the )?(?:last|previous|yesterday's|{_DAY}'s) {_WORD})(?!\S)"
)


def asked_what_was_done(request: str, refused: Refused, robot: RobotProfile) -> Clarify | None:
    """Return the question what is to be done behind "do the same as last Tuesday"; None for other refusals.

    Args:
        request: The request.
        refused: Its refusal.
        robot: The robot, whose actions the question lists.
    """
    words = words_of(request)
    found = next(ranges_of(_PATTERN, words), None)
    if found is None or not _is_the_only_fault(words, found, refused):
        return None
    first, last = found
    what = message(
        "'{said}': what is to be done? This request names nothing earlier. Say an action and its places: {actions}.",
        context="question",
        said=request[words[first].start : words[last - 1].end],
        actions=joined(", ", (say_action(action.name) for action in robot.actions)),
    )
    return Clarify(question=what, planner=NAME)


def _is_the_only_fault(words: Sequence[Word], found: tuple[int, int], refused: Refused) -> bool:
    """Return True if no reason of a refusal is about other words only."""
    begin, end = words[found[0]].start, words[found[1] - 1].end
    return all(not one.said or any(s < end and begin < e for s, e in one.said) for one in refused.reasons)
