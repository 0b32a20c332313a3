"""A request in which answers stand in place of the words that were asked about."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from fieldhand.planning.english import draft as d
from fieldhand.planning.english.told import Told
from fieldhand.task.plan import Span


@dataclass(frozen=True, kw_only=True)
class Worded:
    """A request as it is read.

    Attributes:
        text: Its words, with what the answers put into it.
        origin: For each character, the range of the request as it was typed that it stands for.
    """

    text: str
    origin: tuple[Span, ...]

    @classmethod
    def typed(cls, request: str) -> Worded:
        """A request in which nothing has been replaced."""
        return cls(text=request, origin=tuple((at, at + 1) for at in range(len(request))))

    def with_words(self, said: Span, words: str) -> Worded:
        """The request with other words in place of a range of it."""
        start, end = said
        inside = self.span((start, end))
        text = f"{self.text[:start]}{words}{self.text[end:]}"
        return Worded(text=text, origin=(*self.origin[:start], *[inside] * len(words), *self.origin[end:]))

    def span(self, said: Span) -> Span:
        """The range of the typed request that a range of this one stands for."""
        covered = self.origin[said[0] : said[1]]
        if not covered:
            at = self.origin[said[0]][0] if said[0] < len(self.origin) else self.origin[-1][1]
            return (at, at)
        return (min(start for start, _ in covered), max(end for _, end in covered))

    def spans(self, said: Iterable[Span]) -> tuple[Span, ...]:
        """As :meth:`span` for several; what no typed word stands for is left out."""
        found = [self.span(one) for one in said]
        return tuple(dict.fromkeys((start, end) for start, end in found if start < end))


def as_typed(told: Told, worded: Worded) -> None:
    """Make every range of what was told one of the request as it was typed. ``told`` is changed."""
    for step, _ in d.walk(told.root):
        step.said = worded.spans(step.said)
        if isinstance(step, d.DraftCapture):
            step.at_said = worded.spans(step.at_said)
    told.limits = [limit.as_said(worded.span(limit.said)) for limit in told.limits]
    told.nominal_said = list(worded.spans(told.nominal_said))
    told.joints = list(worded.spans(told.joints))
    told.no_part = list(worded.spans(told.no_part))
