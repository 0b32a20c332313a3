"""English as a language of the grammar: its words are the shared vocabulary and those of english.toml."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from typing import Any

from fieldhand.compatibility import tomllib
from fieldhand.planning.english.inflection import forms_of, plural_of
from fieldhand.planning.english.lexicon import Lexicon, lexicon_for
from fieldhand.planning.english.naming import NameEntry, Naming, Phrase, split, takes_pictures
from fieldhand.planning.english.spelling import respelt
from fieldhand.planning.english.tokens import Word, ranges_of, words_of
from fieldhand.planning.english.vocabulary import questions, vocabulary
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.earlier.edges import earlier_edges
from fieldhand.planning.grammar.event_words import NO_EVENTS, EventPatterns, response_words, says_any_time
from fieldhand.planning.grammar.language import GrammarLanguage
from fieldhand.planning.grammar.planting_words import planting_edges
from fieldhand.planning.grammar.words import FeatureTable
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

#: Number of words of the longest phrase of english.toml that is read as a word.
_LONGEST = 6
#: What stands before the first word of a clause.
_CLAUSE_BEGINS = (". ", "; ", "! ", "? ", ", ", ": ", "and ", "then ", "please ", "hello ", "hi ")
#: Short forms.
_SPELT_OUT = {
    "temp": "temperature",
    "temps": "temperature",
    "temperatures": "temperature",
    "pic": "picture",
    "pics": "pictures",
    "img": "image",
    "imgs": "images",
    "therm": "thermal",
}
#: Words for pictures and for taking them, by what they are to the grammar.
_WITH_A_CAMERA = {"PICTURE": "NOUN", "THERMAL": "NOUN", "CAMERA": "ACTV", "THERMALLY": "ACTV"}
#: Those of a thermal camera only.
_THERMAL = frozenset({"THERMAL", "THERMALLY"})
#: Categories of phrases that are silent in the shared vocabulary only.
_SAY_SOMETHING = frozenset({"AVERAGEWORD", "CORRECTION", "ONEBYONE", "STATISTIC"})


@dataclass(frozen=True)
class EnglishPhrases:
    """The words of English together with those of a robot and of a site.

    Attributes:
        lexicon: Shared vocabulary, and the words of the robot and of the site.
        camera: Action that takes pictures, if the robot has just one.
        is_thermal: True if these are thermal pictures.
        events: Patterns of the robot's events.
    """

    lexicon: Lexicon
    camera: Naming | None
    is_thermal: bool = False
    events: EventPatterns = NO_EVENTS

    @property
    def longest(self) -> int:
        """The number of words of the longest phrase."""
        return max(self.lexicon.longest, _LONGEST)

    def features(self, phrase: Phrase) -> frozenset[str]:
        """Return the features of a phrase."""
        return _features().of(phrase)

    def spotted(self, words: Sequence[Word]) -> Iterator[tuple[str, int, int, Any]]:
        """Yield the events that words mention, and with them the words of responses."""
        found = list(self.events.mentions(words))
        for one in found:
            kind = "EVENTNOUN" if one.is_noun else "NOEVENT" if one.clear else "EVENT"
            yield kind, one.start, one.end, one.condition
        if found or says_any_time(words):
            yield from ((category, start, end, None) for category, start, end in response_words(words))
        yield from earlier_edges(words, self.lexicon, self.camera)
        yield from planting_edges(words, self.lexicon.site)

    def entries(self, phrase: Phrase) -> Iterator[NameEntry]:
        """Yield what a phrase can be: in the lexicon, spelt out, and in english.toml."""
        known = self.lexicon.entry(phrase)
        in_full = tuple(_SPELT_OUT.get(word, word) for word in phrase)
        own = more_words().get(phrase) or more_words().get(in_full, ())
        if known is not None and known.kind == "FILLER" and any(one.kind in _SAY_SOMETHING for one in own):
            known = None
        yield from self.lexicon.beside.get(phrase, ())
        if known is not None and known.kind == "WORKV":
            yield known  # "film row 3" is a recording, not a picture, where the robot records
            return
        if known is not None:
            yield known
            if (attribute := self.lexicon.attributes.get(phrase)) is not None:
                yield attribute
        else:
            asked = _asked_by_adjective().get(phrase)
            spelt_out = asked or in_full
            full = self.lexicon.entry(spelt_out)
            if full is not None and full.kind == "NOUN":
                yield replace(full, plural=full.plural or (asked is None and phrase[-1].endswith("s")))
            meant = _own()["same"].get(" ".join(phrase))
            same = None if meant is None else self.lexicon.entry(split(meant))
            if same is not None:
                yield same
        asked_how = _asked_how().get(phrase)
        told_by = None if asked_how is None else self.lexicon.entry(asked_how)
        if told_by is not None and told_by.kind == "NOUN":
            yield replace(told_by, kind="ASKHOW")
        medium = _own()["media"].get(" ".join(phrase))
        reading = None if medium is None else self.lexicon.entry(split(medium))
        if reading is not None:
            yield replace(reading, kind="MEDIUM")
        kind = "" if known is None else known.kind
        if known is None and len(phrase) == 1 and phrase[0] in self.lexicon.short_values:
            yield NameEntry(kind="ATTRVAL", value=(self.lexicon.short_values[phrase[0]],))
        for other in own:
            if other.kind in _WITH_A_CAMERA:
                meant = _WITH_A_CAMERA[other.kind]
                if self.camera is not None and meant != kind and (self.is_thermal or other.kind not in _THERMAL):
                    yield NameEntry(kind=meant, value=self.camera, plural=other.plural)
            elif other.kind != kind:
                yield other


@cache
def _own() -> Mapping[str, Any]:
    """Return the tables of english.toml."""
    return tomllib.loads((files("fieldhand.planning.grammar") / "english.toml").read_text(encoding="utf-8"))


@cache
def _features() -> FeatureTable:
    return FeatureTable.read(_own(), lambda phrase: split(phrase) or (phrase,))  # a dash has no words


def features_of(phrase: Phrase) -> frozenset[str]:
    """Return the features of a phrase of English."""
    return _features().of(phrase)


@cache
def _asked_by_adjective() -> Mapping[Phrase, Phrase]:
    """Return the names of readings by the questions for them: "how warm is the air"."""
    return {split(question): split(reading) for question, reading in questions().items()}


@cache
def _asked_how() -> Mapping[Phrase, Phrase]:
    """Return the names of readings by the questions for them, asked of an area: "how wet"."""
    table = _own()["asked_of_area"]
    return {split(f"how {adjective}"): split(reading) for reading, said in table.items() for adjective in said}


@cache
def more_words() -> Mapping[Phrase, tuple[NameEntry, ...]]:
    """Return the nouns that are verbs as well, and the words of english.toml, by phrase."""
    found: dict[Phrase, list[NameEntry]] = defaultdict(list)
    for kind, phrases in vocabulary()["nouns"].items():
        for phrase in phrases:
            found[split(phrase)].append(NameEntry(kind=kind))
            found[split(plural_of(phrase))].append(NameEntry(kind=kind, plural=True))
    own = _own()
    for kind, phrases in own["words"].items():
        for phrase in phrases:
            found[split(phrase)].append(NameEntry(kind=kind))
    for kind in ("PICTURE", "THERMAL"):
        for phrase in own["words"][kind]:
            found[split(plural_of(phrase))].append(NameEntry(kind=kind, plural=True))
    for phrase, value in own["derived"].items():
        found[split(phrase)].append(NameEntry(kind="SUPER", value=tuple(value)))
    for phrase, value in own["vague"].items():
        found[split(phrase)].append(NameEntry(kind="VAGUEADJ", value=tuple(value)))
    for phrase, part in own["parts"].items():
        found[split(phrase)].append(NameEntry(kind="PART", value=part))
    for kind, routes in own["routes"].items():
        for phrase, route in routes.items():
            found[split(phrase)].append(NameEntry(kind=kind, value=tuple(route)))
    for phrase, value in own["bounds"].items():
        found[split(phrase)].append(NameEntry(kind="BOUND", value=tuple(value)))
    for hint, phrases in own["dimensions"].items():
        for phrase in phrases:
            found[split(phrase)].append(NameEntry(kind="DIMENSION", value=hint))
    for of, phrases in own["statistics"].items():
        for phrase in phrases:
            found[split(phrase)].append(NameEntry(kind="STATISTIC", value=of))
    for phrase, value in own["most_read"].items():
        found[split(phrase)].append(NameEntry(kind="MOSTREAD", value=tuple(value)))
    for check, phrases in own["bare_comparisons"].items():
        for phrase in phrases:
            found[split(phrase)].append(NameEntry(kind="BARECMP", value=check))
    for kind, phrases in own["verbs"].items():
        for phrase in phrases:
            for form in forms_of(phrase):
                found[split(form)].append(NameEntry(kind=kind))
    return {phrase: tuple(entries) for phrase, entries in found.items()}


def phrases_for(robot: RobotProfile, site: Site) -> EnglishPhrases:
    """Return the words of English for a robot on a site."""
    camera = camera_of(robot)
    taking = [one for one in robot.actions if camera is not None and one.name in camera.actions]
    is_thermal = any("thermal" in split(word) for one in taking for word in one.words)
    return EnglishPhrases(lexicon_for(robot, site), camera, is_thermal, EventPatterns.of(robot))


def camera_of(robot: RobotProfile) -> Naming | None:
    """Return the action that takes pictures, if the robot has just one."""
    cameras = [action.name for action in robot.actions if takes_pictures(action)]
    return Naming(actions=(cameras[0],)) if len(cameras) == 1 else None


@cache
def _grammar() -> Grammar:
    from fieldhand.planning.grammar import commands, places

    made = Grammar()
    made.include(places.GRAMMAR)
    made.include(commands.GRAMMAR)
    return made


def _respelt(words: Sequence[Word], lexicon: Lexicon) -> tuple[list[Word], list[str]]:
    """Return words with small misspellings of any known word mended, and what was mended."""
    return respelt(words, lexicon.vocabulary | _more_single_words())


@cache
def _more_single_words() -> frozenset[str]:
    """Return every word of the phrases that the grammar adds to the shared vocabulary."""
    return frozenset(word for phrase in more_words() for word in phrase)


@cache
def _pattern(name: str) -> re.Pattern[str]:
    """Return a pattern of the phrases of a table of english.toml, at the beginning of clauses and anywhere."""
    table = _own()[name]
    parts = {name: part for name, part in table.items() if isinstance(part, str)}

    def spelt_out(pattern: str) -> str:
        while (whole := re.sub(r"\{(\w+)\}", lambda match: parts[match[1]], pattern)) != pattern:
            pattern = whole
        return pattern

    begin, anywhere = ("|".join(map(spelt_out, table.get(name, ()))) for name in ("begin", "anywhere"))
    clause = "|".join(f"(?<={re.escape(before)})" for before in _CLAUSE_BEGINS)
    at_begin = rf"(?:^|{clause})(?:{begin})"
    return re.compile(rf"(?:{at_begin}|(?<!\S)(?:{anywhere}))(?!\S)" if anywhere else rf"{at_begin}(?!\S)")


def _frames(words: Sequence[Word]) -> Iterator[tuple[int, int]]:
    """Yield the ranges of polite frames."""
    return ranges_of(_pattern("frames"), words)


def _aims(words: Sequence[Word]) -> Iterator[tuple[int, int]]:
    """Yield the ranges of the phrases with which purposes begin."""
    return ranges_of(_pattern("aims"), words)


ENGLISH = GrammarLanguage(
    code="en", words_of=words_of, phrases=phrases_for, grammar=_grammar, respelt=_respelt, frames=_frames, aims=_aims
)
