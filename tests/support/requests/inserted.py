"""Requests with a word inserted that no plan can hold."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from support.examples import examples


def with_word(word: str, words: Sequence[str], requests: Sequence[str]) -> Iterator[str]:
    """Yield requests with a word inserted.

    Positions take turns, so that each position of each request gets one of ``words`` and each word is inserted at
    beginnings, in the middle and at ends. With the thorough profile each word is inserted at each position.
    """
    turns, turn = examples(len(words), thorough=1), words.index(word)
    for n, request in enumerate(requests):
        said = request.split()
        for k in range(len(said)):
            if (n + k) % turns == turn % turns:
                yield " ".join([*said[:k], word, *said[k:]])
