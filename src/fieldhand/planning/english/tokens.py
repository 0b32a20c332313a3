"""Words of a request with where they stand."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from fieldhand.planning.english.vocabulary import vocabulary

_TOKEN = re.compile(
    r"(?P<rank>\d+(?:st|nd|rd|th)\b)"
    r"|(?P<number>\d{1,3}(?:,\d{3})+(?![\d])|\d+(?:\.\d+)?|(?<![\w.])\.\d+)"
    r"|(?P<word>(?<=\d)['\u2019]s\b|(?:nos?|nr)\.(?=\s*[a-z]?\d)|i\.\s?e\.|viz\.|(?:mrs?|ms|dr|prof)\.(?=\s+(?-i:[A-Z]))|w/o?(?=[\s\d])|@(?=\s|\w)"
    r"|~(?=\s?\d)|\u00d7\d+|o['\u2019](?=\s)|(?:temps?|approx|deg|avg|mins?|hrs?|secs?|incl|excl)\.(?=\s+(?-i:[a-z0-9]))(?!\s+(?:take|go|drive|snap|then|if|photo|get|grab|move|after|when|once|otherwise|repeat|and\sthen)\w*\b)|(?:l|ml|g|kg|m|km|cm|ft)/(?:ha|h|s|min|m2|tree)\b|(?<=[a-z])/(?=(?:ha|hectare|acre)\b)|[^\W\d_][\w\u2080-\u2089]*(?:['\u2019][^\W\d_]+)?)"
    r"|(?P<unit>%|°\s?[cCfF]\b|°)"
    r"|(?P<stop>[.;!?\n]+)"
    r"|(?P<comma>[,:()]|(?<!\d)\s[-\u2013\u2014]+\s|\s[-\u2013\u2014]+\s(?![a-z]?\d)|[-=]>|\u2192)"
    r"|(?P<dash>[-\u2013])"
    r"|(?P<sign>[&+])"
    r"|(?P<hash>#)"
    r"|(?P<space>[\s\"'\u201c\u201d\u2018\u2019*_`]+)"
    r"|(?P<other>[<>]=|.)",
    re.DOTALL | re.IGNORECASE,
)


#: Marks that are dictated as words; no noun is meant if an article or the like stands before it ("in that period").
_DICTATED = {
    "comma": ("comma", ","),
    "colon": ("comma", ":"),
    "semicolon": ("stop", ";"),
    "full stop": ("stop", "."),
    "period": ("stop", "."),
    "new line": ("stop", "."),
    "new paragraph": ("stop", "."),
    "question mark": ("stop", "?"),
    "exclamation mark": ("stop", "!"),
    "open bracket": ("comma", "("),
    "close bracket": ("comma", ")"),
}
_BEFORE_NOUNS = frozenset(["a", "an", "the", "this", "that", "per", "of", "in", "long", "short", "same", "whole"])
_MARK_KINDS = frozenset({"comma", "stop"})


@dataclass(frozen=True, kw_only=True)
class Word:
    """One word, number or sign of the request.

    Attributes:
        kind: ``word``, ``rank`` ("12th"), ``number``,
            ``unit``, ``stop``, ``comma``, ``dash``, ``sign``, ``hash`` or ``other``.
        norm: As the lexicon knows it: lower case, compatibility forms folded, straight apostrophes, "you" for "thou".
    """

    kind: str
    text: str
    norm: str
    start: int
    end: int

    @property
    def is_dictated(self) -> bool:
        """True for a mark that is spelt out ("full stop")."""
        return self.kind in _MARK_KINDS and self.end - self.start > len(self.text)


def words_of(request: str) -> list[Word]:
    """Return the words of a request, in order, without white space, quotation marks, and brackets before a mark."""
    found: list[Word] = []
    for match in _TOKEN.finditer(request):
        kind = match.lastgroup or "other"
        if kind == "space":
            continue
        norm = (
            unicodedata.normalize("NFKC", match.group()).lower().replace("\N{RIGHT SINGLE QUOTATION MARK}", "'").strip()
        )
        norm = norm.rstrip(".") if kind == "word" else norm  # "the air temp. at tree 4"
        norm = vocabulary()["same_words"].get(norm, norm).replace("\N{MULTIPLICATION SIGN}", "x")
        found.append(Word(kind=kind, text=match.group(), norm=norm, start=match.start(), end=match.end()))
    found = list(_with_dictated_marks(found))
    return [word for k, word in enumerate(found) if not _closes_sentence(word, found[k + 1 : k + 2])]


def _with_dictated_marks(words: Sequence[Word]) -> Iterator[Word]:
    """Yield words, with a mark in place of the words that spell it out."""
    k = 0
    while k < len(words):
        length = next((n for n in (2, 1) if " ".join(word.norm for word in words[k : k + n]) in _DICTATED), 0)
        if length == 0 or k == 0 or words[k - 1].norm in _BEFORE_NOUNS:
            yield words[k]
            k += 1
            continue
        spelt = words[k : k + length]
        kind, mark = _DICTATED[" ".join(word.norm for word in spelt)]
        yield Word(kind=kind, text=mark, norm=mark, start=spelt[0].start, end=spelt[-1].end)
        k += length


def _closes_sentence(word: Word, following: list[Word]) -> bool:
    """Return True for a closing bracket with a mark or nothing behind it: it parts nothing."""
    return word.text == ")" and all(one.kind in ("stop", "comma") for one in following)


def ranges_of(pattern: re.Pattern[str], words: Sequence[Word]) -> Iterator[tuple[int, int]]:
    """Yield the ranges of whole words that a pattern matches in them, written with one space between two words."""
    starts: dict[int, int] = {}
    ends: dict[int, int] = {}
    text = ""
    for k, word in enumerate(words):
        starts[len(text)] = k
        text += word.norm
        ends[len(text)] = k + 1
        text += " "
    for match in pattern.finditer(text.rstrip()):
        first, last = starts.get(match.start()), ends.get(match.end())
        if first is not None and last is not None:
            yield first, last
