"""Verbs of watching over something, which say that it is measured again and again: "keep an eye on the CO2"."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.planning.english.tokens import Word

#: Maximum number of words of such a verb.
_LONGEST = 4


def watched_over(words: Sequence[Word]) -> str:
    """Return the verb of watching over something that words contain, as typed; empty without one."""
    from fieldhand.planning.grammar.english import features_of

    for start in range(len(words)):
        for end in range(min(start + _LONGEST, len(words)), start, -1):
            if "watches_over" in features_of(tuple(word.norm for word in words[start:end])):
                return " ".join(word.text for word in words[start:end])
    return ""
