"""Words of English for times, as edges of a chart."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any

from fieldhand.compatibility import tomllib
from fieldhand.planning.english.numbers import spelt_numbers
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.english.vocabulary import vocabulary
from fieldhand.planning.grammar.chart import PhraseEdge
from fieldhand.planning.grammar.words import Lex

_LONGEST = 5
_MINUTE = re.compile(r"[0-5]\d")
_FOUR_DIGITS = re.compile(r"\d{4}")
_YEAR = re.compile(r"20[2-9]\d")
_ISO_DATE = re.compile(r"20\d\d-[01]\d-[0-3]\d")
#: Categories of the tables of the lexicon whose phrases have a value.
_TABLES = {
    "clock": "CLOCKNAME",
    "sun": "SUN",
    "daypart": "DAYPART",
    "day": "DAYNAME",
    "weekday": "WEEKDAY",
    "weekdays": "WEEKDAYS",
    "several_weekdays": "SEVERALDAYS",
    "month": "MONTH",
}
#: First words of commands that the vocabulary lacks, since they are those of robots.
_COMMANDS = frozenset(
    {
        "photograph",
        "image",
        "snap",
        "film",
        "spray",
        "mow",
        "record",
        "scan",
        "video",
        "cut",
        "please",
        "have",
        "let",
        "we",
    }
    | {"i", "you", "can", "could", "would", "and", "then"}
)
#: Days of a unit of time.
_LONG = {"day": 1, "days": 1, "week": 7, "weeks": 7}


@cache
def _entries() -> Mapping[tuple[str, ...], tuple[tuple[str, Any], ...]]:
    """Return category and value of each phrase."""
    text = (files("fieldhand.planning.grammar.times") / "english.toml").read_text(encoding="utf-8")
    table: dict[str, dict[str, Any]] = tomllib.loads(text)
    found: dict[tuple[str, ...], list[tuple[str, Any]]] = {}
    for category, phrases in table["words"].items():
        for phrase in phrases:
            found.setdefault(tuple(phrase.split()), []).append((category, None))
    for section, category in _TABLES.items():
        for phrase, value in table[section].items():
            kept = tuple(value) if isinstance(value, list) else value
            found.setdefault(tuple(phrase.split()), []).append((category, kept))
    for phrase, part in table["daypart"].items():
        found.setdefault((*phrase.split()[:-1], f"{phrase.split()[-1]}s"), []).append(("DAYPARTS", part))
    for unit, days in _LONG.items():
        found.setdefault((unit,), []).append(("LONG", days))
    return {phrase: tuple(entries) for phrase, entries in found.items()}


def time_edges(words: Sequence[Word]) -> Iterator[PhraseEdge]:
    """Yield an edge for each phrase that can be part of a time."""
    known = _entries()
    for start, word in enumerate(words):
        yield from _numbers(words, start)
        yield from _hours(words, start)
        phrase: list[str] = []
        for end in range(start + 1, min(start + _LONGEST, len(words)) + 1):
            phrase.append(words[end - 1].norm.lower())
            for category, value in known.get(tuple(phrase), ()):
                yield _edge(category, start, end, value, " ".join(phrase))
        if word.kind == "comma":
            yield _edge("COLON" if word.text.strip() == ":" else "COMMA", start, start + 1, None, word.text)


def _numbers(words: Sequence[Word], start: int) -> Iterator[PhraseEdge]:
    word = words[start]
    whole = "".join(one.text for one in words[start : start + 5])
    if _ISO_DATE.fullmatch(whole) and words[start].end - words[start].start == 4:
        yield _edge("ISODATE", start, start + 5, whole, whole)
    if word.kind == "rank":
        yield _edge("ORD", start, start + 1, int(re.sub(r"\D", "", word.norm)), word.norm)
    elif word.kind == "number":
        plain = word.norm.replace(",", "")
        yield _edge("NUM", start, start + 1, float(plain), word.norm)
        if _MINUTE.fullmatch(plain):
            yield _edge("MINUTE", start, start + 1, float(plain), word.norm)
        if _FOUR_DIGITS.fullmatch(plain):
            yield _edge("FOURDIGITS", start, start + 1, float(plain), word.norm)
        if _YEAR.fullmatch(plain):
            yield _edge("YEAR", start, start + 1, int(plain), word.norm)
    elif word.norm in (numbers := vocabulary()["numbers"]):
        yield _edge("NUM", start, start + 1, float(numbers[word.norm]), word.norm)
    elif word.norm in (ranks := vocabulary()["ranks"]["words"]):
        yield _edge("ORD", start, start + 1, ranks.index(word.norm) + 1, word.norm)
    for number in spelt_numbers(words, start):
        text = " ".join(one.norm for one in words[start : number.end])
        yield _edge("ORD" if number.is_rank else "NUM", start, number.end, float(number.value), text)


def _hours(words: Sequence[Word], start: int) -> Iterator[PhraseEdge]:
    """Yield a number from 1 to 12 that may be an hour, by the word behind it: "at 5 yellow trees" names none."""
    word = words[start]
    number = vocabulary()["numbers"].get(word.norm) if word.kind == "word" else None
    number = int(word.norm) if word.kind == "number" and word.norm.isdecimal() else number
    if number is None or number not in range(1, 13):
        return
    behind = words[start + 1] if start + 1 < len(words) else None
    if behind is None or behind.kind in ("comma", "stop") or behind.norm in _behind_hours():
        yield _edge("HOUR12", start, start + 1, float(number), word.norm)


@cache
def _behind_hours() -> frozenset[str]:
    """Return the words that may stand behind an hour: those of times, and verbs with which a command begins."""
    verbs = vocabulary()["verbs"]
    commands = {phrase.split()[0] for kind in ("TAKE", "MEASURE", "GO", "VISIT") for phrase in verbs[kind]}
    times = {phrase[0] for phrase in _entries()} - {
        "o",
        "h",
        "of",
        "the",
        "a",
        "an",
        "one",
        "second",
        "other",
        "past",
    }
    return frozenset(commands | times | _COMMANDS)


def _edge(category: str, start: int, end: int, value: Any, text: str) -> PhraseEdge:
    used = ((1 << (end - start)) - 1) << start
    return PhraseEdge(category, start, end, Lex(value, False, text), 0.0, used)
