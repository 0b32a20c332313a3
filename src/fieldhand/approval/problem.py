"""What a check finds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from fieldhand.language import joined, shaped


@dataclass(frozen=True, kw_only=True)
class Problem:
    """One thing that is wrong with a Task, or that its approver has to know.

    Attributes:
        what: In words, without a full stop.
        node: Id of the plan node; empty where none is meant.
        where: Line and element, zone or site.
        advice: What to do about it.
        severity: An ``error`` forbids approval; a ``warning`` does until it is confirmed.
    """

    what: str
    node: str = ""
    where: str = ""
    advice: str = ""
    severity: Literal["error", "warning"] = "error"

    def __str__(self) -> str:
        """One line: where, what, advice."""
        return str(self.line())

    def line(self) -> str:
        """The same as a message, for other languages."""
        parts = [self.where] if self.node and self.node in self.where else [p for p in (self.node, self.where) if p]
        at = (joined(", ", parts), ": ") if parts else ()
        todo = ("; ", self.advice) if self.advice else ()
        return shaped(joined("", (*at, self.what, *todo)), _one_line)


def _one_line(text: str) -> str:
    return " ".join(text.split())
