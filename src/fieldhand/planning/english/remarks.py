"""Sentences that ask for nothing: what a grower tells besides."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from fieldhand.planning.english.kinds import VERBS
from fieldhand.planning.english.tokens import Term
from fieldhand.task.plan import Span

#: A sentence with one of these may ask for something, or forbid it, whatever else it says.
_ASKS = VERBS | {
    "AMOUNT", "ANOTHER", "APART", "ASMANY", "BATTERY", "BEFORE", "BETWEEN", "BUDGET", "CMP", "COUNT", "DISTINCT",
    "EACH", "EXCEPT", "FIRSTLY", "FITS", "IF", "IFSO", "INORDER", "INSTEAD", "INTERVAL", "ISNOT", "KEEP", "LEVEL",
    "NEITHER", "NOORDER", "NOT", "NOTYET", "NOUN", "ONLY", "ORDERED", "ORDEROF", "OTHERWISE", "TIMES", "TRY", "UNIT",
    "UNLESS", "UNTIL", "UPTO", "USE", "WHERE", "WHETHER", "WITHOUT",
}  # fmt: skip


#: Words that ask for nothing by themselves; a clause of these and of unknown words is an aside.
_EMPTY = frozenset({"UNKNOWN", "DET", "FOR", "FILLER", "IT", "IS", "WHICH", "AS", "OF", "MORE", "SAME"})
#: How a sentence begins that tells something; one that begins with an unknown verb would ask for something.
_TELLS = frozenset(
    {"i", "i'm", "i've", "we", "we're", "we've", "they", "they're", "they've", "he", "she", "it", "it's", "there"}
    | {"there's", "this", "that", "these", "those", "the", "our", "my", "his", "her", "their", "a", "an", "some"}
    | {"last", "yesterday", "today", "since", "because"}
)
#: Who does what is asked.
_DOES = frozenset({"robot", "robots", "rover", "machine", "bot", "you"})


def without_remarks(terms: Sequence[Term], request: str) -> tuple[list[Term], list[Span], list[str]]:
    """The terms without sentences that ask for nothing and hold unknown words; where these stand, and what they say.

    A sentence of known words is left to the grammar: it may name a place that the next one is about.
    """
    kept: list[Term] = []
    spans: list[Span] = []
    remarks: list[str] = []
    for sentence in _sentences(terms):
        said = [t for t in sentence if t.kind not in ("STOPMARK", "COMMA")]
        kinds = {t.kind for t in said}
        spoken = [word for t in said for word in t.text.lower().split()]
        tells = bool(spoken) and spoken[0] in _TELLS and not _DOES & set(spoken)
        if "UNKNOWN" not in kinds or kinds & _ASKS or not tells:
            kept += sentence
            continue
        span = (said[0].start, said[-1].end)
        spans.append(span)
        remarks.append(request[span[0] : span[1]])
        kept += [t for t in sentence if t.kind == "STOPMARK"]
    kept = _without_asides(kept, request, spans, remarks)
    if all(t.kind in ("STOPMARK", "COMMA", "FILLER") for t in kept):
        return list(terms), [], []
    return kept, spans, remarks


def _without_asides(terms: Sequence[Term], request: str, spans: list[Span], remarks: list[str]) -> list[Term]:
    """The terms without clauses of unknown words and nothing that could be asked: ", like last week", "for the lab".

    ``spans`` and ``remarks`` get what is left out.
    """
    kept: list[Term] = []
    clause: list[Term] = []
    for term in (*terms, None):
        if term is not None and term.kind not in ("COMMA", "STOPMARK"):
            clause.append(term)
            continue
        aside = _aside(clause)
        kept += clause[: len(clause) - len(aside)]
        if aside:
            span = (aside[0].start, aside[-1].end)
            spans.append(span)
            remarks.append(request[span[0] : span[1]])
        kept += [] if term is None else [term]
        clause = []
    return kept


def _aside(clause: Sequence[Term]) -> Sequence[Term]:
    """The end of a clause that asks for nothing: all of it, or what "for" begins; empty if there is none."""
    if any(t.kind == "PURPOSE" for t in clause):
        return ()  # a reason is looked at as a whole
    begin = next((k for k, t in enumerate(clause) if t.kind == "FOR"), 0)
    for at in dict.fromkeys((0, begin)):
        said = clause[at:]
        kinds = {t.kind for t in said}
        if "UNKNOWN" in kinds and kinds <= _EMPTY and (at == 0 or said[0].kind == "FOR"):
            return said
    return ()


def _sentences(terms: Sequence[Term]) -> Iterator[list[Term]]:
    """Each with the mark at its end."""
    sentence: list[Term] = []
    for term in terms:
        sentence.append(term)
        if term.kind == "STOPMARK":
            yield sentence
            sentence = []
    if sentence:
        yield sentence
