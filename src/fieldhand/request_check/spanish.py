"""Spanish words of requests with English ones in their place, so that one set of rules checks both languages.

A word that spanish.toml lacks stays Spanish and is unknown to the check, which then reports less.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any

from fieldhand.compatibility import tomllib

_DECIMAL_COMMA = re.compile(r"(?<=\d),(?=\d{1,2}(?!\d))")
#: Endings of verbs, and pronouns joined to them.
_ENDINGS = (
    r"(?:a|e|o|ar|er|ir|an|en|as|es|amos|ando|iendo|yendo|ad[oa]s?|id[oa]s?)?"
    r"(?:(?:me|nos|se|te)?(?:lo|la|le)s?|me|nos|se|te)?"
)


def with_decimal_points(request: str) -> str:
    """Return a Spanish request with decimal points instead of commas."""
    return _DECIMAL_COMMA.sub(".", request)


def english_words(words: Sequence[str]) -> Iterator[tuple[int, int, list[str]]]:
    """Yield ranges of the words of a Spanish request, with the English words that say the same.

    Args:
        words: Words and signs of the request in lower case.
    """
    plain = [folded(word) for word in words]
    known, longest, east = _phrases(), max(map(len, _phrases())), frozenset(_tables()["east"]["after"])
    k = 0
    while k < len(plain):
        length = next((n for n in range(longest, 0, -1) if tuple(plain[k : k + n]) in known), 1)
        english = known.get(tuple(plain[k : k + length]))
        if plain[k] == "este" and length == 1 and k and plain[k - 1] in east:
            english = "east"
        if plain[k] in ("del", "al") and "".join(plain[k + 1 : k + 2]).isdecimal():
            english = "to" if plain[k] == "al" else ""  # "árboles del 4 al 9"
        if english is None:
            verb = _verbs().fullmatch(plain[k])
            english = words[k] if verb is None or verb.lastgroup is None else verb.lastgroup
        yield k, k + length, english.split()
        k += length


def folded(word: str) -> str:
    """Return a word without accents."""
    return "".join(c for c in unicodedata.normalize("NFD", word) if not unicodedata.combining(c))


@cache
def _tables() -> Mapping[str, Any]:
    return tomllib.loads((files("fieldhand.request_check") / "spanish.toml").read_text(encoding="utf-8"))


@cache
def _verbs() -> re.Pattern[str]:
    """Return a pattern of verbs in all forms; the name of its group is the English verb."""
    verbs = _tables()["verbs"].items()
    return re.compile("|".join(f"(?P<{english}>(?:{'|'.join(stems)}){_ENDINGS})" for english, stems in verbs))


@cache
def _phrases() -> Mapping[tuple[str, ...], str]:
    """Return English words by Spanish phrases: those of the tables, and numbers in digits."""
    tables = _tables()
    found = {tuple(spanish.split()): english for english, phrases in tables["phrases"].items() for spanish in phrases}
    found |= {(word,): english for word, english in (*tables["sides"].items(), *tables["forms"].items())}
    found |= {phrase: str(number) for phrase, number in _numbers(tables["numbers"]) if phrase != ("uno",)}
    return found


def _numbers(words: Mapping[str, Any]) -> Iterator[tuple[tuple[str, ...], int]]:
    """Yield the numbers in words below 1000; "uno" alone is mostly a pronoun."""
    units, tens = words["units"], words["tens"]
    below: dict[tuple[str, ...], int] = {(word,): n for n, word in enumerate(units)}
    below |= {(word,): 10 * n for n, word in enumerate(tens, start=3)}
    below |= {(str(a), "y", str(b)): 10 * n + units.index(b) for n, a in enumerate(tens, start=3) for b in units[1:10]}
    yield from below.items()
    yield from (((word,), words[word]) for word in ("cien", "mil"))
    for n, many in enumerate(words["hundreds"], start=1):
        for hundred in dict.fromkeys((many, re.sub("os$", "as", many))):
            yield (hundred,), 100 * n
            yield from (((hundred, *rest), 100 * n + m) for rest, m in below.items() if m)
