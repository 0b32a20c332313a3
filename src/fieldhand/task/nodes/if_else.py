"""One of two branches, chosen by a condition."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.task.instructions import Decide
from fieldhand.task.nodes.base import ChildNode, K, PlanNode, Program, Role, SayPlace, Span

if TYPE_CHECKING:
    from fieldhand.task.conditions import Condition
    from fieldhand.task.plan import Node
    from fieldhand.task.run import PlanRun


@dataclass(frozen=True, kw_only=True)
class If(PlanNode):
    """``then`` if the condition is true, else ``otherwise`` (nothing if absent). It is tested once, when reached.

    A condition on a reading that was not taken is false. ``otherwise`` is None for no alternative.
    """

    id: str = ""
    condition: Condition
    then: Node
    otherwise: Node | None = None
    said: tuple[Span, ...] = ()

    def execute(self, run: PlanRun) -> Program:
        if (yield Decide(node=self, condition=self.condition)):
            yield from run.do(self.then)
        elif self.otherwise is not None:
            yield from run.do(self.otherwise)

    def say(self, place: SayPlace) -> str:  # noqa: ARG002
        return "if"

    @property
    def role(self) -> Role:
        return "condition"

    @property
    def parts(self) -> tuple[ChildNode, ...]:
        sides = (self.then,) if self.otherwise is None else (self.then, self.otherwise)
        return tuple(ChildNode(node=side, certain=False) for side in sides)

    def with_children(self, children: Sequence[Node]) -> If:
        then, *other = children
        return replace(self, then=then, otherwise=other[0] if other else None)

    @property
    def is_choice(self) -> bool:
        return True

    def flow(self, known: K, visit: Callable[[Node, K], K], test: Callable[[Node, K], None]) -> K:
        test(self, known)
        other = known if self.otherwise is None else visit(self.otherwise, known)
        return visit(self.then, known) | other

    @property
    def tested(self) -> Condition:
        return self.condition
