"""Words of a request as edges of the chart: phrases of the lexicon, numbers, and names of this site."""

from __future__ import annotations

import re
import tomllib
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from typing import Any

from fieldhand.planning.english.inflection import forms_of, plural_of
from fieldhand.planning.english.lexicon import CODE, Lexicon
from fieldhand.planning.english.naming import NameEntry, Naming, Phrase, split
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.english.vocabulary import vocabulary
from fieldhand.planning.grammar.chart import PhraseEdge
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

#: Price of a word by itself; a phrase of several words costs no more, so that longer phrases are preferred.
_WORD_COST = 1.0
_SIGNS = {"comma": "COMMA", "dash": "DASH", "sign": "AND", "hash": "HASH", "stop": "FULLSTOP"}
#: Words of an action that takes pictures.
_PICTURES = frozenset({"picture", "photo", "image", "thermal picture"})
#: Short forms.
_SPELT_OUT = {"temp": "temperature", "temps": "temperature", "temperatures": "temperature", "pic": "picture"}
#: Words for pictures and for taking them, by what they are to the grammar.
_WITH_A_CAMERA = {"PICTURE": "NOUN", "CAMERA": "ACTV"}
#: Words that always may be skipped.
_SILENT = frozenset({"FILLER"})


@dataclass(frozen=True, slots=True)
class Lex:
    """A word or fixed phrase: its value in the lexicon, its number, and its text."""

    value: Any
    plural: bool
    text: str


def edges_of(words: Sequence[Word], lexicon: Lexicon, robot: RobotProfile) -> Iterator[PhraseEdge]:
    """Yield an edge for each phrase of the lexicon and each name of the site that the words contain."""
    cameras = [action.name for action in robot.actions if _PICTURES & set(action.words)]
    camera = Naming(actions=(cameras[0],)) if len(cameras) == 1 else None
    for start, word in enumerate(words):
        yield from _single(word, start)
        yield from _names(words, start, lexicon)
        phrase: list[str] = []
        for end in range(start + 1, min(start + 1 + lexicon.longest, len(words) + 1)):
            last = words[end - 1]
            if last.kind == "dash" and end - 1 > start:
                continue
            if last.kind not in ("word", "unit", "number", "rank"):
                break
            phrase.append(last.norm)
            text = " ".join(word.norm for word in words[start:end])
            for entry in _entries(tuple(phrase), lexicon, camera):
                for value in _values(entry, lexicon):
                    yield _edge(entry.kind, start, end, Lex(value, entry.plural, text))


def _entries(phrase: Phrase, lexicon: Lexicon, camera: Naming | None) -> Iterator[NameEntry]:
    """Yield what a phrase can be: in the lexicon, spelt out, and in english.toml.

    Args:
        camera: Action that takes pictures, if the robot has just one.
    """
    known = lexicon.entry(phrase)
    if known is not None:
        yield known
    else:
        full = lexicon.entry(tuple(_SPELT_OUT.get(word, word) for word in phrase))
        if full is not None and full.kind == "NOUN":
            yield replace(full, plural=full.plural or phrase[-1].endswith("s"))
    kind = "" if known is None else known.kind
    if known is None and len(phrase) == 1 and phrase[0] in lexicon.short_values:
        yield NameEntry(kind="ATTRVAL", value=(lexicon.short_values[phrase[0]],))
    for other in more_words().get(phrase, ()):
        if other.kind in _WITH_A_CAMERA:
            meant = _WITH_A_CAMERA[other.kind]
            if camera is not None and meant != kind:
                yield NameEntry(kind=meant, value=camera, plural=other.plural)
        elif other.kind != kind:
            yield other


@cache
def more_words() -> Mapping[Phrase, tuple[NameEntry, ...]]:
    """Return the nouns that are verbs as well, and the words of english.toml, by phrase."""
    found: dict[Phrase, list[NameEntry]] = defaultdict(list)
    for kind, phrases in vocabulary()["nouns"].items():
        for phrase in phrases:
            found[split(phrase)].append(NameEntry(kind=kind))
            found[split(plural_of(phrase))].append(NameEntry(kind=kind, plural=True))
    own = tomllib.loads((files("fieldhand.planning.grammar") / "english.toml").read_text(encoding="utf-8"))
    for kind, phrases in own["words"].items():
        for phrase in phrases:
            found[split(phrase)].append(NameEntry(kind=kind))
    for phrase in own["words"]["PICTURE"]:
        found[split(plural_of(phrase))].append(NameEntry(kind="PICTURE", plural=True))
    for phrase, value in own["derived"].items():
        found[split(phrase)].append(NameEntry(kind="SUPER", value=tuple(value)))
    for kind, phrases in own["verbs"].items():
        for phrase in phrases:
            for form in forms_of(phrase):
                found[split(form)].append(NameEntry(kind=kind))
    return {phrase: tuple(entries) for phrase, entries in found.items()}


def fillers_of(words: Sequence[Word], lexicon: Lexicon) -> frozenset[int]:
    """Return the numbers of the words that say nothing by themselves."""
    found: set[int] = set()
    for start in range(len(words)):
        for end in range(start + 1, min(start + 8, len(words) + 1)):
            phrase = tuple(word.norm for word in words[start:end])
            entry = lexicon.entry(phrase)
            kinds = {other.kind for other in more_words().get(phrase, ())} | ({entry.kind} if entry else set())
            if kinds & _SILENT:
                found.update(range(start, end))
    commas = {k for k, word in enumerate(words) if word.kind == "comma" and {k - 1, k + 1} & found}
    return frozenset(found | commas)


def _single(word: Word, at: int) -> Iterator[PhraseEdge]:
    if word.kind == "rank":
        yield _edge("ORD", at, at + 1, Lex(int(re.sub(r"\D", "", word.norm)), False, word.norm))
    elif word.kind == "number":
        yield _edge("NUM", at, at + 1, Lex(float(word.norm.replace(",", "")), False, word.norm))
    elif word.kind in _SIGNS:
        yield _edge(_SIGNS[word.kind], at, at + 1, Lex(word.text, False, word.text))


def _names(words: Sequence[Word], start: int, lexicon: Lexicon) -> Iterator[PhraseEdge]:
    """Names of trees, rows and blocks that begin at a word."""
    site = lexicon.site
    spelt = ""
    for end in range(start + 1, min(start + 5, len(words) + 1)):
        word = words[end - 1]
        if word.kind not in ("word", "number", "dash", "rank"):
            return
        spelt += "".join(split(word.text)) if word.kind != "dash" else ""
        tree = lexicon.trees.get(spelt) or (_missing_tree(word, lexicon) if end == start + 1 else None)
        for kind, name in (
            ("TREEID", tree),
            ("ROWNAME", lexicon.row_names.get(spelt)),
            ("BLOCKNAME", lexicon.block_names.get(spelt)),
        ):
            if name is not None:
                yield _edge(kind, start, end, Lex(name, False, spelt))
    for gate in site.gates:
        phrase = split(gate.place.id)
        if phrase and tuple(w.norm for w in words[start : start + len(phrase)]) == phrase:
            yield _edge("GATENAME", start, start + len(phrase), Lex(gate.place.id, False, gate.place.id))


def _missing_tree(word: Word, lexicon: Lexicon) -> str | None:
    """Return a word that has the form of this site's tree ids, such as "N9999"; the site then says that it has none."""
    found = CODE.fullmatch(word.text)
    if found is None or lexicon.entry((word.norm,)) is not None:
        return None
    return word.text if found[1].lower() in lexicon.codes else None


def _values(entry: NameEntry, lexicon: Lexicon) -> Iterator[Any]:
    """Yield the values of an entry; a word that hints at an attribute ("oldest") once for each that it can mean."""
    value = _hashable(entry.value)
    if entry.kind == "SUPER" and value[0]:
        yield from ((name, value[1]) for name in hinted_attributes(value[0], lexicon.site))
    elif entry.kind == "CMP" and value[1]:
        yield from ((value[0], name) for name in hinted_attributes(value[1], lexicon.site))
    else:
        yield value


def hinted_attributes(hint: str, site: Site) -> list[str]:
    """Return the attributes of a site whose names contain a word."""
    return [name for name in site.attributes if hint in name.lower().replace("-", "_").split("_")]


def _edge(category: str, start: int, end: int, meaning: Lex) -> PhraseEdge:
    return PhraseEdge(category, start, end, meaning, _WORD_COST, ((1 << end) - 1) ^ ((1 << start) - 1))


def _hashable(value: Any) -> Any:
    return tuple(_hashable(v) for v in value) if isinstance(value, list) else value
