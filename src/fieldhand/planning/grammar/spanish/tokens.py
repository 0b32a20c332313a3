"""Words of a Spanish request: without accents, contractions and pronouns joined to verbs split."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Mapping
from functools import cache

from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.spanish.inflection import commanding_forms
from fieldhand.planning.grammar.spanish.lexicon import tables

_TOKEN = re.compile(
    r"(?P<rank>\d+(?:\.?[\u00ba\u00aa](?!\s?[cf]\b)|\.?(?:er|ro|do|to|mo|vo|no|ra|da|ta|ma|va|na|era)\b))"
    # Thousands, decimals, or two numbers?
    r"|(?P<other>\d+[.,]\d{3}(?!\d)|\d+(?:[.,]\d+){2,}|\d{1,3}(?:[ \u00a0\u202f]\d{3})+(?!\d))"
    r"|(?P<number>\d+(?:[.,]\d+)?)"
    r"|(?P<word>[^\W\d_][\w\u0300-\u036f\u2080-\u2089]*)"
    r"|(?P<unit>%|[\u00b0\u00ba]\s?[cf]\b|[\u00b0\u00ba])"
    r"|(?P<stop>[.;!?\n]+)"
    r"|(?P<comma>[,:()]|\s[-\u2013\u2014]+\s)"
    r"|(?P<dash>[-\u2013])"
    r"|(?P<sign>[&+])"
    r"|(?P<hash>#)"
    r"|(?P<space>[\s\"'\u00a1\u00bf\u00ab\u00bb\u201c\u201d\u2018\u2019*_`]+)"
    r"|(?P<unknown>.)",
    re.DOTALL | re.IGNORECASE,
)
#: Words that would be an article without their accent.
_KEPT = frozenset({"\u00e9l"})
#: Number of letters of the first part, and the parts as the lexicon has them.
_Parts = tuple[int, tuple[str, ...]]
#: Words that consist of a preposition and an article.
_CONTRACTIONS: Mapping[str, _Parts] = {"del": (2, ("de", "el")), "al": (1, ("a", "el"))}
#: Pronouns that are joined to the end of a verb. The lexicon has them with a hyphen, apart from articles.
_PRONOUNS = ("lo", "la", "los", "las", "le", "les", "me", "nos", "te", "se")


def words_of(request: str) -> list[Word]:
    """Return the words of a request, in order. Nothing is left out but white space, quotation marks and "¿¡"."""
    found: list[Word] = []
    for match in _TOKEN.finditer(request):
        kind = match.lastgroup or "other"
        if kind != "space":
            norm = folded(match.group())
            kind = "other" if kind == "unknown" else kind
            norm = norm.replace(",", ".") if kind == "number" else norm
            found += _split(Word(kind=kind, text=match.group(), norm=norm, start=match.start(), end=match.end()))
    return found


def folded(text: str) -> str:
    """Return a word in lower case, without accents and compatibility forms, except "él"."""
    plain = unicodedata.normalize("NFKC", text.replace("\u00ba", "\u00b0").strip()).lower()
    if unicodedata.normalize("NFC", plain) in _KEPT:
        return unicodedata.normalize("NFC", plain)
    return "".join(c for c in unicodedata.normalize("NFD", plain) if not unicodedata.combining(c))


def _split(word: Word) -> Iterator[Word]:
    """Yield a word, or the words of which it consists; the last ones are without the letters that they share."""
    parts = _CONTRACTIONS.get(word.norm) or _verbs_with_pronouns().get(word.norm)
    if word.kind != "word" or parts is None or len(word.text) != len(word.norm):
        yield word
        return
    first, norms = parts
    ends = [first]
    for norm in norms[1:-1]:
        ends.append(ends[-1] + len(norm.removeprefix("-")))
    bounds = [0, *ends, len(word.text)]
    for norm, start, end in zip(norms, bounds, bounds[1:], strict=False):
        yield Word(kind="word", text=word.text[start:end], norm=norm, start=word.start + start, end=word.start + end)


@cache
def _verbs_with_pronouns() -> Mapping[str, _Parts]:
    """Return verbs with one or two pronouns joined to them: "midelo" as "mide" and "-lo"."""
    found: dict[str, _Parts] = {}
    lexicon = tables()
    verbs = {phrase.split()[0] for phrases in lexicon["verbs"].values() for phrase in phrases}
    verbs |= {verb for verbs in lexicon["robots"]["verbs"].values() for verb in verbs}
    for infinitive in sorted(folded(verb) for verb in verbs):
        for form in commanding_forms(infinitive, lexicon["irregular"]):
            for last in _PRONOUNS:
                found.setdefault(form + last, (len(form), (form, f"-{last}")))
                for first in ("me", "nos", "se", "te"):
                    found.setdefault(form + first + last, (len(form), (form, f"-{first}", f"-{last}")))
    return found
