"""Patterns of clauses about earlier work: "that have not been visited", "we did not get to", "without a picture"."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache

from fieldhand.planning.grammar.earlier.periods import compiled, tables

_NEVER = "not|never|haven't|hasn't|hadn't|weren't|wasn't|aren't|isn't"
_LEAD = (
    rf"(?P<lead>(?:(?:have|has|had|were|was|are|is|been|{_NEVER}|yet|already|previously|also|ever|last|just|still|to be"
    r"|got|most recently) )*)"
)
_TAIL = r"(?P<tail>(?: (?:already|before|yet|so far))?)"
_NUMBER = r"(?:two|three|four|five|six|\d+)"
_TIMES = (
    rf"(?: (?P<times>(?:at least |more than )?(?:once|twice|{_NUMBER} times)|{_NUMBER} or more times|twice or more))?"
)
_REL = r"(?:(?:that|which|who|where) )?"
_ROVER = r"(?:{rover}|you've|we've|they've|i've|it's|you'd|we'd|they'd)"
_US = r"(?:you|us|me|it|them|the robot|the rover|the tractor|the machine)"
_AT = r"(?: (?:of|at|from|on|for|in))?"
_READINGS = r"(?: (?:readings?|measurements?|values?|samples?|data))?"
_NOT_ABLE = (
    r"could not|couldn't|(?:were|was) (?:not|un)able to|(?:were|was) not able to|(?:weren't|wasn't) able to|failed to"
)
_NOT_DONE = (
    r"did not|didn't|never did|forgot to|had no time to|(?:have|had) not managed to|(?:haven't|hadn't) managed to"
)
_FAILED = (
    r"(?:failed|went wrong|did not work(?: out)?|didn't work(?: out)?|did not succeed|didn't succeed"
    r"|(?:was|were) unsuccessful|gave an error)"
)
_LEFT = (
    r"(?:still (?:missing|outstanding|to do|to be done|to go|pending|undone|waiting|left over|left|due|unfinished|open)"
    r"|outstanding|left over|left unfinished|not finished)"
)
_SOMETHING = r"(?:the|a|an|any|our|your) (?:mission|robot|work|visit|measurement|reading|sensor|camera|action)"
_WITH = (
    r"with no|with|without|having no|having|have no|have|has no|had no|had|have not got|lacking|lack|do not have"
    r"|don't have"
)


@cache
def work_patterns(nouns: tuple[str, ...], verbs: tuple[str, ...]) -> tuple[tuple[str, re.Pattern[str]], ...]:
    """Return the patterns of clauses about earlier work, each with its kind.

    Args:
        nouns: What captures and readings of the robot are called.
        verbs: Past participles of its work.
    """
    known = tables()
    actives = {verb for of in ("any", "measured", "picture", "left_out") for verb in known["actives"][of]}
    past = [*verbs, *known["participles"]["left_out"]]
    noun = rf"(?P<noun>{_any(nouns)}){_READINGS}"
    what = rf"(?:(?:an?|any|some|the|our|its|their|no) )?{noun}"
    active, part = _any([*actives, *past]), _any(past)
    base = _any([verb for of in known["bases"].values() for verb in of])
    made = r"(?:taken|measured|read|made|recorded|collected|sampled|shot|gathered)"
    patterns = (
        ("passive", rf"{_REL}{_LEAD}(?P<verb>{part})(?: by {_US})?(?: for {what})?{_TIMES}{_TAIL}"),
        ("active", rf"{_REL}{_ROVER} {_LEAD}(?P<verb>{active})(?: {what}{_AT})?{_TIMES}{_TAIL}"),
        ("active", rf"{_REL}{_ROVER} {_LEAD}(?P<verb>took|made|got|taken|collected|recorded) {what}{_AT}{_TAIL}"),
        (
            "not",
            rf"{_REL}{_ROVER} (?P<not>{_NOT_ABLE}|{_NOT_DONE})(?: yet)? (?P<verb>{base})(?: (?:for )?{what}{_AT})?",
        ),
        ("not", rf"{_REL}{_ROVER} (?P<not>{_NOT_ABLE}|{_NOT_DONE}) (?P<verb>take|make|get|collect) {what}{_AT}"),
        ("where", rf"(?:where|whose|at which|of which|from which) (?P<no>no )?{what} {_LEAD}{made}{_TAIL}"),
        ("with", rf"(?:(?:that|which) )?(?P<with>{_WITH}) {what}(?: (?:from|of|in|on))?"),
        ("failed", rf"(?:that|which|where) (?:(?:it|they|something|{_SOMETHING}) )?(?:has |have |had )?{_FAILED}"),
        ("still", rf"(?:(?:that|which) )?(?:(?:are|is|were|was) )?{_LEFT}"),
        ("failed", rf"where {what} (?:has |have |had )?{_FAILED}"),
        ("failed", rf"(?:that|which) (?:could not be|couldn't be|failed to be) (?P<verb>{part})"),
    )
    return tuple((kind, compiled(pattern)) for kind, pattern in patterns)


def _any(phrases: Sequence[str]) -> str:
    ordered = sorted(set(phrases), key=lambda one: (-len(one), one))
    return "(?:" + "|".join(re.escape(one).replace(r"\ ", " ") for one in ordered) + ")"
