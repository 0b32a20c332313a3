"""Estimate the tokens of a text without the model's tokenizer."""

from __future__ import annotations

import re

_TOKEN = re.compile(r"[A-Za-z]{1,6}|[0-9]{1,3}|_|[^\W\d_a-zA-Z]|[^\w\s]{1,2}|\n")


def tokens(text: str) -> int:
    """Return the tokens of a text on the high side: six letters, three digits or two signs to one, line ends one each.

    Tokenizers of models are not at hand without a network; of common ones a word of English prose is one token. A
    letter of another alphabet counts as one.
    """
    return sum(1 for _ in _TOKEN.finditer(text))
