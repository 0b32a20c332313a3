"""Steps in a fixed order."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.task.nodes.base import ChildNode, K, PlanNode, Program, Role, SayPlace, Span

if TYPE_CHECKING:
    from fieldhand.task.plan import Node
    from fieldhand.task.run import PlanRun


@dataclass(frozen=True, kw_only=True)
class InOrder(PlanNode):
    """Steps in their order; fails as soon as a step fails."""

    id: str = ""
    steps: tuple[Node, ...]
    said: tuple[Span, ...] = ()

    def execute(self, run: PlanRun) -> Program:
        for at, step in enumerate(self.steps):
            run.frame.left = self.steps[at + 1 :]
            yield from run.do(step)

    def say(self, place: SayPlace) -> str:  # noqa: ARG002
        return "in order"

    @property
    def role(self) -> Role:
        return "order"

    @property
    def parts(self) -> tuple[ChildNode, ...]:
        return tuple(ChildNode(node=step) for step in self.steps)

    @property
    def is_series(self) -> bool:
        return True

    def with_children(self, children: Sequence[Node]) -> InOrder:
        return replace(self, steps=tuple(children))

    def goes_on_after(self, child: Node) -> bool:
        return self.steps[-1] is not child

    @property
    def keeps_order(self) -> bool:
        return len(self.steps) > 1

    def flow(self, known: K, visit: Callable[[Node, K], K], test: Callable[[Node, K], None]) -> K:  # noqa: ARG002
        for step in self.steps:
            known = visit(step, known)
        return known
