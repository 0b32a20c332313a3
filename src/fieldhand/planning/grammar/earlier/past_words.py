"""Find the words of a request that state a time of earlier missions, which is no time of the mission itself."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.planning.english.lexicon import Lexicon
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.earlier.edges import earlier_edges

#: Maximum number of words between a verb in the past, or a superlative, and its period.
_FAR = 9
_PARTING = frozenset({"comma", "stop"})
_WHERE = frozenset({"where", "that", "which", "whose", "ones", "those", "trees", "vines", "plants", "tree", "vine"})
#: Words of periods that are none of the mission itself.
_PAST = frozenset({"last", "past", "previous", "this", "yesterday"})
_RANKS = frozenset({"most", "least", "failed", "missed", "skipped", "top", "worst", "best"})


def past_words(words: Sequence[Word], lexicon: Lexicon, camera: Naming | None) -> frozenset[int]:
    """Return the numbers of the words that belong to a period of earlier missions.

    Args:
        words: Words of a request.
        lexicon: Words of the robot.
        camera: The action that takes pictures, if the robot has just one.
    """
    return past_ranges(words, [edge[:3] for edge in earlier_edges(words, lexicon, camera)])


def past_ranges(words: Sequence[Word], edges: Sequence[tuple[str, int, int]]) -> frozenset[int]:
    """Return the numbers of the words that belong to a period of earlier missions.

    A period does if it stands behind what was done or read ("visited on Monday", "where it was high this week"), or,
    with "of", behind a superlative ("the hottest of October").

    Args:
        words: Words of a request.
        edges: Category and range of each phrase about earlier missions, as in :func:`earlier_edges`.
    """
    work_ends = {end for category, _, end in edges if category in ("WORKSAID", "WORKWHERE")}
    was = [start for category, start, _ in edges if category == "WAS"]
    found: set[int] = set()
    for category, first, last in edges:
        if category in ("PERIODPOSS", "TOLDDONE"):
            found |= {*range(first, last)}
        if category == "TELLSDONE":
            found |= {*_clause_behind(words, first)}  # "we did rows 1 and 2 this morning"
        if category != "PERIOD":
            continue
        clause = _clause_before(words, first)
        told = any(start in clause and _describes(words, clause, start) for start in was)
        past = words[first].norm in ("of", "from") or any(words[k].norm in _PAST for k in range(first, last))
        ranked = past and any(_ranks(words[k]) for k in clause)
        if first in work_ends or told or ranked:
            found |= {*range(first, last)}
    return frozenset(found)


def _clause_before(words: Sequence[Word], at: int) -> range:
    """Return the numbers of the words before one, in its clause."""
    start = at
    while start > max(0, at - _FAR) and words[start - 1].kind not in _PARTING:
        start -= 1
    return range(start, at)


def _clause_behind(words: Sequence[Word], at: int) -> range:
    """Return the numbers of the words from one on, to the end of its clause."""
    return range(at, next((k for k in range(at, len(words)) if words[k].kind in _PARTING), len(words)))


def _describes(words: Sequence[Word], clause: range, verb: int) -> bool:
    """Return True if a verb in the past is part of a description of places."""
    return any(words[k].norm in _WHERE for k in clause if k <= verb)


def _ranks(word: Word) -> bool:
    return word.norm in _RANKS or (word.norm.endswith("est") and len(word.norm) > 4)
