"""Words of a request as edges of the chart: phrases of a language, numbers, and names of this site."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

from fieldhand.planning.english.lexicon import CODE, Lexicon, spelt
from fieldhand.planning.english.naming import NameEntry, Phrase, split
from fieldhand.planning.english.numbers import spelt_numbers
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.chart import PhraseEdge
from fieldhand.site.model import Site

#: Price of a word by itself; a phrase of several words costs no more, so that longer phrases are preferred.
_WORD_COST = 1.0
#: Price of a number that is read in parts ("one twenty"), which may be two numbers as well ("in row one twenty trees").
_IN_PARTS_COST = 2.5
#: Price of the name of a block that a zone has as well.
_ALSO_A_ZONE_COST = 1.6
#: Comparisons that are written as signs.
_COMPARISONS = {
    ">": "gt",
    "<": "lt",
    ">=": "ge",
    "<=": "le",
    "\N{GREATER-THAN OR EQUAL TO}": "ge",
    "\N{LESS-THAN OR EQUAL TO}": "le",
}
#: Categories of markers by their kind.
_MARKERS = {"start": "START", "end": "FINISH", "charger": "CHARGER"}
_SIGNS = {"comma": "COMMA", "dash": "DASH", "sign": "AND", "hash": "HASH", "stop": "FULLSTOP"}
#: Category of words that always may be skipped.
_SILENT = "FILLER"
#: Category of adjectives that do not say from which value on.
_VAGUE = "VAGUEADJ"
#: Category of what stands before a verb behind a wish ("I want you to").
_INFINITIVE = "INORDERTO"
#: Category of words that hint at an attribute which the site does not record ("taller than").
LACKING = "LACKING"
#: How often something is done, as a sign: "x2".
_TIMES = re.compile("x([2-9]|[1-9][0-9])")
#: Ending of an English name that owns what follows.
_POSSESSIVE = re.compile("(?<=.)['\N{RIGHT SINGLE QUOTATION MARK}]s$")
#: Categories of the words of tellings.
_TOLD = frozenset(
    {
        "ADDS", "AUXILIARY", "BECAUSE", "DEMANDS", "HARMLESS", "HEADING", "HOPES", "IMPERSONAL", "INDEFINITE", "LATELY",
        "OWNER", "PAPERWORK", "PEOPLE", "POINTING", "REFERRING", "SAYS", "SOMEOFTHEM", "STATES",
    }
)  # fmt: skip
#: Maximum number of words of a filler.
_LONGEST_FILLER = 7

Key = TypeVar("Key")


@dataclass(frozen=True, slots=True)
class Lex:
    """A word or fixed phrase.

    Attributes:
        value: Its value in the lexicon.
        plural: True for a noun in the plural.
        text: Its words.
        features: What it is besides its category, such as ``indefinite``; constructions ask for these, never for words.
    """

    value: Any
    plural: bool
    text: str
    features: frozenset[str] = frozenset()


class Phrases(Protocol):
    """The words of a language together with those of a robot and of a site."""

    @property
    def lexicon(self) -> Lexicon:
        """The names of the site's trees, rows and blocks."""

    @property
    def longest(self) -> int:
        """The number of words of the longest phrase."""

    def entries(self, phrase: Phrase) -> Iterable[NameEntry]:
        """Return everything that a phrase can be."""

    def features(self, phrase: Phrase) -> frozenset[str]:
        """Return the features of a phrase."""

    def spotted(self, words: Sequence[Word]) -> Iterable[tuple[str, int, int, Any]]:
        """Return phrases that no lexicon lists: category, range of the words, and value."""


@dataclass(frozen=True, kw_only=True)
class FeatureTable:
    """The features of a language's words.

    Attributes:
        of_phrases: Features by whole phrase.
        of_words: Features that a word gives to each phrase which contains it.
    """

    of_phrases: Mapping[Phrase, frozenset[str]]
    of_words: Mapping[str, frozenset[str]]

    @classmethod
    def read(cls, table: Mapping[str, Any], split: Callable[[str], Phrase]) -> FeatureTable:
        """Return the features of the tables ``features`` and ``features_of_words`` of a lexicon.

        Args:
            table: Tables of the lexicon.
            split: Returns a phrase as words.
        """
        return cls(
            of_phrases=_by_word(table["features"], split),
            of_words=_by_word(table["features_of_words"], str),
        )

    def of(self, phrase: Phrase) -> frozenset[str]:
        """Return the features of a phrase."""
        found = self.of_phrases.get(phrase, frozenset())
        return found.union(*(self.of_words[word] for word in phrase if word in self.of_words))


def _by_word(table: Mapping[str, Sequence[str]], key: Callable[[str], Key]) -> Mapping[Key, frozenset[str]]:
    """Return the names of a table's lists by their items."""
    found: dict[Key, set[str]] = {}
    for feature, phrases in table.items():
        for phrase in phrases:
            found.setdefault(key(phrase), set()).add(feature)
    return {word: frozenset(features) for word, features in found.items()}


def edges_of(words: Sequence[Word], phrases: Phrases, *, tells: bool = False) -> Iterator[PhraseEdge]:
    """Yield an edge for each phrase of the language and each name of the site that the words contain.

    Args:
        words: Words of a request.
        phrases: Words of the language, the robot and the site.
        tells: True to yield the words of tellings, too, of which no request can consist.
    """
    for start, word in enumerate(words):
        yield from _single(word, start, phrases)
        yield from _spelt_out(words, start)
        yield from _names(words, start, phrases)
        phrase: list[str] = []
        for end in range(start + 1, min(start + 1 + phrases.longest, len(words) + 1)):
            last = words[end - 1]
            if last.kind == "dash" and end - 1 > start:
                continue
            if last.kind not in ("word", "unit", "number", "rank"):
                break
            phrase.append(last.norm)
            yield from _possessive(phrase, start, end, phrases)
            yield from _phrase(words, start, end, tuple(phrase), phrases, tells=tells)
        yield from _interrupted(words, start, phrases, tells=tells)
    for category, first, end, value in phrases.spotted(words):
        text = " ".join(word.norm for word in words[first:end])
        yield _edge(category, first, end, Lex(value, False, text))


def _phrase(
    words: Sequence[Word], start: int, end: int, phrase: Phrase, phrases: Phrases, *, tells: bool
) -> Iterator[PhraseEdge]:
    """Yield what a phrase can be that stands at some words."""
    text = " ".join(word.norm for word in words[start:end])
    for entry in phrases.entries(phrase):
        if entry.kind in _TOLD and not tells:
            continue
        if entry.kind == _SILENT and _forbids_ground(words, start, end, phrases):
            continue
        features = phrases.features(phrase)
        kind = "CONTRAST" if entry.kind == "AND" and "contrast" in features else entry.kind
        values = list(_values(entry, phrases.lexicon))
        for value in values:
            yield _edge(kind, start, end, Lex(value, entry.plural, text, features), entry.cost)
        if not values:
            yield _edge(LACKING, start, end, Lex(_hint(entry), entry.plural, text, features))


def _interrupted(words: Sequence[Word], start: int, phrases: Phrases, *, tells: bool) -> Iterator[PhraseEdge]:
    """Yield what the words around an adverb that adds nothing are together ("I'd also like")."""
    at = start + 1
    if at + 1 >= len(words) or words[start].kind != "word" or "interrupts" not in phrases.features((words[at].norm,)):
        return
    phrase = [words[start].norm]
    for end in range(at + 2, min(at + 1 + phrases.longest, len(words)) + 1):
        if words[end - 1].kind != "word":
            return
        phrase.append(words[end - 1].norm)
        yield from _phrase(words, start, end, tuple(phrase), phrases, tells=tells)


def _possessive(phrase: Sequence[str], start: int, end: int, phrases: Phrases) -> Iterator[PhraseEdge]:
    """Yield what a phrase is the possessive of: "orchard's"."""
    *before, last = phrase
    base = last.removesuffix("'s")
    if base == last:
        return
    for entry in phrases.entries((*before, base)):
        for value in _values(entry, phrases.lexicon):
            yield _edge(f"{entry.kind}POSS", start, end, Lex(value, False, base))


def fillers_of(words: Sequence[Word], phrases: Phrases) -> frozenset[int]:
    """Return the numbers of the words that say nothing by themselves."""
    found: set[int] = set()
    for start in range(len(words)):
        for end in range(start + 1, min(start + 1 + _LONGEST_FILLER, len(words) + 1)):
            phrase = tuple(word.norm for word in words[start:end])
            kinds = {entry.kind for entry in phrases.entries(phrase)}
            if _VAGUE in kinds and _is_kind(words[end : end + 1], "TREE", phrases):
                continue  # "good vines"
            if _SILENT in kinds and not _forbids_ground(words, start, end, phrases):
                found.update(range(start, end))
                if "wishes" in phrases.features(phrase) and _is_kind(words[end : end + 1], _INFINITIVE, phrases):
                    found.add(end)  # "I want you to ..."
    commas = {k for k, word in enumerate(words) if word.kind == "comma" and {k - 1, k + 1} & found}
    return frozenset(found | commas)


def _forbids_ground(words: Sequence[Word], start: int, end: int, phrases: Phrases) -> bool:
    """Return True for words that begin a phrase which forbids ground: the "keep" of "keep off" says something."""
    return any(_is_kind(words[start : end + more], "KEEPOUT", phrases) for more in (1, 2, 3))


def _is_kind(words: Sequence[Word], kind: str, phrases: Phrases) -> bool:
    """Return True if words can be a phrase of a category."""
    return any(entry.kind == kind for entry in phrases.entries(tuple(word.norm for word in words)))


def _single(word: Word, at: int, phrases: Phrases) -> Iterator[PhraseEdge]:
    if word.kind == "rank":
        yield _edge("ORD", at, at + 1, Lex(int(re.sub(r"\D", "", word.norm)), False, word.norm))
    elif (times := _TIMES.fullmatch(word.norm)) is not None:
        yield _edge("COUNT", at, at + 1, Lex(int(times[1]), False, word.norm))
    elif word.kind == "number":
        yield _edge("NUM", at, at + 1, Lex(float(word.norm.replace(",", "")), False, word.norm))
    elif word.text in _COMPARISONS:
        yield _edge("CMP", at, at + 1, Lex((_COMPARISONS[word.text], ""), False, word.text))
    elif word.kind in _SIGNS:
        features = phrases.features((word.text.strip(),))
        yield _edge(_SIGNS[word.kind], at, at + 1, Lex(word.text, False, word.text, features))


def _spelt_out(words: Sequence[Word], start: int) -> Iterator[PhraseEdge]:
    """Yield the numbers and ranks that several words spell out from a word on, and thousands ("1.5k")."""
    word, following = words[start], words[start + 1 : start + 2]
    if word.kind == "number" and [one.text for one in following] == ["k"] and following[0].start == word.end:
        yield _edge("NUM", start, start + 2, Lex(1000 * float(word.norm.replace(",", "")), False, f"{word.norm}k"))
    for number in spelt_numbers(words, start):
        text = " ".join(word.norm for word in words[start : number.end])
        value = number.value if number.is_rank else float(number.value)
        cost = _IN_PARTS_COST if number.in_parts else _WORD_COST
        yield _edge("ORD" if number.is_rank else "NUM", start, number.end, Lex(value, False, text), cost)


def _names(words: Sequence[Word], start: int, phrases: Phrases) -> Iterator[PhraseEdge]:
    """Names of trees, rows and blocks that begin at a word."""
    lexicon = phrases.lexicon
    together: list[str] = []
    if words[start].kind == "dash":
        return
    for end in range(start + 1, min(start + 5, len(words) + 1)):
        word = words[end - 1]
        if word.kind not in ("word", "number", "dash", "rank"):
            break
        if word.kind == "dash":
            continue  # a dash is part of a name between its words only: "N100-N120" holds two names
        possessive = _POSSESSIVE.search(word.text)
        together += split(word.text[: possessive.start()] if possessive else word.text)
        written = "".join(together)
        tree = lexicon.trees.get(spelt(together)) or (_missing_tree(word, phrases) if end == start + 1 else None)
        for kind, name in (
            ("TREEID", tree),
            ("ROWNAME", lexicon.row_names.get(written)),
            ("BLOCKNAME", lexicon.block_names.get(written)),
        ):
            if name is not None and not (end == start + 1 and _is_article(word, name, phrases)):
                cost = _ALSO_A_ZONE_COST if kind == "BLOCKNAME" and lexicon.is_zone(name) else _WORD_COST
                yield _edge(f"{kind}POSS" if possessive else kind, start, end, Lex(name, False, written), cost)
        if possessive:
            break
    for kind, name in lexicon.site.marker_names:
        phrase = split(name)
        if phrase and tuple(w.norm for w in words[start : start + len(phrase)]) == phrase:
            yield _edge(_MARKERS[kind], start, start + len(phrase), Lex(None, False, name))
    for gate in lexicon.site.gates:
        phrase = split(gate.place.id)
        if phrase and tuple(w.norm for w in words[start : start + len(phrase)]) == phrase:
            yield _edge("GATENAME", start, start + len(phrase), Lex(gate.place.id, False, gate.place.id))


def _is_article(word: Word, name: str, phrases: Phrases) -> bool:
    """Return True for an article that could be a name if it were written like one ("a block" where block A is)."""
    return word.text != name and any(entry.kind == "DET" for entry in phrases.entries((word.norm,)))


def _missing_tree(word: Word, phrases: Phrases) -> str | None:
    """Return a word that has the form of this site's tree ids, such as "N9999"; the site then says that it has none."""
    found = CODE.fullmatch(word.text)
    if found is None or any(True for _ in phrases.entries((word.norm,))):
        return None
    return word.text if found[1].lower() in phrases.lexicon.codes else None


def _values(entry: NameEntry, lexicon: Lexicon) -> Iterator[Any]:
    """Yield the values of an entry; a word that hints at an attribute ("oldest") once for each that it can mean."""
    value = _hashable(entry.value)
    if entry.kind == "SUPER" and value[0]:
        yield from ((name, value[1]) for name in hinted_attributes(value[0], lexicon.site))
    elif entry.kind in ("CMP", "BOUND") and value[1]:
        yield from ((value[0], name) for name in hinted_attributes(value[1], lexicon.site))
    else:
        yield value


def _hint(entry: NameEntry) -> str:
    """Return the attribute at which a word hints."""
    value = _hashable(entry.value)
    return str(value[0] if entry.kind == "SUPER" else value[1])


def hinted_attributes(hint: str, site: Site) -> list[str]:
    """Return the attributes of a site whose names contain a word."""
    return [name for name in site.attributes if hint in name.lower().replace("-", "_").split("_")]


def _edge(category: str, start: int, end: int, meaning: Lex, cost: float = _WORD_COST) -> PhraseEdge:
    return PhraseEdge(category, start, end, meaning, cost, ((1 << end) - 1) ^ ((1 << start) - 1))


def topic_edge(words: Sequence[Word], at: int) -> PhraseEdge:
    """Return an edge that reads a word as "this is about"."""
    return _edge("TOPIC", at, at + 1, Lex(None, False, words[at].norm))


def _hashable(value: Any) -> Any:
    return tuple(_hashable(v) for v in value) if isinstance(value, list) else value
