"""Something, and if that fails something else."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.task.nodes.base import Failed, Meaning, PlanNode, SayPlace, Span

if TYPE_CHECKING:
    from fieldhand.task.plan import Node
    from fieldhand.task.run import Run


@dataclass(frozen=True, kw_only=True)
class Try(PlanNode):
    """``body``, and if that fails ``otherwise``, from wherever the failure left the robot."""

    id: str
    body: Node
    otherwise: Node
    said: tuple[Span, ...] = ()

    def meaning(self, run: Run) -> Meaning:
        frame = run.frame
        frame.catches = True
        try:
            yield from run.do(self.body)
        except Failed:
            frame.catches = False
        else:
            return
        yield from run.do(self.otherwise)

    def say(self, place: SayPlace) -> str:  # noqa: ARG002
        return "try"

    @property
    def children(self) -> tuple[Node, ...]:
        return (self.body, self.otherwise)
