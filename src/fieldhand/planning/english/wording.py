"""Everyday turns of phrase put into words that the grammar knows, before the lexicon looks at them.

``wordings/`` holds the rules, in the order of its files: what may be said, as a regular expression over the words in
lower case, and what it stands for. Words that a rule keeps stay where they were said; those that it puts in stand for
the whole phrase.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from importlib.resources import files
from typing import Any

from fieldhand.planning.english.rule_cache import cached
from fieldhand.planning.english.runon import with_stops
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.english.triggers import Triggers, may_match, triggers
from fieldhand.task.filler_words import is_filler

_KEPT = re.compile(r"\$(\d)")


def reworded(words: Sequence[Word]) -> list[Word]:
    """The words after every rule, in the order of the file, each as often as it fits."""
    found = with_stops(_in_digits(words))
    text = _text(found)
    for needed, written, said in _rules():
        if not may_match(needed, text):
            continue
        pattern = _compiled(written)
        if pattern.search(text) is not None:
            found = _applied(pattern, said, found)
            text = _text(found)
    return found


def _text(words: Sequence[Word]) -> str:
    """The words as the rules see them; what a rule took out is no word to the next."""
    return " ".join(word.norm for word in words if word.norm)


_TEENS = ["ten", "eleven", "twelve", "thirteen", "fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen"]
_TENS = ["twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety"]
_ONES = ["one", "two", "three", "four", "five", "six", "seven", "eight", "nine"]
_SMALL = {
    **{word: k for k, word in enumerate(_ONES, start=1)},
    **{word: k for k, word in enumerate(_TEENS, start=10)},
    **{word: 10 * k for k, word in enumerate(_TENS, start=2)},
}


def _in_digits(words: Sequence[Word]) -> list[Word]:
    """ "Four hundred and fifty" as one number."""
    found: list[Word] = []
    at = 0
    while at < len(words):
        used, number = _hundreds([w.norm for w in words[at : at + 5]])
        if not used:
            found.append(words[at])
            at += 1
            continue
        group = words[at : at + used]
        text = " ".join(w.text for w in group)
        found.append(Word(kind="number", text=text, norm=str(number), start=group[0].start, end=group[-1].end))
        at += used
    return found


def _hundreds(said: Sequence[str]) -> tuple[int, int]:
    """How many words make a number of hundreds, and the number; 0 words if they make none."""
    if len(said) < 2 or said[1] != "hundred" or said[0] not in (*_ONES, "a"):
        return 0, 0
    total, used = 100 * _SMALL.get(said[0], 1), 2
    link = 1 if said[2:3] == ["and"] else 0
    rest = said[2 + link :]
    if rest and rest[0] in _SMALL:
        total, used = total + _SMALL[rest[0]], used + link + 1
        if rest[0] in _TENS and rest[1:2] and rest[1] in _ONES:
            total, used = total + _SMALL[rest[1]], used + 1
    return used, total


def _applied(pattern: re.Pattern[str], said: str, words: list[Word]) -> list[Word]:
    starts: list[int] = []
    text = ""
    for word in words:
        starts.append(len(text))
        text += word.norm + " " if word.norm else ""
    spoken = [(index, start, word) for index, (start, word) in enumerate(zip(starts, words, strict=True)) if word.norm]
    first_at = {start: index for index, start, _ in spoken}
    last_at = {start + len(word.norm): index for index, start, word in spoken}
    made: list[Word] = []
    done = 0
    for match in pattern.finditer(text.rstrip()):
        begin, end = match.span()
        end = begin + len(text[begin:end].rstrip())
        if begin not in first_at or end not in last_at or end <= begin or first_at[begin] < done:
            continue
        first, last = first_at[begin], last_at[end]
        if _swallows(pattern, said, match, words[first : last + 1]):
            continue
        made += words[done:first]
        made += _put(said, match, words, first, last, first_at, last_at)
        done = last + 1
    return [*made, *words[done:]]


def _put(
    said: str,
    match: re.Match[str],
    words: list[Word],
    first: int,
    last: int,
    first_at: dict[int, int],
    last_at: dict[int, int],
) -> list[Word]:
    """What a rule says in place of some words, which it keeps in part.

    A word that it puts in stands where the words stood that it replaces: before, between or behind those that are kept.
    """
    end = words[last].end
    made: list[Word] = []
    place, put = words[first].start, 0
    paraphrases = any(_KEPT.fullmatch(piece) is None for piece in said.split())
    for piece in said.split():
        kept = _KEPT.fullmatch(piece)
        if kept is None:
            kind = {",": "comma", ".": "stop"}.get(piece, "number" if piece.isdigit() else "word")
            made.append(Word(kind=kind, text=piece, norm=piece, start=place, end=end))
            put += 1
            continue
        number = int(kept[1])
        group = match.group(number)
        if not group or not group.strip():
            continue
        begin = match.start(number) + len(group) - len(group.lstrip())
        stop_at = begin + len(group.strip())
        if begin not in first_at or stop_at not in last_at:  # part of a word: "the northern end" as "north"
            made += [Word(kind="word", text=w, norm=w, start=place, end=end) for w in group.split()]
            put += len(group.split())
            continue
        group_words = words[first_at[begin] : last_at[stop_at] + 1]
        _end_at(made, put, max(place, group_words[0].start))
        if paraphrases and not put:
            group_words[0] = replace(group_words[0], start=min(place, group_words[0].start))
        made += group_words
        place, put = max(place, group_words[-1].end), 0
    if made and paraphrases and not put:
        made[-1] = replace(made[-1], end=max(end, made[-1].end))
    elif not put and place < end:
        # What is left says nothing to a plan; it is said all the same.
        made.append(Word(kind="silent", text="", norm="", start=place, end=end))
    return made


def _swallows(pattern: re.Pattern[str], said: str, match: re.Match[str], words: Sequence[Word]) -> bool:
    """Return True if a turn of phrase would take a word into itself that it does not name, and that means something.

    A rule may pass over some words of any kind. What it leaves out altogether shows among the words without a part;
    what it puts other words in place of would not show.
    """
    if not said:
        return False
    kept = " ".join(match.group(int(k)) or "" for k in _KEPT.findall(said)).split()
    for word in words:
        if word.norm in kept:
            kept.remove(word.norm)
        elif word.kind == "word" and not is_filler(word.norm) and not _names(pattern.pattern, word.norm):
            return True
    return False


@cache
def _names(pattern: str, word: str) -> bool:
    """Return True if a rule names a word, whole or with a prefix or an ending of its own."""
    plain = re.sub(r"\\[a-z]|\(\?<?[=!:]", " ", pattern)
    both = (re.sub(r"\[([a-z])([a-z])\]", rf"\{k}", plain) for k in (1, 2))
    letters = {piece for text in both for piece in re.split(r"[^a-z']+", text) if piece}
    return word in letters or any(word.startswith(p) and word.removeprefix(p) in {"", *letters} for p in letters)


def _end_at(made: list[Word], put: int, end: int) -> None:
    """End the last words, which were put in, where kept words begin."""
    for index in range(len(made) - put, len(made)):
        made[index] = replace(made[index], end=end)


@cache
def _texts() -> tuple[str, ...]:
    """Return the files of rules, in their order."""
    folder = files("fieldhand.planning.english") / "wordings"
    names = sorted(file.name for file in folder.iterdir() if file.name.endswith(".toml"))
    return tuple((folder / name).read_text(encoding="utf-8") for name in names)


@cache
def _rules() -> tuple[tuple[Triggers, str, str], ...]:
    """What a text must hold for a rule to match, what the rule matches, and what that means."""
    return tuple(
        (tuple(frozenset(pieces) for pieces in needed), written, means) for needed, written, means in _record()["rules"]
    )


@cache
def _record() -> dict[str, Any]:
    return cached(_texts(), _worked_out)


def _worked_out() -> dict[str, Any]:
    """Return all rules, and the abbreviations written out, each of which may hold those before it."""
    books = [tomllib.loads(text) for text in _texts()]
    short: dict[str, Triggers] = {}
    spelt: dict[str, str] = {}
    for name, pattern in (pair for book in books for pair in book.get("short", {}).items()):
        short[name] = triggers(pattern, short)
        spelt[name] = _spelt_out(pattern, spelt)
    rules = [
        ([sorted(pieces) for pieces in triggers(written, short)], written, rule["means"])
        for book in books
        for rule in book["rule"]
        for written in rule["said"]
    ]
    return {"rules": rules, "shorts": spelt}


@cache
def _compiled(written: str) -> re.Pattern[str]:
    """A rule between whole words. Few of them are ever needed, so each is made ready when it is."""
    spelt = _spelt_out(written, _record()["shorts"])
    return re.compile(rf"(?:(?<=\s)|^)(?:{spelt})(?:(?=\s|$)|(?<=\s))")


def _spelt_out(pattern: str, short: dict[str, str]) -> str:
    """A pattern with its abbreviations (``<DIR>``) written out; the point of a number ends no sentence."""
    pattern = re.sub(r"\[\^\.([^\]]*)\]", r"(?:[^.\1]|(?<=\\d)\\.(?=\\d))", pattern)
    return re.sub(r"<([A-Z]+)>", lambda m: f"(?:{short[m[1]]})", pattern)
