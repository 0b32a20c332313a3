"""The other language that a request seems to be in, so that the answer can say which languages are understood.

A short list of function words a language, and scripts that English is not written in. It looks only at words that the
lexicon does not know, and wants two of them, because "de" alone may be a name.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable

_FUNCTION_WORDS = {
    "Spanish": "el los las un una unos unas del al de la en y con por para cada todos todas toma tome haz mide si",
    "French": "le les une des du de la au aux et dans sur avec pour chaque tous toutes prends prenez mesure si l d",
    "German": "der das den dem des ein eine einen einem und von vom im auf mit bei an jeden jedem jeder alle nimm mach "
    "wenn zum zur",
    "Italian": "il lo gli un una del della dei delle di da nel nella e con per ogni tutti tutte fai scatta se",
    "Portuguese": "o os as um uma do da dos das em no na nos nas e com para cada todos todas tire faça se",
    "Dutch": "de het een van en op met bij elke alle neem maak als naar",
}
_LANGUAGES = {language: frozenset(words.split()) for language, words in _FUNCTION_WORDS.items()}
#: The first word of the Unicode name of a letter, and the languages that are written with it.
_SCRIPTS = {
    "CJK": "Chinese or Japanese",
    "HIRAGANA": "Japanese",
    "KATAKANA": "Japanese",
    "HANGUL": "Korean",
    "CYRILLIC": "Russian or another language in Cyrillic letters",
    "ARABIC": "Arabic or Persian",
    "HEBREW": "Hebrew",
    "DEVANAGARI": "Hindi or another language in Devanagari letters",
    "GREEK": "Greek",
    "THAI": "Thai",
}
#: So many function words of one language tell it.
_ENOUGH = 2


def language_of(unknown: Iterable[str]) -> str:
    """The language that words which are not English seem to be of; empty if that is not clear."""
    words = [part for text in unknown for part in re.split(r"[\W_]+", text.lower()) if part]
    for word in words:
        script = unicodedata.name(word[0], "").partition(" ")[0]
        if script in _SCRIPTS:
            kana = any(unicodedata.name(letter, "").startswith(("HIRAGANA", "KATAKANA")) for letter in word)
            return "Japanese" if kana else _SCRIPTS[script]
    hits = {language: len(known.intersection(words)) for language, known in _LANGUAGES.items()}
    best = max(hits, key=lambda language: hits[language])
    return best if hits[best] >= _ENOUGH else ""


def known_languages() -> tuple[str, ...]:
    """Return every language that :func:`language_of` may answer."""
    return tuple(dict.fromkeys((*_FUNCTION_WORDS, *_SCRIPTS.values())))
