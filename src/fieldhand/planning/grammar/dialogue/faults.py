"""What stops the reading of clauses: they do not fit together, or leave open what is meant."""

from __future__ import annotations

from collections.abc import Hashable


class NotComposed(Exception):
    """The clauses cannot be put together."""


class OpenQuestion(NotComposed):
    """The clauses leave out what only the person can say, and there are no readings to choose from.

    Attributes:
        question: The question, as a sentence.
    """

    def __init__(self, question: str) -> None:
        self.question = question
        super().__init__(question)


class Fork(Exception):
    """The clauses can be continued in several ways, none of which has been chosen.

    Attributes:
        key: What has to be chosen.
        count: Number of ways.
    """

    def __init__(self, key: Hashable, count: int) -> None:
        self.key, self.count = key, count
        super().__init__(key)
