"""A step that is done as a whole or not at all, if the budget allows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.task.instructions import OfferStep
from fieldhand.task.nodes.base import ChildNode, GivenUp, K, PlanNode, Program, Role, SayPlace, Span

if TYPE_CHECKING:
    from fieldhand.task.plan import Node
    from fieldhand.task.run import PlanRun


@dataclass(frozen=True, kw_only=True)
class OptionalStep(PlanNode):
    """``body`` as a whole, if the budget allows. Names bound inside are unknown outside.

    The budget guard decides once, when the step is reached. Skipping or abandoning it is no failure.

    Attributes:
        reward: Worth of the step.
    """

    id: str = ""
    body: Node
    reward: float = 1.0
    said: tuple[Span, ...] = ()

    def execute(self, run: PlanRun) -> Program:
        if not (yield OfferStep(node=self)):
            return
        try:
            yield from run.do(self.body)
        except GivenUp as given_up:
            if given_up.node != self.id:
                raise

    def say(self, place: SayPlace) -> str:  # noqa: ARG002
        return "if the budget allows"

    @property
    def role(self) -> Role:
        return "limit"

    @property
    def parts(self) -> tuple[ChildNode, ...]:
        return (ChildNode(node=self.body, certain=False),)

    def with_children(self, children: Sequence[Node]) -> OptionalStep:
        (body,) = children
        return replace(self, body=body)

    def flow(self, known: K, visit: Callable[[Node, K], K], test: Callable[[Node, K], None]) -> K:  # noqa: ARG002
        return known | visit(self.body, known)

    @property
    def is_optional(self) -> bool:
        return True

    @property
    def is_optional_step(self) -> bool:
        return True
