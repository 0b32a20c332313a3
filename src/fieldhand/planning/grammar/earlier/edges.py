"""Edges of the chart for words about earlier missions."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any

from fieldhand.planning.english.lexicon import Lexicon
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.earlier.periods import compiled, matches_in, past_verbs, periods_in, tables
from fieldhand.planning.grammar.earlier.work import earlier_work

#: Categories of the phrases about earlier missions.
EARLIER = frozenset(
    {"PERIOD", "PERIODPOSS", "WORKSAID", "WORKWHERE", "WORKADJ", "WAS", "REMEASURE", "REVISIT", "WHATEVER"}
    | {"TOLDDONE", "TELLSDONE", "TOLDWHEN"}
)
_AGAIN = compiled(r"re(?: - )?(?:measure|sample|read|check|test|probe)")
_BACK = compiled(r"(?:re(?: - )?visit|(?:go|drive|head|return) (?:back )?to|go again to)")
_ADJECTIVES = {"failed": "failed", "missed": "left_out", "skipped": "left_out", "unsuccessful": "failed"}


@cache
def told_done() -> tuple[tuple[str, re.Pattern[str]], ...]:
    """Return the patterns of what somebody says was done: ``TOLDDONE``, ``TELLSDONE`` before places, ``TOLDWHEN``."""
    known = tables()
    told, works = known["told"], [verb for of in known["works"].values() for verb in of]
    kinds = ("any", "measured", "picture")
    verbs = {name: [*works, *(one for of in kinds for one in known[name][of])] for name in ("participles", "actives")}
    same = {verb for of in kinds for verb in known["bases"].get(of, ())}  # "can you read CO2" tells nothing
    verbs["actives"] = [verb for verb in verbs["actives"] if verb not in same]
    part, active = (f"(?:{'|'.join(sorted(verbs[name], key=len, reverse=True))})" for name in verbs)
    times = rf"(?:{'|'.join(told['when'])})"
    behind = told["behind"].replace("{when}", f"(?: {times})*").replace("{part}", part)
    before = told["before"].replace("{part}", part).replace("{active}", active)
    patterns = {"TOLDDONE": behind, "TELLSDONE": before, "TOLDWHEN": f"{times}(?: {times})*"}
    return tuple((category, compiled(pattern)) for category, pattern in patterns.items())


def earlier_edges(
    words: Sequence[Word], lexicon: Lexicon, camera: Naming | None
) -> Iterator[tuple[str, int, int, Any]]:
    """Yield the phrases about earlier missions: category, range of the words, and value.

    Periods (``PERIOD``, ``PERIODPOSS``), clauses about work (``WORKSAID``, ``WORKWHERE`` with "where"), "failed" before
    a noun (``WORKADJ``), and verbs in the past behind which stands a value (``WAS``).

    Args:
        words: Words of a request.
        lexicon: Words of the robot.
        camera: The action that takes pictures, if the robot has just one.
    """
    for first, last, when in periods_in(words):
        yield "PERIOD", first, last, when
    for first, last, when in periods_in(words, owned=True):
        yield "PERIODPOSS", first, last, when
    for first, last, work in earlier_work(words, lexicon, camera):
        yield "WORKWHERE" if words[first].norm in ("where", "at", "of", "from") else "WORKSAID", first, last, work
        if words[first].norm == "where":
            yield "WORKSAID", first, last, work
    for first, last, _ in matches_in(past_verbs(), words):
        yield "WAS", first, last, None
    for first, last, _ in matches_in(_AGAIN, words):
        yield "REMEASURE", first, last, None
    for first, last, _ in matches_in(_BACK, words):
        yield "REVISIT", first, last, None
    for category, pattern in told_done():
        for first, last, _ in matches_in(pattern, words):
            yield category, first, last, None
    for k, word in enumerate(words):
        if word.norm in ("what", "whatever", "anything", "all"):
            yield "WHATEVER", k, k + 1, None
        if word.norm in _ADJECTIVES:
            yield "WORKADJ", k, k + 1, _ADJECTIVES[word.norm]
