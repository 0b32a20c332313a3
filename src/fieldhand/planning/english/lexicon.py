"""From words to terms: the shared vocabulary together with what this robot and this site are called in words."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cache
from typing import Any

from fieldhand.planning.english import vocabulary as v
from fieldhand.planning.english.tokens import Term, Word
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Entry:
    """What a phrase is: a terminal of the grammar, its value, and whether it is a noun in the plural."""

    kind: str
    value: Any = None
    plural: bool = False


@dataclass(frozen=True, kw_only=True)
class Naming:
    """What a noun may mean to this robot: actions that yield it, quantities that it names."""

    actions: tuple[str, ...] = ()
    quantities: tuple[str, ...] = ()


Phrase = tuple[str, ...]


@dataclass(frozen=True)
class Lexicon:
    """Phrases and what they are; the longest one that fits is taken."""

    entries: dict[Phrase, Entry]
    longest: int
    words: frozenset[str] = field(default_factory=frozenset)

    def terms(self, words: list[Word]) -> list[Term]:
        """The words as terms. A word that no phrase holds is a term of kind ``UNKNOWN``; a full stop is ``STOPMARK``."""
        found: list[Term] = []
        at = 0
        while at < len(words):
            term, used = self._match(words, at)
            found.append(term)
            at += used
        return found

    def _match(self, words: list[Word], at: int) -> tuple[Term, int]:
        word = words[at]
        if word.kind in ("word", "unit", "number"):
            phrase: list[str] = []
            best: tuple[Entry, int] | None = None
            used = 0
            for ahead in words[at:]:
                used += 1
                if ahead.kind == "dash" and phrase:
                    continue
                if ahead.kind not in ("word", "unit", "number") or len(phrase) >= self.longest:
                    break
                phrase.append(ahead.norm)
                entry = self.entries.get(tuple(phrase))
                if entry is not None:
                    best = (entry, used)
            if best is not None:
                entry, used = best
                last = words[at + used - 1]
                text = " ".join(w.text for w in words[at : at + used])
                return (
                    Term(
                        kind=entry.kind,
                        text=text,
                        start=word.start,
                        end=last.end,
                        value=entry.value,
                        plural=entry.plural,
                    ),
                    used,
                )
        kind = {"number": "NUM", "stop": "STOPMARK", "comma": "COMMA", "dash": "DASH"}.get(word.kind, "UNKNOWN")
        if word.kind == "sign":
            kind = "AND"
        value = float(word.norm.replace(",", "")) if kind == "NUM" else None
        return Term(kind=kind, text=word.text, start=word.start, end=word.end, value=value), 1

    def nearest(self, word: str) -> tuple[str, ...]:
        """Known words that look like this one."""
        return tuple(get_close_matches(word.lower(), self.words, n=2, cutoff=0.75))


def lexicon_for(robot: RobotProfile, site: Site) -> Lexicon:
    """The lexicon of a robot on a site. The robot's words come before the site's, and neither replaces function words."""
    entries = dict(_shared())
    for phrase, entry in _site_entries(site):
        entries.setdefault(phrase, entry)
    entries.update(_robot_entries(robot))
    return Lexicon(
        entries=entries,
        longest=max(len(p) for p in entries),
        words=frozenset(w for p in entries for w in p if len(w) > 2),
    )


def split(phrase: str) -> Phrase:
    """A phrase as words in the form in which the lexicon keeps them."""
    return tuple(w for w in re.split(r"[\s_\-–]+", phrase.lower().replace("’", "'")) if w)


@cache
def _shared() -> Mapping[Phrase, Entry]:
    entries: dict[Phrase, Entry] = {}

    def add(phrases: str | Iterable[str], kind: str, value: Any = None, plural: bool = False) -> None:
        for phrase in phrases.split("|") if isinstance(phrases, str) else phrases:
            entries[split(phrase)] = Entry(kind=kind, value=value, plural=plural)

    add(v.FILLER, "FILLER")
    for kind, phrases in v.NOUNS.items():
        for phrase in phrases.split("|"):
            add([phrase], kind)
            add([plural_of(phrase)], kind, None, True)
    for kind, phrases in v.VERBS.items():
        for phrase in phrases.split("|"):
            for form in forms_of(phrase):
                entries.setdefault(split(form), Entry(kind=kind))
            entries[split(phrase)] = (
                Entry(kind=kind)
                if kind != "RETURN" or phrase not in ("end", "finish")
                else entries.get(split(phrase), Entry(kind=kind))
            )
    for kind, phrases in v.WORDS.items():
        add(phrases, kind, kind)
    add(v.PURPOSE, "PURPOSE")
    for phrases, advice in v.NOT_YET.items():
        add(phrases, "NOTYET", advice)
    for number, word in enumerate(v.NUMBERS):
        add([word], "NUM", float(number))
    for tens, word in ((n, w) for w, n in v.TENS.items()):
        add([word], "NUM", float(tens))
    for tens, name in (
        (20, "twenty"),
        (30, "thirty"),
        (40, "forty"),
        (50, "fifty"),
        (60, "sixty"),
        (70, "seventy"),
        (80, "eighty"),
        (90, "ninety"),
    ):
        for unit in range(1, 10):
            add([f"{name} {v.NUMBERS[unit]}"], "NUM", float(tens + unit))
    for rank, word in enumerate(v.ORDINALS, start=1):
        add([word, f"{rank}{ {1: 'st', 2: 'nd', 3: 'rd'}.get(rank, 'th') }", f"very {word}"], "ORD", rank)
    add("last|final|very last", "LAST")
    for word, count in v.COUNTS.items():
        add([word], "COUNT", count)
    _add_compass(add)
    for test, phrases in v.COMPARE.items():
        add(phrases, "CMP", (test, ""))
    for word, (test, attribute) in v.COMPARE_ATTRIBUTE.items():
        add([word], "CMP", (test, attribute))
    for word, meaning in v.SUPERLATIVES.items():
        add([word], "SUPER", meaning)
    for word, level in v.LEVELS.items():
        add([word], "LEVEL", level)
    for phrases, unit in v.UNITS.items():
        for phrase in phrases.split("|"):
            entries.setdefault(split(phrase), Entry(kind="UNIT", value=unit))
    # These are units only behind a number; the grammar's words come first.
    entries[("second",)] = Entry(kind="ORD", value=2)
    entries[("up", "to")] = Entry(kind="UPTO")
    return entries


def _add_compass(add: Any) -> None:
    for word, side in v.SIDES.items():
        add([word], "DIR", side)
    for side in ("north", "east", "south", "west"):
        names = [w for w, s in v.SIDES.items() if s == side]
        add(
            [
                f"{side}ernmost",
                f"{side}most",
                f"most {side}ern",
                f"most {side}erly",
                f"furthest {side}",
                f"farthest {side}",
                f"{side}ernmost part",
                f"far {side}",
                f"extreme {side}",
                f"extreme {side}ern",
                *(f"{n} most" for n in names),
            ],
            "MOST",
            side,
        )
    for first in ("north", "south"):
        for second in ("east", "west"):
            corner = first[0] + second[0]
            add(
                [
                    corner,
                    f"{first}{second}",
                    f"{first} {second}",
                    f"{first}{second}ern",
                    f"{first} {second}ern",
                    f"{first}ern {second}ern",
                    f"{first}{second}erly",
                ],
                "DIR",
                corner,
            )
            add(
                [
                    f"{first}{second}ernmost",
                    f"{first}{second}most",
                    f"{first} {second}ernmost",
                    f"{first} {second}ern most",
                    f"most {first}{second}ern",
                    f"most {first} {second}ern",
                ],
                "MOST",
                corner,
            )


def _robot_entries(robot: RobotProfile) -> dict[Phrase, Entry]:
    """Nouns and verbs of the robot's own. A word of several actions keeps them all, the first being the usual one."""
    actions: dict[Phrase, list[str]] = {}
    quantities: dict[Phrase, list[str]] = {}
    entries: dict[Phrase, Entry] = {}
    for action in robot.actions:
        for word in (*action.words, action.name):
            actions.setdefault(split(word), []).append(action.name)
    for quantity in robot.quantities:
        for word in (*quantity.words, quantity.name):
            quantities.setdefault(split(word), []).append(quantity.name)
    for phrase in {*actions, *quantities}:
        named = actions.get(phrase, [])
        measured = quantities.get(phrase, [])
        named = named + [a.name for a in robot.actions if a.name not in named and set(a.measures) & set(measured)]
        naming = Naming(actions=tuple(named), quantities=tuple(measured))
        entries[phrase] = Entry(kind="NOUN", value=naming)
        entries[(*phrase[:-1], plural_of(phrase[-1]))] = Entry(kind="NOUN", value=naming, plural=True)
    for action in robot.actions:
        for verb in action.verbs:
            for form in forms_of(verb):
                entries[split(form)] = Entry(kind="ACTV", value=Naming(actions=(action.name,)))
    return {
        p: e
        for p, e in entries.items()
        if p not in _shared() or _shared()[p].kind in ("READING", "ATTR", "FILLER") or e.kind == "NOUN"
    }


def _site_entries(site: Site) -> Iterable[tuple[Phrase, Entry]]:
    attributes = site.attributes
    values: dict[Phrase, list[tuple[str, str]]] = {}
    names: dict[Phrase, list[str]] = {}
    for attribute, found in attributes.items():
        texts = [value for value in found if isinstance(value, str)]
        if len(texts) <= 200:
            for text in texts:
                if len(text) <= 40 and split(text):
                    values.setdefault(split(text), []).append((attribute, text))
        base = [w for w in split(attribute) if w not in ("m", "kg", "years", "cm", "mm", "of", "the", "percent", "pct")]
        spoken = {" ".join(split(attribute)), " ".join(base)}
        for hint, words in v.ALIASES.items():
            if hint in base:
                spoken |= {" ".join(base).replace(hint, w) for w in words.split("|")} | set(words.split("|"))
        for phrase in spoken:
            if phrase:
                names.setdefault(split(phrase), []).append(attribute)
    for phrase, meant in values.items():
        yield phrase, Entry(kind="ATTRVAL", value=tuple(meant))
        yield (*phrase[:-1], plural_of(phrase[-1])), Entry(kind="ATTRVAL", value=tuple(meant), plural=True)
    for phrase, attribute_names in names.items():
        yield phrase, Entry(kind="ATTR", value=tuple(attribute_names))
        yield (*phrase[:-1], plural_of(phrase[-1])), Entry(kind="ATTR", value=tuple(attribute_names), plural=True)
    for zone in site.zones:
        if zone.kind != "boundary" and split(zone.name) and len(zone.name) <= 60:
            yield split(zone.name), Entry(kind="ZONE", value=zone.name)
            yield (*split(zone.name), "zone"), Entry(kind="ZONE", value=zone.name)
            yield ("zone", *split(zone.name)), Entry(kind="ZONE", value=zone.name)
            yield (*split(zone.name), "area"), Entry(kind="ZONE", value=zone.name)


def plural_of(phrase: str) -> str:
    """The plural of a noun, by rule."""
    irregular = {
        "half": "halves",
        "leaf": "leaves",
        "bush": "bushes",
        "property": "properties",
        "boundary": "boundaries",
    }
    head, _, last = phrase.rpartition(" ")
    if last in irregular:
        plural = irregular[last]
    elif last.endswith("y") and last[-2:-1] not in "aeiou":
        plural = last[:-1] + "ies"
    elif last.endswith(("s", "x", "z", "ch", "sh")):
        plural = last + "es"
    else:
        plural = last + "s"
    return f"{head} {plural}".strip()


_IRREGULAR = {
    "take": "took taken",
    "get": "got",
    "make": "made",
    "do": "did done",
    "go": "went gone",
    "drive": "drove driven",
    "shoot": "shot",
    "run": "ran",
    "find": "found",
    "choose": "chose chosen",
    "come": "came",
    "head": "headed",
    "begin": "began begun",
    "keep": "kept",
    "read": "read",
    "stop": "stopped",
    "snap": "snapped",
    "grab": "grabbed",
    "travel": "travelled",
    "quit": "quit",
    "scan": "scanned",
}
_DOUBLED = {"get", "grab", "run", "stop", "snap", "quit", "begin", "travel", "scan"}


def forms_of(phrase: str) -> list[str]:
    """A verb phrase in every form, its first word inflected."""
    verb, _, rest = phrase.partition(" ")
    if verb.endswith("e") and not verb.endswith("ee"):
        made = [verb, verb + "s", verb[:-1] + "ing", verb + "d"]
    elif verb in _DOUBLED:
        made = [verb, verb + "s", verb + verb[-1] + "ing", verb + verb[-1] + "ed"]
    elif verb.endswith(("s", "x", "ch", "sh", "o")):
        made = [verb, verb + "es", verb + "ing", verb + "ed"]
    else:
        made = [verb, verb + "s", verb + "ing", verb + "ed"]
    made += _IRREGULAR.get(verb, "").split()
    return [f"{m} {rest}".strip() for m in made]
