"""Estimate the tokens of a text without the model's tokenizer."""

from __future__ import annotations

import re

_TOKEN = re.compile(r"[A-Za-z]{1,6}|[0-9]{1,3}|_|[^\W\d_a-zA-Z]|[^\w\s]{1,2}|\n")


def tokens(text: str) -> int:
    """Return a high estimate: one token per six letters, three digits, two other signs, or line break.

    Tokenizers cannot be downloaded offline; in common ones a word of English prose is one token. Each letter of another
    alphabet counts as one token.
    """
    return sum(1 for _ in _TOKEN.finditer(text))
