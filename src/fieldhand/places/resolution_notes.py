"""Notes on how one part of a selector was resolved: the rule, the candidates, and close alternatives."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(kw_only=True)
class ResolutionNotes:
    """Notes taken while one part of a selector is resolved.

    Attributes:
        rule: Rule that was applied, as a short clause; empty where the wording of the part is clear by itself.
        candidates: Number of places it chose from; None for a source.
        runners_up: Places that would have come next.
        remarks: Surprises to point out, one clause each: ties, ends of rows, stand-ins.
    """

    rule: str = ""
    candidates: int | None = None
    runners_up: tuple[str, ...] = ()
    remarks: list[str] = field(default_factory=list)

    def remark(self, text: str) -> None:
        """Add a remark on something that a person may not expect."""
        self.remarks.append(text)
