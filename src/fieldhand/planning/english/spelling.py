"""Small misspellings of words that the lexicon knows: read as what was meant, and said."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from fieldhand.language import message
from fieldhand.planning.english.lexicon import Lexicon
from fieldhand.planning.english.tokens import Word

#: Words shorter than this are too like each other; a longer one may have one edit, from ``_LONG`` letters on two.
_SHORT, _LONG = 5, 9


def respelt(words: Sequence[Word], lexicon: Lexicon) -> tuple[list[Word], list[str]]:
    """The words with small misspellings mended, and what was mended as sentences.

    A word is mended where exactly one known word is nearest to it by inserting, dropping, changing or swapping letters.
    One that could be meant otherwise ("son" for "soon") is left: it will be asked about.
    """
    made: list[Word] = []
    notes: list[str] = []
    for word in words:
        meant = _meant(word, lexicon)
        if meant is None:
            made.append(word)
            continue
        made.append(replace(word, norm=meant, text=meant))
        notes.append(message("'{said}' is read as '{meant}'.", context="assumption", said=word.text, meant=meant))
    return made, notes


def _meant(word: Word, lexicon: Lexicon) -> str | None:
    from rapidfuzz import process
    from rapidfuzz.distance import OSA

    known = lexicon.vocabulary
    if word.kind != "word" or len(word.norm) < _SHORT or word.norm in known or not word.norm.isalpha():
        return None
    edits = 1 if len(word.norm) < _LONG else 2
    found = process.extract(word.norm, lexicon.spellings, scorer=OSA.distance, score_cutoff=edits, limit=4)
    near = [(int(away), str(spelt)) for spelt, away, _ in found if spelt[0] == word.norm[0]]
    if len(word.norm) == _SHORT:  # so short a word lacks a letter inside, or is not a misspelling
        near = [(away, spelt) for away, spelt in near if len(spelt) > _SHORT and spelt[-1] == word.norm[-1]]
    closest = sorted({spelt for away, spelt in near if away == min(near)[0]}, key=len)
    # "Pictrue" may be "picture" or, as far as letters go, "pictures".
    sure = len(closest) == 1 or (len(closest) == 2 and closest[0] + "s" == closest[1])
    return closest[0] if sure else None
