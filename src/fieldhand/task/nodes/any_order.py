"""Steps in whatever order drives least."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.task.nodes.base import Meaning, PlanNode, SayPlace, Span
from fieldhand.task.requests import Arrange

if TYPE_CHECKING:
    from fieldhand.task.plan import Node
    from fieldhand.task.run import Run


@dataclass(frozen=True, kw_only=True)
class AnyOrder(PlanNode):
    """Steps in whatever order drives least; each step starts with a place of its own.

    The order is decided once, when the node is reached. It fails as soon as a step does.
    """

    id: str
    steps: tuple[Node, ...]
    said: tuple[Span, ...] = ()

    def meaning(self, run: Run) -> Meaning:
        order: tuple[int, ...] = yield Arrange(node=self)
        for at, index in enumerate(order):
            run.frame.left = tuple(self.steps[k] for k in order[at + 1 :])
            yield from run.do(self.steps[index])

    def say(self, place: SayPlace) -> str:  # noqa: ARG002
        return "in the best order"

    @property
    def children(self) -> tuple[Node, ...]:
        return self.steps
