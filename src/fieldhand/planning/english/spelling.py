"""Small misspellings of words that the lexicon knows: read as what was meant, and said."""

from __future__ import annotations

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace

from fieldhand.language import message
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.english.vocabulary import vocabulary

#: Words shorter than this are too like each other; from ``_MEDIUM`` letters on a word may have one edit, from ``_LONG``
#: letters on two. A shorter one lacks a letter or has two letters swapped, or is not a misspelling.
_SHORT, _MEDIUM, _LONG = 4, 6, 9


def respelt(words: Sequence[Word], known: AbstractSet[str]) -> tuple[list[Word], list[str]]:
    """Return words with small misspellings mended, and what was mended as sentences.

    A word is mended if it is a common short form ("blk"), or exactly one known word is nearest to it by inserting,
    dropping, changing or swapping letters. One that could be meant otherwise ("son" for "soon") is left as it is.

    Args:
        words: Words that are not known.
        known: Known words.
    """
    made: list[Word] = []
    notes: list[str] = []
    spellings = [word for word in known if len(word) >= _SHORT and word.isalpha()]
    for word in words:
        meant = _meant(word, known, spellings)
        if meant is None:
            made.append(word)
            continue
        made.append(replace(word, norm=meant, text=meant))
        notes.append(message("'{said}' is read as '{meant}'.", context="assumption", said=word.text, meant=meant))
    return made, notes


def _meant(word: Word, known: AbstractSet[str], spellings: Sequence[str]) -> str | None:
    from rapidfuzz import process
    from rapidfuzz.distance import OSA

    if short := vocabulary()["short_forms"].get(word.norm):
        return str(short)
    length = len(word.norm)
    if word.kind != "word" or length < _SHORT or word.norm in known or not word.norm.isalpha():
        return None
    edits = 1 if length < _LONG else 2
    found = process.extract(word.norm, spellings, scorer=OSA.distance, score_cutoff=edits, limit=None)
    near = [(int(away), str(spelt)) for spelt, away, _ in found if spelt[0] == word.norm[0]]
    if length < _MEDIUM:
        near = [(away, spelt) for away, spelt in near if _is_slip(word.norm, spelt)]
    else:
        near = [(away, spelt) for away, spelt in near if len(spelt) >= _MEDIUM]
    closest = sorted({spelt for away, spelt in near if away == min(near)[0]}, key=len)
    # "Pictrue" may be "picture" or, as far as letters go, "pictures".
    sure = len(closest) == 1 or (len(closest) == 2 and closest[0] + "s" == closest[1])
    return closest[0] if sure else None


def _is_slip(typed: str, spelt: str) -> bool:
    """Return True if a short word lacks a letter of another one, or has two of its letters swapped.

    In words of four letters the letter that lacks is inside ("evry"): so many words become another one at the end.
    """
    if len(spelt) == len(typed):
        return sorted(spelt) == sorted(typed)
    ends = spelt[-1] == typed[-1] or (len(typed) > _SHORT and spelt.startswith(typed))
    return len(spelt) > len(typed) and ends
