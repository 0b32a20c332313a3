"""The words of Spanish together with those of a robot and of a site."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from itertools import chain
from typing import Any

from fieldhand.planning.english.lexicon import Lexicon, lexicon_for
from fieldhand.planning.english.naming import NameEntry, Naming, Phrase
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.spanish.earlier import earlier_edges
from fieldhand.planning.grammar.spanish.inflection import adjective_forms, plural_of, verb_forms
from fieldhand.planning.grammar.spanish.lexicon import tables
from fieldhand.planning.grammar.spanish.tokens import folded, words_of
from fieldhand.planning.grammar.words import FeatureTable
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

#: Sides of the compass whose extreme a word names, opposite ones as a way.
_WAYS = (("west", "east"), ("east", "west"), ("north", "south"), ("south", "north"))
#: Categories of a word of the robot or the site.
_OWN = frozenset({"NOUN", "ACTV", "ATTR", "ATTRVAL", "ZONE"})


@dataclass(frozen=True)
class SpanishPhrases:
    """The words of Spanish together with those of a robot and of a site.

    Attributes:
        lexicon: Names of the site, and the words of the robot's profile and of the site's file.
        robot: Robot profile.
    """

    lexicon: Lexicon
    robot: RobotProfile

    @cached_property
    def longest(self) -> int:
        """The number of words of the longest phrase."""
        return max(len(phrase) for phrase in chain(shared(), self._own))

    def features(self, phrase: Phrase) -> frozenset[str]:
        """Return the features of a phrase."""
        return _features().of(phrase)

    def spotted(self, words: Sequence[Word]) -> Iterator[tuple[str, int, int, Any]]:
        """Yield the phrases about earlier missions; events are understood in English only."""
        yield from earlier_edges(words, self.robot)

    def entries(self, phrase: Phrase) -> Iterator[NameEntry]:
        """Yield everything that a phrase can be."""
        known = shared().get(phrase, ())
        yield from known
        yield from self._own.get(phrase, ())
        named = self.lexicon.own.get(phrase)
        if not known and named is not None and named.kind in _OWN:
            yield named
        elif not known and len(phrase) == 1 and phrase[0] in self.lexicon.short_values:
            yield NameEntry(kind="ATTRVAL", value=(self.lexicon.short_values[phrase[0]],))

    @cached_property
    def _own(self) -> Mapping[Phrase, tuple[NameEntry, ...]]:
        """Spanish words for those of the robot's profile and of the site's file."""
        words, site = tables()["robots"], tables()["site"]
        found: dict[Phrase, list[NameEntry]] = defaultdict(list)
        for english, nouns in words["nouns"].items():
            if (entry := self._noun(english)) is not None:
                for noun in nouns:
                    _add_noun(found, split(noun), entry)
                    for head, reading in _heads(words["heads"]):
                        of = self._noun(f"{english} {head}") or entry
                        _add_noun(found, (*split(reading), "de", *split(noun)), of)
        for english, nouns in words["articled"].items():
            if (entry := self._noun(english)) is not None:
                for noun in map(split, nouns):
                    found[plural_of(noun)].append(replace(entry, plural=True))
                    for article in ("la", "una", "otra", "esa", "esta"):
                        phrase = (article, *noun)
                        found[phrase].append(entry)
        for english, verbs in words["verbs"].items():
            if (entry := self._meant(english, "ACTV")) is not None:
                for verb in verbs:
                    for inflected in verb_forms(folded(verb), tables()["irregular"]):
                        found[(inflected,)].append(NameEntry(kind="ACTV", value=entry.value))
        for kind, table in (("ATTRVAL", site["values"]), ("ATTR", site["attributes"])):
            for english, phrases in table.items():
                if (entry := self._meant(english, kind)) is not None:
                    for phrase in map(split, phrases):
                        for form, plural in adjective_forms(phrase):
                            found[form].append(NameEntry(kind=kind, value=entry.value, plural=plural))
        for name, known in self.lexicon.own.items():
            if known.kind == "ZONE":
                zone = ("zona", *name)
                found[zone].append(known)
        return {phrase: tuple(dict.fromkeys(entries)) for phrase, entries in found.items()}

    def _meant(self, english: str, kind: str) -> NameEntry | None:
        """Return what an English word is to this robot and site, if it is of a kind."""
        entry = self.lexicon.own.get(tuple(english.split()))
        return entry if entry is not None and entry.kind == kind else None

    def _noun(self, english: str) -> NameEntry | None:
        """Return what a noun of the profile names; a capture that measures one quantity names that as well."""
        entry = self._meant(english, "NOUN")
        if entry is None:
            return None
        naming: Naming = entry.value
        if naming.actions and not naming.quantities:
            naming = replace(naming, quantities=tuple(self.robot.action[naming.actions[0]].measures))
        return NameEntry(kind="NOUN", value=naming)


#: Phrases made last: inflecting the words of a robot and of a site takes as long as reading a short request.
_made: deque[SpanishPhrases] = deque(maxlen=4)


def phrases_for(robot: RobotProfile, site: Site) -> SpanishPhrases:
    """Return the words of Spanish for a robot on a site, which are kept for the next request."""
    lexicon = lexicon_for(robot, site)
    for phrases in tuple(_made):
        if phrases.lexicon is lexicon and phrases.robot is robot:
            return phrases
    phrases = SpanishPhrases(lexicon, robot)
    _made.append(phrases)
    return phrases


def split(phrase: str) -> Phrase:
    """Return a phrase of the lexicon as words in the form in which requests have them."""
    return tuple(
        norm
        for part in phrase.split()
        for norm in ([part] if part.startswith("-") else [word.norm for word in words_of(part)])
    )


@cache
def _features() -> FeatureTable:
    return FeatureTable.read(tables(), lambda phrase: split(phrase) or (phrase,))


@cache
def shared() -> Mapping[Phrase, tuple[NameEntry, ...]]:
    """Return the words that every robot and every site share, inflected, by phrase."""
    found: dict[Phrase, list[NameEntry]] = defaultdict(list)
    for phrase, entry in _entries(tables()):
        found[phrase].append(entry)
    return {phrase: tuple(dict.fromkeys(entries)) for phrase, entries in found.items()}


def _entries(t: Mapping[str, Any]) -> Iterator[tuple[Phrase, NameEntry]]:
    for kind, phrases in t["words"].items():
        yield from ((split(phrase), NameEntry(kind=kind)) for phrase in phrases)
    for kind, phrases in t["nouns"].items():
        for phrase in map(split, phrases):
            yield phrase, NameEntry(kind=kind)
            yield plural_of(phrase), NameEntry(kind=kind, plural=True)
    for kind, phrases in t["verbs"].items():
        for phrase in phrases:
            verb, *rest = split(phrase)
            for form in verb_forms(verb, t["irregular"]):
                yield (form, *rest), NameEntry(kind=kind)
    for kind, phrases in t["adjectives"].items():
        yield from _inflected(kind, None, phrases)
    yield from _numbers(t)
    yield from _compass(t)
    for test, phrases in t["compare"].items():
        yield from ((split(phrase), NameEntry(kind="CMP", value=(test, ""))) for phrase in phrases)
    for test, phrases in t["compare_adjectives"].items():
        yield from _compared((test, ""), phrases)
    for known in t["compare_attribute"]:
        value = (known["test"], known["attribute"])
        yield from _compared(value, known["words"])
        yield from ((split(phrase), NameEntry(kind="CMP", value=value)) for phrase in known["fixed"])
    for known in t["superlatives"]:
        yield from _inflected("SUPER", (known["attribute"], known["lowest"]), known["words"])
    for level, phrases in t["levels"].items():
        yield from _inflected("LEVEL", level, phrases)
    for known in t["units"]:
        unit = (known["unit"], known["factor"], known["offset"])
        yield from ((unit_phrase(word), NameEntry(kind="UNIT", value=unit)) for word in known["words"])
    for by, phrases in t["orders"].items():
        yield from ((split(phrase), NameEntry(kind="ORDERED", value=(by, "", False))) for phrase in phrases)


def unit_phrase(text: str) -> Phrase:
    """Return a unit as words in the form in which requests have them: "°C" behind a number is one."""
    return tuple(word.norm for word in words_of(f"1 {text}")[1:])


def _inflected(kind: str, value: Any, phrases: Iterable[str]) -> Iterator[tuple[Phrase, NameEntry]]:
    """Yield phrases that end in an adjective, or have one before a preposition, in every gender and number."""
    for phrase in map(split, phrases):
        head, tail = _adjective_of(phrase)
        for form, plural in adjective_forms(head):
            yield (*form, *tail), NameEntry(kind=kind, value=value, plural=plural)


def _compared(value: Any, phrases: Iterable[str]) -> Iterator[tuple[Phrase, NameEntry]]:
    """Yield comparisons in every gender and number, as one entry each."""
    for phrase, entry in _inflected("CMP", value, phrases):
        yield phrase, replace(entry, plural=False)


def _adjective_of(phrase: Phrase) -> tuple[Phrase, Phrase]:
    """Return a phrase up to its adjective, and what follows it: "más viejo", "que"."""
    follow = {"que", "de", "a", "por", "en", "o", "entre", "uniformemente", "al"}
    end = next((k for k, word in enumerate(phrase) if k and word in follow), len(phrase))
    return phrase[:end], phrase[end:]


def _add_noun(found: dict[Phrase, list[NameEntry]], phrase: Phrase, entry: NameEntry) -> None:
    found[phrase].append(entry)
    found[plural_of(phrase)].append(replace(entry, plural=True))


def _heads(table: Mapping[str, Sequence[str]]) -> Iterator[tuple[str, str]]:
    for english, spanish in table.items():
        yield from ((english, head) for head in spanish)


def _numbers(t: Mapping[str, Any]) -> Iterator[tuple[Phrase, NameEntry]]:
    """Yield numbers in words up to 999, ranks, and how often something is done."""
    words: dict[Phrase, float] = {split(word): float(number) for word, number in t["numbers"].items()}
    below: dict[Phrase, float] = {phrase: n for phrase, n in words.items() if 0 < n < 100 and len(phrase) == 1}
    units: dict[Phrase, float] = {phrase: n for phrase, n in below.items() if n < 10}
    units |= {("un",): 1.0, ("una",): 1.0}
    tens = {phrase: n for phrase, n in below.items() if n >= 30}
    below |= {(*a, "y", *b): m + n for a, m in tens.items() for b, n in units.items()}
    hundreds = {phrase: n for phrase, n in words.items() if 100 <= n < 1000 and phrase != ("cien",)}
    words |= below | {(*a, *b): m + n for a, m in hundreds.items() for b, n in (below | units).items()}
    words |= {(*a, "mil"): 1000.0 * n for a, n in units.items() if n > 1}
    for phrase, number in words.items():
        yield phrase, NameEntry(kind="NUM", value=number)
    for phrase, number in (*words.items(), *(((str(n),), float(n)) for n in range(2, 21))):
        if 2 <= number <= 20:
            yield (*phrase, "veces"), NameEntry(kind="COUNT", value=int(number))
    yield ("una", "vez"), NameEntry(kind="COUNT", value=1)
    for rank, word in enumerate(t["ranks"]["words"], start=1):
        yield from _inflected("ORD", rank, [word])
    yield from (((word,), NameEntry(kind="ORD", value=rank)) for word, rank in t["ranks"]["short"].items())


def _compass(t: Mapping[str, Any]) -> Iterator[tuple[Phrase, NameEntry]]:
    sides, forms = t["sides"], t["compass"]
    for side, words in sides.items():
        for word in words:
            for form, plural in adjective_forms(split(word)) if word.endswith("al") else (((word,), False),):
                yield form, NameEntry(kind="DIR", value=side, plural=plural)
            for form in forms["most"]:
                for phrase in _most(form, word):
                    yield phrase, NameEntry(kind="MOST", value=side)
    for a, b in _WAYS:
        by = (f"{a}_to_{b}", "", False)
        for form in forms["orders"]:
            yield split(form.format(sides[a][0], sides[b][0])), NameEntry(kind="ORDERED", value=by)
        for form in forms["from"]:
            yield split(form.format(sides[a][0])), NameEntry(kind="ORDERED", value=by)


def _most(form: str, word: str) -> Iterator[Phrase]:
    """Yield the extreme of a side: "más al norte" with a noun, "más septentrionales" with an adjective."""
    is_adjective = word.endswith("al")
    if is_adjective != ("al {}" in form):
        said = split(form.format(word))
        yield said
        if is_adjective:
            yield (*said[:-1], *plural_of(said[-1:]))
