"""A node with an alternative to execute if it fails."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.task.nodes.base import ChildNode, Failed, K, PlanNode, Program, Role, SayPlace, Span

if TYPE_CHECKING:
    from fieldhand.task.plan import Node
    from fieldhand.task.run import PlanRun


@dataclass(frozen=True, kw_only=True)
class Try(PlanNode):
    """``body``, and if it fails ``otherwise``, from where the failure left the robot.

    A failure of ``otherwise`` is not caught here.
    """

    id: str = ""
    body: Node
    otherwise: Node
    said: tuple[Span, ...] = ()

    def execute(self, run: PlanRun) -> Program:
        frame = run.frame
        frame.instead = (self.otherwise,)
        try:
            yield from run.do(self.body)
        except Failed:
            frame.instead = ()
        else:
            return
        yield from run.do(self.otherwise)

    def say(self, place: SayPlace) -> str:  # noqa: ARG002
        return "try"

    @property
    def role(self) -> Role:
        return "condition"

    @property
    def parts(self) -> tuple[ChildNode, ...]:
        return (ChildNode(node=self.body), ChildNode(node=self.otherwise, certain=False))

    def with_children(self, children: Sequence[Node]) -> Try:
        body, otherwise = children
        return replace(self, body=body, otherwise=otherwise)

    @property
    def caught(self) -> tuple[Node, ...]:
        return (self.body,)

    def flow(self, known: K, visit: Callable[[Node, K], K], test: Callable[[Node, K], None]) -> K:  # noqa: ARG002
        body = visit(self.body, known)
        return body | visit(self.otherwise, known | body)
