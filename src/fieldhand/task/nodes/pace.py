"""A part of the plan with a limit on the driving speed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.task.nodes.base import ChildNode, K, PlanNode, Program, Role, SayPlace, Span
from fieldhand.task.nodes.in_order import InOrder

if TYPE_CHECKING:
    from fieldhand.task.plan import Node
    from fieldhand.task.run import PlanRun


@dataclass(frozen=True, kw_only=True)
class Pace(PlanNode):
    """``body``, in which the robot drives no faster than ``speed_m_s``; the whole mission has it in the constraints.

    The lowest limit applies: that of an enclosing pace, of the constraints, or of the robot. The way home after the
    plan, or after a fault, is not limited.

    Attributes:
        speed_m_s: In metres per second.
    """

    id: str = ""
    speed_m_s: float
    body: Node
    said: tuple[Span, ...] = ()

    def execute(self, run: PlanRun) -> Program:
        yield from run.do(self.body)

    def say(self, place: SayPlace) -> str:  # noqa: ARG002
        return f"at most {self.speed_m_s:g} m/s"

    @property
    def role(self) -> Role:
        return "limit"

    @property
    def parts(self) -> tuple[ChildNode, ...]:
        return (ChildNode(node=self.body),)

    @property
    def is_series(self) -> bool:
        return True

    def with_children(self, children: Sequence[Node]) -> Pace:
        (body,) = children
        return replace(self, body=body)

    def flow(self, known: K, visit: Callable[[Node, K], K], test: Callable[[Node, K], None]) -> K:  # noqa: ARG002
        return visit(self.body, known)

    @property
    def pace_m_s(self) -> float:
        return self.speed_m_s

    def around(self, rest: Sequence[Node]) -> tuple[Node, ...]:
        return (replace(self, body=InOrder(id=self.id, steps=tuple(rest))),) if rest else ()
