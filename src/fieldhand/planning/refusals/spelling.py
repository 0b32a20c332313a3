"""Known words that an unknown word may be a misspelling of."""

from __future__ import annotations

import re
from functools import cache
from importlib.resources import files

from fieldhand.compatibility import tomllib
from fieldhand.planning.english.lexicon import Lexicon
from fieldhand.planning.english.vocabulary import glue

#: A shorter word is too like others.
_SHORTEST = 4
#: Least similarity of a misspelling to the word that is meant, 1 for the same word.
_SIMILAR = 0.74


def likely_meant(word: str, lexicon: Lexicon) -> str:
    """Return the word that a misspelt one most likely means; empty if it is a word itself, or unlike any known one."""
    from rapidfuzz import process
    from rapidfuzz.distance import OSA

    spelt = word.lower()
    known = lexicon.vocabulary
    if "0" in spelt and spelt.replace("0", "o") in known:
        return spelt.replace("0", "o")  # "C02"
    if len(spelt) < _SHORTEST or not spelt.isalpha() or spelt in ordinary_words():
        return ""
    long = [one for one in known if len(one) >= _SHORTEST and one.isalpha()]
    found = process.extractOne(spelt, long, scorer=OSA.normalized_similarity, score_cutoff=_SIMILAR)
    return str(found[0]) if found is not None else ""


@cache
def ordinary_words() -> frozenset[str]:
    """Return English words that growers use and that are no misspellings, though requests cannot contain them."""
    data = (files("fieldhand.planning.english") / "wishes.toml").read_text(encoding="utf-8")
    table = tomllib.loads(data)
    patterns = [pattern for wish in table["wish"] for pattern in wish["said"]]
    return frozenset({*re.findall(r"[a-z]{3,}", " ".join(patterns)), *glue(), *table["ordinary"]["words"]})
