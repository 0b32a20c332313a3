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


#: Verbs of being somewhere between two runs, and words that say so.
_STAYS = frozenset({"waiting", "staying", "standing", "resting", "parking", "parked", "sitting", "remaining"}) | _WAITS
_RETURNS = frozenset({"return", "returning", "go", "going", "come", "coming", "drive", "driving"})
_BETWEEN = (
    ("in", "between"), ("between", "readings"), ("between", "the", "readings"), ("between", "runs"), ("inbetween",),
    ("between", "rounds"), ("between", "the", "rounds"), ("between", "times"), ("in", "the", "meantime"),
    ("meanwhile",),
    ("between", "visits"), ("between", "measurements"), ("between", "pictures"), ("between", "the", "pictures"),
    ("each", "time"), ("between", "them"), ("after", "each"), ("after", "each", "one"), ("after", "each", "reading"),
)  # fmt: skip


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


def between_runs(words: Sequence[Word], times: frozenset[int]) -> AwaitedTime | None:
    """Return where the robot is between runs as the end of each run; None if the words do not say it.

    "Waiting on the charger in between" stands behind the work; it is read as "finish at the charger".

    Args:
        words: Words of the request, which runs again and again by the clock.
        times: Numbers of the words that say times.
    """
    for begin in range(1, len(words)):
        at = _place_behind(words, begin)
        end = next((k for k in range(begin, len(words)) if words[k].kind in ("comma", "stop")), len(words))
        between = _said_between(words, begin, end)
        if at is None or between is None or at >= end or times & {*range(begin, end)}:
            continue
        instead = {begin: replace(words[begin], norm="finish"), begin + 1: replace(words[begin + 1], norm="at")}
        dropped = frozenset((*range(begin + 2, at), *between))
        return AwaitedTime(part=TimePart(), first=begin, dropped=dropped, instead=instead)
    return None


def _place_behind(words: Sequence[Word], begin: int) -> int | None:
    """Return the number of the first word of the place behind a verb of being there or of going back to it."""
    norms = [word.norm for word in words[begin : begin + 3]] + ["", ""]
    if norms[0] in _STAYS and norms[1] in _AT:
        return begin + 2
    if norms[0] in _RETURNS and "to" in norms[1:3]:
        return begin + 1 + norms[1:3].index("to") + 1 if norms[1] in ("to", "back") else None
    return None


def _said_between(words: Sequence[Word], begin: int, end: int) -> range | None:
    """Return the words for between two runs, at the end of a clause or directly before it."""
    norms = [word.norm for word in words]
    for between in _BETWEEN:
        first = end - len(between)
        if tuple(norms[first:end]) == between:
            return range(first, end)
        last = begin - 1 if words[begin - 1].kind == "comma" else begin
        if tuple(norms[max(0, last - len(between)) : last]) == between:
            return range(last - len(between), begin)
    return None
