"""Errors that stop the reading of clauses: they do not fit together, or leave open what is meant."""

from __future__ import annotations

from collections.abc import Hashable


class NotComposed(Exception):
    """The clauses cannot be put together.

    Attributes:
        what: What does not fit, or is left open, as part of a sentence about the clause.
        used: Tokens of the clause; 0 for the request as a whole.
        advice: What to say instead; empty if other words may help.
    """

    def __init__(self, what: str, used: int = 0, advice: str = "") -> None:
        self.what, self.used, self.advice = what, used, advice
        super().__init__(what)

    def about(self, used: int) -> NotComposed:
        """Return the fault as that of a clause, unless it is known to be another one's."""
        return self if self.used else type(self)(self.what, used, self.advice)


class OpenQuestion(NotComposed):
    """The clauses leave out what only the person can say, and there are no readings to choose from.

    Attributes:
        what: The question, as a sentence.
    """


class Fork(Exception):
    """The clauses can be continued in several ways, none of which has been chosen.

    Attributes:
        key: What has to be chosen.
        count: Number of ways.
    """

    def __init__(self, key: Hashable, count: int) -> None:
        self.key, self.count = key, count
        super().__init__(key)
