"""Steps in their order."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.task.nodes.base import Meaning, PlanNode, SayPlace, Span

if TYPE_CHECKING:
    from fieldhand.task.plan import Node
    from fieldhand.task.run import Run


@dataclass(frozen=True, kw_only=True)
class Sequence(PlanNode):
    """Steps in their order; it fails as soon as one does."""

    id: str
    steps: tuple[Node, ...]
    said: tuple[Span, ...] = ()

    def meaning(self, run: Run) -> Meaning:
        for at, step in enumerate(self.steps):
            run.frame.left = self.steps[at + 1 :]
            yield from run.do(step)

    def say(self, place: SayPlace) -> str:  # noqa: ARG002
        return "in order"

    @property
    def children(self) -> tuple[Node, ...]:
        return self.steps
