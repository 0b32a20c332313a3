"""Numbers and ranks that several words spell out: "two hundred and fifty", "one fourteen", "twenty-first"."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache

from fieldhand.planning.english.tokens import Word
from fieldhand.planning.english.vocabulary import vocabulary

_SCALES = {"hundred": 100, "thousand": 1000}
#: Words that say a rank and not a number where they end one.
_RANKS_OF_SCALES = {"hundredth": 100, "thousandth": 1000}


@dataclass(frozen=True, kw_only=True)
class SpeltNumber:
    """A number that several words spell out.

    Attributes:
        value: The number.
        end: Number of the word behind it.
        is_rank: True for "hundred and first".
        in_parts: True if it is read in parts, as ids are: "one fourteen" for 114.
    """

    value: int
    end: int
    is_rank: bool = False
    in_parts: bool = False


def spelt_numbers(words: Sequence[Word], start: int) -> Iterator[SpeltNumber]:
    """Yield the numbers of two or more words that begin at a word, and a rank above the twentieth in one word."""
    texts = [word.norm for word in words[start : start + 12]]
    several = start > 0 and words[start - 1].norm.endswith("s")  # "trees one-fourteen" are fourteen
    parts = () if several and texts[1:2] == ["-"] else _in_parts(texts)
    for number in (*_whole(texts, 0), *parts):
        if number.end > 1 or (number.is_rank and number.value > len(vocabulary()["ranks"]["words"])):
            yield SpeltNumber(
                value=number.value, end=start + number.end, is_rank=number.is_rank, in_parts=number.in_parts
            )


def _whole(texts: Sequence[str], at: int) -> Iterator[SpeltNumber]:
    """Yield numbers below a million that begin at a text."""
    article = texts[at : at + 1] in (["a"], ["an"])
    first = [SpeltNumber(value=1, end=at + 1)] if article else list(_below_hundred(texts, at))
    if not article:
        yield from first
    for number in first:
        yield from _scaled(texts, number)


def _scaled(texts: Sequence[str], number: SpeltNumber) -> Iterator[SpeltNumber]:
    """Yield what a number becomes with the hundreds and thousands behind it, and with what follows these."""
    if number.is_rank:
        return
    at = _behind_dash(texts, number.end)
    text = texts[at] if at < len(texts) else ""
    scale = _SCALES.get(text) or _RANKS_OF_SCALES.get(text)
    if scale is None or (scale == 100 and (number.value >= 100 or number.value % 10 == 0)):
        return
    scaled = SpeltNumber(value=number.value * scale, end=at + 1, is_rank=text in _RANKS_OF_SCALES)
    yield scaled
    if scaled.is_rank:
        return
    if scale == 100:
        yield from _scaled(texts, scaled)
    at = _behind_dash(texts, scaled.end)
    at = _behind_dash(texts, at + 1) if texts[at : at + 1] == ["and"] else at
    for rest in _whole(texts, at) if scale == 1000 else _below_hundred(texts, at):
        if 0 < rest.value < scale:
            added = SpeltNumber(value=scaled.value + rest.value, end=rest.end, is_rank=rest.is_rank)
            yield added
            yield from _scaled(texts, added) if scale == 100 else ()


def _below_hundred(texts: Sequence[str], at: int) -> Iterator[SpeltNumber]:
    """Yield the numbers and ranks from 1 to 99 that begin at a text, and "hundredth"."""
    if at >= len(texts):
        return
    if (rank := _ranks().get(texts[at], _RANKS_OF_SCALES.get(texts[at]))) is not None:
        yield SpeltNumber(value=rank, end=at + 1, is_rank=True)
    number = _simple().get(texts[at])
    if number is None:
        return
    yield SpeltNumber(value=number, end=at + 1)
    after = _behind_dash(texts, at + 1)
    if number >= 20 and after < len(texts):
        for known, is_rank in ((_simple(), False), (_ranks(), True)):
            if 0 < known.get(texts[after], 0) < 10:
                yield SpeltNumber(value=number + known[texts[after]], end=after + 1, is_rank=is_rank)


def _in_parts(texts: Sequence[str]) -> Iterator[SpeltNumber]:
    """Yield the numbers from 101 on that are read like the name of a year: "one fourteen", "one oh four"."""
    hundreds = _simple().get(texts[0], 0) if texts else 0
    if not 0 < hundreds < 10:
        return
    at = _behind_dash(texts, 1)
    if texts[at : at + 1] in (["oh"], ["o"]):
        after = _behind_dash(texts, at + 1)
        rest = [one for one in _below_hundred(texts, after) if one.value < 10]
    else:
        rest = [one for one in _below_hundred(texts, at) if one.value >= 10]
    for number in rest:
        if not number.is_rank:
            yield SpeltNumber(value=100 * hundreds + number.value, end=number.end, in_parts=True)


def _behind_dash(texts: Sequence[str], at: int) -> int:
    """Return the number of a text, or of the one behind it if it is a dash."""
    return at + 1 if texts[at : at + 1] in (["-"], ["\N{EN DASH}"]) else at


@cache
def _simple() -> Mapping[str, int]:
    """Return the numbers from 1 to 19 and the tens by their words."""
    numbers = vocabulary()["numbers"]
    return {word: int(n) for word, n in numbers.items() if word.isalpha() and 1 <= n < 100 and word != "dozen"}


@cache
def _ranks() -> Mapping[str, int]:
    """Return the ranks from 1 to 19 and those of the tens by their words."""
    tens = {f"{word[:-1]}ieth": n for word, n in _simple().items() if n >= 20}
    return {word: rank for rank, word in enumerate(vocabulary()["ranks"]["words"], start=1)} | tens
