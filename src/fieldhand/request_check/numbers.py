"""Numbers of a request, in digits and in words."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from fieldhand.request_check import words as w
from fieldhand.request_check.words import Token

#: Maximum number of digits of a number.
_LONGEST = 15
_SCALES = {"hundred": 100.0, "thousand": 1000.0}
_RANK_ENDINGS = frozenset({"st", "nd", "rd", "th"})
#: How often something is done, as a sign: "x2".
_TIMES = re.compile(r"[x\u00d7](\d{1,2})")
#: What joins a half to the number before it.
_AND_A_HALF = (["and", "a", "half"], ["-", "and", "-", "a", "-", "half"])


@dataclass(frozen=True, kw_only=True)
class StatedNumber:
    """A number of the request, at the tokens from ``start`` to ``end``, the latter excluded."""

    value: float
    start: int
    end: int
    ordinal: bool = False


def numbers(tokens: Sequence[Token]) -> Iterator[StatedNumber]:
    """Yield numbers in digits and words."""
    k = 0
    while k < len(tokens):
        number = _number(tokens, k)
        if number is not None:
            yield number
        k = k + 1 if number is None else number.end


def _number(tokens: Sequence[Token], start: int) -> StatedNumber | None:
    """Return the number that begins at a token; None if there is none."""
    text = tokens[start].text
    if (times := _TIMES.fullmatch(text)) is not None:
        return StatedNumber(value=float(times[1]), start=start, end=start + 1)
    if w.is_number(text) and len(text) <= _LONGEST:
        value, end = float(text.replace(",", "")), start + 1
        joined = tokens[end].text if end < len(tokens) and tokens[end].joined else ""
        if joined in _RANK_ENDINGS:
            return StatedNumber(value=value, start=start, end=end + 1, ordinal=True)
        value, end = (value * 1000, end + 1) if joined == "k" else (value, end)
    elif text in w.ORDINALS:
        return StatedNumber(value=float(w.ORDINALS[text]), start=start, end=start + 1, ordinal=True)
    elif text in w.NUMBERS or text in _SCALES:
        value, end = _in_parts(tokens, start) or _spelt(tokens, start)
        if (rank := _rank_behind(value, tokens, end)) is not None:
            return StatedNumber(value=value + rank[0], start=start, end=rank[1], ordinal=True)
    elif text == "half" and _is_of_unit(tokens, start + 1):
        return StatedNumber(value=0.5, start=start, end=start + 2)
    elif start > 0 and tokens[start - 1].text == "within" and _is_of_unit(tokens, start):
        return StatedNumber(value=1.0, start=start, end=start + 1)  # "known to within a degree"
    else:
        return None
    half = next((len(said) for said in _AND_A_HALF if [t.text for t in tokens[end : end + len(said)]] == said), 0)
    return (
        StatedNumber(value=value + 0.5, start=start, end=end + half)
        if half
        else StatedNumber(value=value, start=start, end=end)
    )


def _is_of_unit(tokens: Sequence[Token], at: int) -> bool:
    """Return True for "a metre", "an hour" and "a degree" behind "half"."""
    texts = [token.text for token in tokens[at : at + 2]]
    units = w.LENGTHS.keys() | w.TIMES.keys() | w.DEGREES | w.PERCENT
    return len(texts) == 2 and texts[0] in ("a", "an") and texts[1] in units


def _spelt(tokens: Sequence[Token], start: int) -> tuple[float, int]:
    """Parse a number in words and return it with its end: "twenty five", "one thousand two hundred and fifty"."""
    thousands, below, end = 0.0, 0.0, start
    while (k := _behind_joint(tokens, start, end)) < len(tokens):
        text = tokens[k].text
        before = tokens[end - 1].text if end > start else ""
        if text in w.NUMBERS and (end == start or w.NUMBERS[text] < _room(before)):
            below += w.NUMBERS[text]
        elif text == "hundred" and below < 100:
            below = max(below, 1.0) * 100
        elif text == "thousand" and thousands == 0:
            thousands, below = max(below, 1.0) * 1000, 0.0
        else:
            break
        end = k + 1
    return thousands + below, end


def _behind_joint(tokens: Sequence[Token], start: int, end: int) -> int:
    """Return the token with which a number goes on behind "and" or a dash; the one behind the number if with none."""
    k = end
    while end > start and k < len(tokens) and tokens[k].text in ("and", "-"):
        k += 1
    joint = [token.text for token in tokens[end:k]]
    joins = tokens[end - 1].text in _SCALES or joint == ["-"]
    return k if joint and joins else end


def _in_parts(tokens: Sequence[Token], start: int) -> tuple[float, int] | None:
    """Return a tree's number that is read in parts, with its end: "tree one-fourteen", "trees one ten and two ten"."""
    before = tokens[start - 1].text if start > 0 else ""
    names = {"tree", "vine", "row", "number"} | ({"and", ","} | w.TREES if not _is_dash(tokens, start + 1) else set())
    if before not in names or not 1 <= w.NUMBERS.get(tokens[start].text, 0) < 10:
        return None
    at = start + 1 + _is_dash(tokens, start + 1)
    zero = at < len(tokens) and tokens[at].text in ("oh", "o")
    at = at + 1 + _is_dash(tokens, at + 1) if zero else at
    if at >= len(tokens) or tokens[at].text not in w.NUMBERS:
        return None
    rest, end = _spelt(tokens, at)
    fits = 1 <= rest < 10 if zero else 10 <= rest < 100
    return (100 * w.NUMBERS[tokens[start].text] + rest, end) if fits else None


def _is_dash(tokens: Sequence[Token], k: int) -> bool:
    return k < len(tokens) and tokens[k].text == "-"


def _rank_behind(value: float, tokens: Sequence[Token], end: int) -> tuple[int, int] | None:
    """Return the rank that ends a number in words, with its end: the "first" of "twenty-first"."""
    below = 100 if value % 100 == 0 else 10 if value % 10 == 0 else 0
    joint = tokens[end].text if end < len(tokens) else ""
    at = end + (joint == "-" or (joint == "and" and below == 100))
    rank = w.ORDINALS.get(tokens[at].text, below) if at < len(tokens) else below
    return (rank, at + 1) if rank < below else None


def _room(before: str) -> float:
    """Return the bound below which a number word continues the one before it."""
    if before in _SCALES:
        return 100.0
    return 10.0 if w.NUMBERS.get(before, 0.0) >= 20.0 else 0.0
