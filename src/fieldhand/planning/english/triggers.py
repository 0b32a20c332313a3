"""Pieces of text without which a rule cannot match: nearly all rules are passed over by a look for them.

To look for a few letters in a request takes a thousandth of the time in which a regular expression is made ready.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

#: Of each set of pieces, one stands in every text that a pattern matches.
Triggers = tuple[frozenset[str], ...]

#: More pieces than this in one set are not worth looking for.
_MOST = 60
#: The sets that are kept for a pattern: those that the fewest requests hold come first.
_KEPT = 4
_TOKEN = re.compile(
    r"(?P<open>\((?:\?(?:<?[=!]|:))?)|(?P<close>\))|(?P<bar>\|)"
    r"|(?P<many>(?:\+|\{[1-9][^}]*\})\??)|(?P<perhaps>(?:[*?]|\{[^}]*\})\??)"
    r"|(?P<short><[A-Z]+>)|(?P<sign>\\[^\w])|(?P<plain>[^\\()\[|*+?{.^$<]+|<)"
    r"|(?P<other>\[\^?\]?(?:\\.|[^\]\\])*\]|\\x[0-9a-f]{2}|\\u[0-9a-f]{4}|\\.|.)"
)


def triggers(pattern: str, short: Mapping[str, Triggers]) -> Triggers:
    """What stands in every text that a pattern matches, as far as it is spelt out; empty where nothing is.

    Args:
        pattern: A regular expression, in which ``<NAME>`` stands for another.
        short: What stands in every text that one of those matches.
    """
    reader = _Reader()
    for token in _TOKEN.finditer(pattern):
        reader.read(str(token.lastgroup), token[0], short)
    return tuple(sorted(reader.whole(), key=_often)[:_KEPT])


def may_match(needed: Triggers, text: str) -> bool:
    """Whether a text holds one of each set of pieces."""
    for pieces in needed:
        for piece in pieces:
            if piece in text:
                break
        else:
            return False
    return True


class _Reader:
    """Reads a pattern from left to right, one token at a time."""

    def __init__(self) -> None:
        self.around: list[tuple[list[Triggers], list[frozenset[str]], str]] = []
        self.before: list[Triggers] = []  # the alternatives before this one
        self.found: list[frozenset[str]] = []  # of this alternative
        self.run = ""  # letters that stand side by side, up to here
        self.last = 0  # how many of those found are of the group right before

    def read(self, kind: str, token: str, short: Mapping[str, Triggers]) -> None:
        last, self.last = self.last, 0
        match kind:
            case "plain" | "sign":
                self.run += token if kind == "plain" else token[1:]
                return
            case "perhaps" if self.run:
                self.run = self.run[:-1]  # belongs to one letter alone
            case "perhaps":
                del self.found[len(self.found) - last :]
        self._end_run()
        match kind:
            case "open":
                self.around.append((self.before, self.found, token))
                self.before, self.found = [], []
            case "bar":
                self.before.append(tuple(self.found))
                self.found = []
            case "close":
                made = self.whole()
                self.before, self.found, opened = self.around.pop()
                self._add(() if opened.endswith("!") else made)
            case "short":
                self._add(short[token[1:-1]])

    def whole(self) -> Triggers:
        """What every text holds that matches one of the alternatives."""
        self._end_run()
        if not self.before:
            return tuple(self.found)
        return _either([*self.before, tuple(self.found)])

    def _add(self, made: Triggers) -> None:
        self.found += made
        self.last = len(made)

    def _end_run(self) -> None:
        if self.run.strip():
            self.found.append(frozenset({self.run}))
        self.run = ""


def _either(alternatives: Sequence[Triggers]) -> Triggers:
    if not all(alternatives):
        return ()
    pieces = frozenset().union(*(min(needed, key=_often) for needed in alternatives))
    return (pieces,) if len(pieces) <= _MOST else ()


def _often(pieces: frozenset[str]) -> float:
    """How many requests hold one of the pieces, by a rough guess: the longer a piece, the fewer."""
    return sum(2.0 ** -len(piece) for piece in pieces)
