"""Waits for a time of the clock before the work: "wait at the gate until 6 pm, then photograph row 3"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.chart import PhraseEdge
from fieldhand.planning.grammar.times.meaning import TimePart

_WAITS = frozenset({"wait", "stay", "hold", "pause", "remain", "stand", "park", "linger"})
_GOES = frozenset({"go", "drive", "head", "move", "travel", "proceed"})
_AT = frozenset({"at", "by", "in", "near", "on", "outside", "inside", "beside"})
_UNTIL = frozenset({"until", "till", "til"})
_JOINS = frozenset({"and", "then"})
#: Minimum number of words of the work behind the wait.
_LEAST_WORK = 2


@dataclass(frozen=True, kw_only=True)
class AwaitedTime:
    """A wait for a time, which becomes the beginning of the mission.

    Attributes:
        part: The time.
        first: Number of the first word that says it.
        dropped: Numbers of the words that say only that it waits.
        instead: Words that stand for others, by their numbers: the drive to where it waits.
    """

    part: TimePart
    first: int
    dropped: frozenset[int]
    instead: dict[int, Word]


def waits_between(phrase: PhraseEdge, words: Sequence[Word], times: frozenset[int]) -> bool:
    """Return True for "wait until 6 pm" behind other work.

    Args:
        phrase: Time.
        words: Words of the request.
        times: Numbers of the words that say times.
    """
    before = [k for k in range(phrase.start) if k not in times and words[k].kind not in ("comma", "stop")]
    return words[phrase.start].norm in _WAITS and any(words[k].norm not in ("please", "and") for k in before)


def awaited(phrase: PhraseEdge, words: Sequence[Word], times: frozenset[int]) -> AwaitedTime | None:
    """Return the wait of which a phrase says the end; None if it is no wait before all work.

    Only a drive may come before it: the robot cannot wait for a time between two pieces of work.

    Args:
        phrase: Time that may be the end of a wait.
        words: Words of the request.
        times: Numbers of the words that say times.
    """
    said: TimePart = phrase.meaning
    if said != TimePart(repeats=True, done_by=said.done_by) or words[phrase.start].norm not in _UNTIL:
        return None
    behind = [word for word in words[phrase.end :] if word.kind not in ("comma", "stop") and word.norm not in _JOINS]
    begin = phrase.start
    while begin and words[begin - 1].kind not in ("comma", "stop") and words[begin - 1].norm not in _JOINS:
        begin -= 1
    if len(behind) < _LEAST_WORK or begin == phrase.start or words[begin].norm not in _WAITS:
        return None
    part = TimePart(not_before=said.done_by, awaits=True)
    where = words[begin + 1 : phrase.start]
    if where and where[0].norm in _AT and all(k in times or words[k].kind == "comma" for k in range(begin)):
        drive = {begin: replace(words[begin], norm="go"), begin + 1: replace(words[begin + 1], norm="to")}
        return AwaitedTime(part=part, first=phrase.start, dropped=frozenset(), instead=drive)
    if [word.norm for word in where] not in ([], ["there"], ["here"]) or not begin or words[0].norm not in _GOES:
        return None
    joined = begin
    while joined and (words[joined - 1].kind in ("comma", "stop") or words[joined - 1].norm in _JOINS):
        joined -= 1
    if any(word.kind in ("comma", "stop") or word.norm in _JOINS for word in words[:joined]):
        return None
    dropped = frozenset(range(joined, phrase.start))
    return AwaitedTime(part=part, first=begin, dropped=dropped, instead={})
