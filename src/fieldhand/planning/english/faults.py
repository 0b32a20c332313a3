"""What stops a reading: a phrase that means nothing here, and one that leaves open what only the person can say."""

from __future__ import annotations

from collections.abc import Iterable

from fieldhand.planning.english.tokens import Term
from fieldhand.planning.planner import Reason
from fieldhand.task.plan import Span

PLAINLY = "say it in other words"


class Unclear(Exception):
    """A phrase that means nothing here, or cannot be done."""

    def __init__(self, reason: Reason) -> None:
        self.reason = reason
        super().__init__(reason.what)


class Question(Exception):
    """A phrase that leaves open what only the person can say.

    Attributes:
        choices: Answers to choose from; none if any words would do.
    """

    def __init__(self, question: str, choices: tuple[str, ...] = ()) -> None:
        self.question = question
        self.choices = choices
        super().__init__(question)


def text_of(terms: Iterable[Term]) -> str:
    """Terms as they stand in the request."""
    return " ".join(t.text for t in sorted(terms, key=lambda t: (t.start, t.end)) if t.text)


def spans_of(terms: Iterable[Term]) -> tuple[Span, ...]:
    """Where terms stand in the request: ranges that follow each other are one."""
    merged: list[Span] = []
    for start, end in sorted({t.span for t in terms if t.end > t.start}):
        if merged and start <= merged[-1][1] + 1:
            merged[-1] = (merged[-1][0], max(end, merged[-1][1]))
        else:
            merged.append((start, end))
    return tuple(merged)


def unclear(terms: Iterable[Term], what: str, advice: str = PLAINLY) -> Unclear:
    """A fault of some terms, which it quotes."""
    terms = tuple(terms)
    return Unclear(Reason(what=f"'{text_of(terms)}': {what}", said=spans_of(terms), advice=advice))
