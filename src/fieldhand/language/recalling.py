"""Recognition of catalogue sentences in stored text, with a bounded number of steps."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from fieldhand.language.message import LOG
from fieldhand.language.po import Entry

#: Contexts of sentences recognized in text from a file, or from a package that does not use messages.
RECALLED = frozenset({"assumption", "question", "answer", "file", LOG})
#: Maximum number of placeholder ends tried for one text; a text not recognized by then stays unchanged.
_MOST_STEPS = 2_000
_FIGURE = r"[-\N{MINUS SIGN}]?\d[\d,]*(?:\.\d+)?"
QUANTITY = re.compile(rf"{_FIGURE}(?: [^\s,;]+)?")
#: Patterns of placeholder values in log sentences: numbers, optionally with a unit; words of a context; verbatim names.
#: Placeholders not listed accept any text.
SHAPES: Mapping[str, re.Pattern[str]] = {
    **dict.fromkeys(("amount", "limit", "low", "high", "reading"), QUANTITY),
    **dict.fromkeys(
        ("metres", "seconds", "percent", "factor", "chance", "used", "allowed", "level", "value"), re.compile(_FIGURE)
    ),
    "count": re.compile(r"\d+"),
    "time": re.compile(r"[\d:]+"),
    "name": re.compile(r"[^\d;:]+"),
    "id": re.compile(r"[^:;,()]+"),
    "ids": re.compile(r"[^:;()]+"),
    **dict.fromkeys(("action", "quantity", "role"), re.compile(r"[^\s:]+")),
}


class Effort:
    """Budget of the steps for recognizing one text."""

    def __init__(self) -> None:
        self._left = _MOST_STEPS

    def step(self) -> bool:
        """Use one step; return False if none is left."""
        self._left -= 1
        return self._left >= 0


@dataclass(frozen=True)
class Sentence:
    """A sentence with placeholders, matched against text.

    Attributes:
        template: Sentence with placeholders.
        literals: Fixed text before, between and after the placeholders.
        names: Names of the placeholders.
        shapes: Patterns of the placeholders that do not accept any text.
    """

    template: str
    literals: tuple[str, ...]
    names: tuple[str, ...]
    shapes: Mapping[str, re.Pattern[str]]

    def fills_of(self, text: str, effort: Effort) -> dict[str, str] | None:
        """Return the placeholder values if the text matches this sentence, each value as short as possible.

        Args:
            text: Complete text.
            effort: Step budget; if it is exhausted, the result is None.
        """
        first, last = self.literals[0], self.literals[-1]
        if not self.names:
            return {} if text == first else None
        if len(text) < len(first) + len(last) or not (text.startswith(first) and text.endswith(last)):
            return None
        return self._filled(text[: len(text) - len(last)], len(first), 0, {}, effort)

    def _filled(self, text: str, at: int, k: int, values: dict[str, str], effort: Effort) -> dict[str, str] | None:
        name, literal = self.names[k], self.literals[k + 1]
        shape, is_last = self.shapes.get(name), k == len(self.names) - 1
        end = at
        while effort.step():
            end = len(text) if is_last else text.find(literal, end)
            if end < 0:
                return None
            part = text[at:end]
            if values.get(name, part) == part and (shape is None or shape.fullmatch(part)):
                more = values | {name: part}
                rest = more if is_last else self._filled(text, end + len(literal), k + 1, more, effort)
                if rest is not None:
                    return rest
            if is_last:
                return None
            end += 1
        return None


def sentences(entries: Iterable[Entry]) -> dict[str, tuple[Sentence, ...]]:
    """Return the sentences of each context, sorted by descending amount of fixed text."""
    found: dict[str, list[Sentence]] = {}
    for entry in entries:
        if entry.context in RECALLED:
            for template in filter(None, (entry.template, entry.many)):
                parts = re.split(r"\{(\w+)\}", template)
                shapes = SHAPES if entry.context == LOG else {}
                one = Sentence(template, tuple(parts[::2]), tuple(parts[1::2]), shapes)
                found.setdefault(entry.context, []).append(one)
    return {
        context: tuple(sorted(held, key=lambda one: -sum(map(len, one.literals)))) for context, held in found.items()
    }
