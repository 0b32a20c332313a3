"""The fault of clauses that do not fit together."""

from __future__ import annotations


class NotComposed(Exception):
    """The clauses cannot be put together."""
