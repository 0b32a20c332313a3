"""The vocabulary that every robot and every orchard share, inflected, by phrase."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from typing import Any

from fieldhand.planning.english.inflection import forms_of, plural_of
from fieldhand.planning.english.naming import NameEntry, Phrase, split
from fieldhand.planning.english.vocabulary import vocabulary

#: Orders by the compass, as the lexicon of orders calls them.
_WAYS = (("west", "east"), ("east", "west"), ("north", "south"), ("south", "north"))
_TENS = ("twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety")
_UNITS = ("one", "two", "three", "four", "five", "six", "seven", "eight", "nine")


@cache
def shared_vocabulary() -> Mapping[Phrase, NameEntry]:
    """The shared vocabulary, inflected. What stands later here replaces what stands before it."""
    v = vocabulary()
    entries: dict[Phrase, NameEntry] = {}

    def add(phrases: Iterable[str], kind: str, value: Any = None, plural: bool = False) -> None:
        for phrase in phrases:
            entries[split(phrase)] = NameEntry(kind=kind, value=value, plural=plural)

    add(v["silent"]["filler"], "FILLER")
    for kind, phrases in v["nouns"].items():
        add(phrases, kind)
        add(map(plural_of, phrases), kind, plural=True)
    for kind, phrases in v["verbs"].items():
        for phrase in phrases:
            for form in forms_of(phrase):
                entries.setdefault(split(form), NameEntry(kind=kind))
            if phrase not in ("end", "finish"):  # these are nouns first; what stands around them tells
                add([phrase], kind)
    for kind, phrases in v["words"].items():
        add(phrases, kind, kind)
    add(v["silent"]["purpose"], "PURPOSE")
    for known in v["not_yet"]:
        add(known["phrases"], "NOTYET", known["advice"])
    for phrase, kind, value in (*_numbers(v), *_compass(v)):
        add([phrase], kind, value)
    for test, phrases in v["compare"].items():
        add(phrases, "CMP", (test, ""))
    for known in v["compare_attribute"]:
        add([known["word"]], "CMP", (known["test"], known["attribute"]))
    for known in v["superlatives"]:
        add(known["words"], "SUPER", (known["attribute"], known["lowest"]))
    for level, phrases in v["levels"].items():
        add(phrases, "LEVEL", level)
    for known in v["units"]:
        for phrase in known["words"]:
            entries.setdefault(
                split(phrase), NameEntry(kind="UNIT", value=(known["unit"], known["factor"], known["offset"]))
            )
    add(["up to"], "UPTO")
    for by, phrases in v["orders"].items():
        add(phrases, "ORDERED", (by, "", False))
    for by, phrase in _compass_orders(v):
        add([phrase], "ORDERED", (by, "", False))
    add(_spreading(), "SPREAD")
    return entries


def _compass_orders(v: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """ "From north to south", "starting in the west", "northernmost first"."""
    for a, b in _WAYS:
        by = f"{a}_to_{b}"
        for form in ("from {} to {}", "{} to {}", "from the {} to the {}", "from {}ernmost to {}ernmost",
                     "from the {}ernmost to the {}ernmost", "from the {}ern end to the {}ern end",
                     "from the {} end to the {} end", "from the {} side to the {} side"):  # fmt: skip
            yield by, form.format(a, b)
        for form in ("{}ernmost first", "the {}ernmost first", "the {}ernmost one first", "{}most first"):
            yield by, form.format(a)
        for form in ("{}wards", "{}ward", "going {}", "going {}wards", "heading {}", "driving {}", "working {}",
                     "working {}wards", "in the direction of the {}", "in {}erly direction", "towards the {}ern end",
                     "towards the {} end"):  # fmt: skip
            yield by, form.format(b)
        yield by, f"in the direction from {a} to {b}"
        yield by, f"in the direction {a} to {b}"
        for begin in ("working", "going"):
            for where in ("from", "at", "in", "on"):
                for word in v["sides"][a]:
                    for end in ("", " end", " side", " edge"):
                        if word == a or end:
                            yield by, f"{begin} {where} the {word}{end}"


def _spreading() -> Iterator[str]:
    """ "Evenly spread over": how free points lie in an area."""
    for verb in ("spread", "spread out", "distributed", "scattered"):
        for where in ("over", "across", "through", "throughout", "in", "around", "within", "all over"):
            yield f"{verb} {where}"
            for how in ("evenly", "uniformly", "equally"):
                yield f"{how} {verb} {where}"
                yield f"{verb} {how} {where}"


def _numbers(v: Mapping[str, Any]) -> Iterator[tuple[str, str, Any]]:
    for word, number in v["numbers"].items():
        yield word, "NUM", float(number)
    for rank, word in enumerate(v["ranks"]["words"], start=1):
        for form in (word, f"very {word}"):
            yield form, "ORD", rank
    for word in ("last", "final", "very last"):
        yield word, "LAST", None
    for word, count in v["counts"].items():
        yield word, "COUNT", count
    names = {number: word for word, number in v["numbers"].items()}
    for lead in v["shares"]["of"]:
        for number in range(2, v["shares"]["most"] + 1):
            yield f"{lead} {number}", "SHARE", number
            if number in names:
                yield f"{lead} {names[number]}", "SHARE", number


def _compass(v: Mapping[str, Any]) -> Iterator[tuple[str, str, str]]:
    for side, words in v["sides"].items():
        for word in words:
            yield word, "DIR", side
            yield f"{word} most", "MOST", side
        for form in ("{}ernmost", "{}most", "most {}ern", "most {}erly", "furthest {}", "farthest {}", "far {}"):
            yield form.format(side), "MOST", side
        for form in ("extreme {}", "extreme {}ern"):
            yield form.format(side), "MOST", side
    for first in ("north", "south"):
        for second in ("east", "west"):
            corner = first[0] + second[0]
            for form in ("{}{}", "{} {}", "{}{}ern", "{} {}ern", "{}ern {}ern", "{}{}erly"):
                yield form.format(first, second), "DIR", corner
            for form in ("{}{}ernmost", "{}{}most", "{} {}ernmost", "{} {}ern most", "most {}{}ern", "most {} {}ern"):
                yield form.format(first, second), "MOST", corner
            yield corner, "DIR", corner
