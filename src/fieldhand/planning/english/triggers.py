"""Words without which a rule cannot match: most rules are passed over by a look at the words of a request."""

from __future__ import annotations

import re

_WORD = re.compile(r"[a-z0-9']+")
#: More words than this are not worth keeping: the rule is tried every time.
_MOST = 60
#: Words that stand in most requests.
_EVERYDAY = frozenset(
    {
        "a",
        "an",
        "the",
        "of",
        "at",
        "in",
        "to",
        "and",
        "it",
        "is",
        "tree",
        "trees",
        "take",
        "picture",
        "then",
        "that",
        "if",
    }
)


def triggers(pattern: str) -> frozenset[str]:
    """Words of which every text has one that the pattern matches; empty if that cannot be told.

    Looks at the pattern's own level only: plain words, and groups of plain words that are not optional. What holds
    anything else says nothing, so that the answer is never wrong, but at times empty.
    """
    best: frozenset[str] = frozenset()
    for piece, optional in _pieces(pattern):
        found = frozenset() if optional else _words_of(piece)
        if found and (not best or _cost(found) < _cost(best)):
            best = found
    return best


def _cost(words: frozenset[str]) -> tuple[int, int]:
    """How often a look at these words helps little: everyday words stand in most requests."""
    return len(words & _EVERYDAY), len(words)


def _words_of(piece: str) -> frozenset[str]:
    """The words of which a piece needs one: the word itself, or one for each of a group's alternatives."""
    if not piece.startswith("("):
        return frozenset({piece})
    inner = piece[3:-1] if piece.startswith("(?:") else piece[1:-1]
    if inner.startswith("?"):
        return frozenset()  # looks ahead or behind
    found: set[str] = set()
    for alternative in _alternatives(inner):
        needed = triggers(alternative)
        if not needed:
            return frozenset()
        found |= needed
    return frozenset(found) if len(found) <= _MOST else frozenset()


def _alternatives(text: str) -> list[str]:
    """What stands between the bars of a pattern's own level."""
    made, depth, start, k = [], 0, 0, 0
    while k < len(text):
        char = text[k]
        if char == "\\":
            k += 2
            continue
        if char == "[":
            k = _after_class(text, k)
            continue
        depth += (char == "(") - (char == ")")
        if char == "|" and not depth:
            made.append(text[start:k])
            start = k + 1
        k += 1
    return [*made, text[start:]]


def _after_class(text: str, at: int) -> int:
    """The place behind a set of characters that begins at ``at``."""
    k = at + 1
    k += text[k : k + 1] == "^"
    k += text[k : k + 1] == "]"
    while k < len(text) and text[k] != "]":
        k += 2 if text[k] == "\\" else 1
    return k + 1


def _pieces(pattern: str) -> list[tuple[str, bool]]:
    """Groups and whole words of a pattern's own level, each with whether it may be left out."""
    if len(_alternatives(pattern)) > 1:
        return [(f"(?:{pattern})", False)]
    made: list[tuple[str, bool]] = []
    k = 0
    while k < len(pattern):
        if pattern[k] == "(":
            end = _after_group(pattern, k)
            made.append((pattern[k:end], _may_be_none(pattern, k, end)))
            k = end
            continue
        word = _WORD.match(pattern, k)
        if word is None:
            k = _after_class(pattern, k) if pattern[k] == "[" else k + (2 if pattern[k] == "\\" else 1)
            continue
        k = word.end()
        # Only words that stand alone: a part of one, or one with an optional letter, is no word of a request.
        before, after = pattern[word.start() - 1 : word.start()], pattern[k : k + 1]
        if before in ("", " ") and after in ("", " ") and pattern[k : k + 2] != " ?":
            made.append((word.group(), False))
    return made


def _after_group(pattern: str, at: int) -> int:
    depth, k = 0, at
    while k < len(pattern):
        if pattern[k] == "\\":
            k += 2
            continue
        if pattern[k] == "[":
            k = _after_class(pattern, k)
            continue
        depth += (pattern[k] == "(") - (pattern[k] == ")")
        k += 1
        if not depth:
            break
    return k


def _may_be_none(pattern: str, begin: int, end: int) -> bool:
    """Whether a group may be left out, or is a part of a word: then it says nothing."""
    before, after = pattern[begin - 1 : begin], pattern[end : end + 1]
    if before not in ("", " ") and not pattern[:begin].endswith((" )", " )?", "]", "*")):
        return True
    return after not in ("", " ", "+") or pattern[end : end + 2] == " ?"
