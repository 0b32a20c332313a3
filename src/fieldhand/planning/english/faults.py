"""What stops a reading: a phrase that means nothing here, and one that leaves open what only the person can say."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from fieldhand.language import message
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.planner import Reason
from fieldhand.task.plan import Span

PLAINLY = message("say it in other words")


class Unclear(Exception):
    """A phrase that means nothing here, or cannot be done."""

    def __init__(self, reason: Reason) -> None:
        self.reason = reason
        super().__init__(reason.what)


class Question(Exception):
    """A phrase that leaves open what only the person can say.

    Attributes:
        choices: Answers to choose from; none if any words would do.
        said: Range of the request in whose place an answer's words are read.
        words: For each choice, these words; empty for one that only the person can put into words.
    """

    def __init__(
        self, question: str, choices: tuple[str, ...] = (), *, terms: Iterable[Term] = (), words: tuple[str, ...] = ()
    ) -> None:
        self.question = question
        self.choices = choices
        spans = [t.span for t in terms if t.end > t.start]
        self.said = (min(s for s, _ in spans), max(e for _, e in spans)) if spans else (0, 0)
        self.words = words or (choices if spans else tuple("" for _ in choices))
        super().__init__(question)

    def answers(self) -> Iterator[tuple[str, str]]:
        """Each choice with its words."""
        return zip(self.choices, self.words, strict=True)

    def words_of(self, answer: str) -> str | None:
        """The words of the choice that an answer names; None if it names none."""
        named = [w for c, w in self.answers() if c.lower() == answer.strip().lower()]
        return named[0] if named else None


def text_of(terms: Iterable[Term]) -> str:
    """Terms as they stand in the request."""
    text = " ".join(t.text for t in sorted(terms, key=lambda t: (t.start, t.end)) if t.text)
    return re.sub(r"(?<=\w) ([-\u2013]) (?=\w)", r"\1", text)  # a space before a dash would make it a comma


def spans_of(terms: Iterable[Term]) -> tuple[Span, ...]:
    """Where terms stand in the request: ranges that follow each other are one."""
    merged: list[Span] = []
    for start, end in sorted({t.span for t in terms if t.end > t.start}):
        if merged and start <= merged[-1][1] + 1:
            merged[-1] = (merged[-1][0], max(end, merged[-1][1]))
        else:
            merged.append((start, end))
    return tuple(merged)


def idle_place(terms: Iterable[Term]) -> Unclear:
    """Return the fault of a place without anything to do there."""
    return unclear(terms, message("it does not say what to do there"), message("say what to take or measure there"))


def unclear(terms: Iterable[Term], what: str, advice: str = PLAINLY) -> Unclear:
    """Return a fault of some terms, which it quotes; it is final if its advice says more than to use other words."""
    terms = tuple(terms)
    quoted = message("'{said}': {what}", said=text_of(terms), what=what)
    return Unclear(Reason(what=quoted, said=spans_of(terms), advice=advice, final=advice != PLAINLY))
