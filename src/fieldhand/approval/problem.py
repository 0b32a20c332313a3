"""What a check finds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


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
        parts = [self.where] if self.node and self.node in self.where else [p for p in (self.node, self.where) if p]
        at = f"{', '.join(p for p in parts if p)}: " if any(parts) else ""
        todo = f"; {self.advice}" if self.advice else ""
        return " ".join(f"{at}{self.what}{todo}".split())
