"""Sentences that the grammar does not take, mended at least cost: words that say nothing left out, others moved.

People put words in another order than the grammar has ("make there also a picture", "each of them to be imaged").
A mended sentence is looked at like any other; what it comes to is compared with the request again (see ``planner``).
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import count

from fieldhand.planning.english.arrange import ArrangedSentence
from fieldhand.planning.english.separators import Break
from fieldhand.planning.english.syntax import ClausePart, NotParsed, parse
from fieldhand.planning.english.tokens import Term

#: What it costs to leave a word out, by its kind. Words of other kinds are never left out.
_LEAVING = {
    "DET": 1.0, "WHICH": 1.0, "IS": 1.0, "OF": 1.0, "AT": 1.0, "WITH": 1.0, "FOR": 1.0, "JOIN": 1.0,
    "PLACE": 1.5, "READING": 1.5, "PLOT": 1.5, "IT": 1.5, "GO": 1.5, "TAKE": 1.5, "STILL": 1.0, "THERE": 2.0,
    "VISIT": 2.0, "BY": 1.0, "MEASURE": 2.5, "TREE": 2.5, "NOORDER": 2.0, "AGAIN": 2.5,
}  # fmt: skip
_SPLITTING, _MOVING, _JOINING = 1.0, 1.0, 0.8
#: A sentence that costs more is not read.
_MOST, _MOST_TRIES = 5.0, 300
_CAPTURES = frozenset({"TAKE", "MEASURE", "ACTV"})
_TAILS = frozenset({"THERE", "COUNT", "AGAIN", "EACHTAIL", "NOORDER", "INORDER", "EVERYM", "DISTINCT"})
#: Words with which a part of its own begins.
_BEGINS = _CAPTURES | {
    "GO",
    "VISIT",
    "RETURN",
    "REPEAT",
    "STOP",
    "IF",
    "WHETHER",
    "IFSO",
    "OTHERWISE",
    "UNTIL",
    "DET",
    "AT",
}
_BREAK = Break()


@dataclass(frozen=True, kw_only=True)
class Mended:
    """A sentence as it was mended: its parts, and the words that were left out of it."""

    parts: tuple[ClausePart, ...]
    left_out: tuple[Term, ...]


def mended(sentence: ArrangedSentence) -> Mended | None:
    """The sentence with the fewest changes that the grammar takes; None if it takes many."""
    if sum(t.kind in ("CMP", "LEVEL", "BETWEEN") for t in sentence.terms) > 1:
        return None  # which reading each of its tests is about would be a guess
    tries, ticks = 0, count()
    heap: list[tuple[float, int, tuple[Term, ...]]] = [(0.0, next(ticks), sentence.terms)]
    seen = {_key(sentence.terms)}
    while heap and tries < _MOST_TRIES:
        cost, _, terms = heapq.heappop(heap)
        tries += 1
        parts = parse(replace(sentence, terms=terms)) if terms else None
        if parts is None:
            continue
        if not isinstance(parts, NotParsed):
            kept = {(t.start, t.end, t.text) for t in terms}
            left = tuple(t for t in sentence.terms if t.text and (t.start, t.end, t.text) not in kept)
            return Mended(parts=parts, left_out=left)
        at = next((k for k, t in enumerate(terms) if t is parts.term), len(terms))
        if at == len(terms) - 1:
            at = len(terms)
        for price, other in _changes(terms, at):
            key = _key(other)
            if cost + price <= _MOST and key not in seen:
                seen.add(key)
                heapq.heappush(heap, (cost + price, next(ticks), other))
    return None


def _key(terms: Sequence[Term]) -> tuple[tuple[str, int, int], ...]:
    return tuple((t.kind, t.start, t.end) for t in terms)


def _changes(terms: tuple[Term, ...], at: int) -> Iterator[tuple[float, tuple[Term, ...]]]:
    """What may be done about a word that does not fit, each with its price."""
    for k in (at, at - 1, at - 2, at + 1):
        if 0 <= k < len(terms):
            price = _LEAVING.get(terms[k].kind)
            if price is not None:
                yield price + 0.25 * abs(k - at), (*terms[:k], *terms[k + 1 :])
            if terms[k].kind == "SEP":
                yield _JOINING, (*terms[:k], *terms[k + 1 :])
            if terms[k].kind in _TAILS:
                end = _end_of_clause(terms, k)
                if end > k + 1:
                    yield _MOVING, (*terms[:k], *terms[k + 1 : end], terms[k], *terms[end:])
            if terms[k].kind in _CAPTURES:
                begin = _begin_of_clause(terms, k)
                if begin < k:
                    yield _MOVING, (*terms[:begin], terms[k], *terms[begin:k], *terms[k + 1 :])
    for k in (at, at - 1):
        if 0 < k < len(terms) and terms[k].kind in _BEGINS and terms[k - 1].kind not in _CAPTURES | {"SEP"}:
            place = terms[k].start
            sep = Term(kind="SEP", text="", start=place, end=place, value=_BREAK)
            yield _SPLITTING, (*terms[:k], sep, *terms[k:])


def _end_of_clause(terms: Sequence[Term], at: int) -> int:
    return next((k for k in range(at + 1, len(terms)) if terms[k].kind == "SEP"), len(terms))


def _begin_of_clause(terms: Sequence[Term], at: int) -> int:
    return next((k + 1 for k in range(at - 1, -1, -1) if terms[k].kind == "SEP"), 0)
