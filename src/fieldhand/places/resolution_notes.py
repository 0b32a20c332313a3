"""What a part of a selector notes about how it was resolved: the rule, the candidates, and what was close."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(kw_only=True)
class ResolutionNotes:
    """Notes taken while one part resolves.

    Attributes:
        rule: The rule that was applied, a short clause; empty where the words of the part say it all.
        candidates: How many it chose from; None for a source.
        runners_up: Those that would have come next.
        notes: What a person may not expect, a clause each: ties, ends of rows, stand-ins.
    """

    rule: str = ""
    candidates: int | None = None
    runners_up: tuple[str, ...] = ()
    remarks: list[str] = field(default_factory=list)

    def remark(self, text: str) -> None:
        """Say something that a person may not expect."""
        self.remarks.append(text)
