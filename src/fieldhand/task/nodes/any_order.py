"""Steps in the order with the shortest drive."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from operator import or_
from typing import TYPE_CHECKING

from fieldhand.task.instructions import ArrangeSteps
from fieldhand.task.nodes.base import ChildNode, K, PlanNode, Program, Role, SayPlace, Span

if TYPE_CHECKING:
    from fieldhand.task.plan import Node
    from fieldhand.task.run import PlanRun


@dataclass(frozen=True, kw_only=True)
class AnyOrder(PlanNode):
    """Steps in the order with the shortest drive; each step begins at a place of its own.

    The order is decided once, when the node is reached. The node fails as soon as a step fails.

    Each of ``steps`` is executed once.
    """

    id: str = ""
    steps: tuple[Node, ...]
    said: tuple[Span, ...] = ()

    def execute(self, run: PlanRun) -> Program:
        order: tuple[int, ...] = yield ArrangeSteps(node=self)
        for at, index in enumerate(order):
            run.frame.left = tuple(self.steps[k] for k in order[at + 1 :])
            yield from run.do(self.steps[index])

    def say(self, place: SayPlace) -> str:  # noqa: ARG002
        return "in the best order"

    @property
    def role(self) -> Role:
        return "order"

    @property
    def parts(self) -> tuple[ChildNode, ...]:
        return tuple(ChildNode(node=step) for step in self.steps)

    @property
    def is_series(self) -> bool:
        return True

    def with_children(self, children: Sequence[Node]) -> AnyOrder:
        return replace(self, steps=tuple(children))

    def goes_on_after(self, child: Node) -> bool:  # noqa: ARG002
        return len(self.steps) > 1

    @property
    def in_any_order(self) -> bool:
        return True

    def flow(self, known: K, visit: Callable[[Node, K], K], test: Callable[[Node, K], None]) -> K:  # noqa: ARG002
        # Any step may come first, so none may depend on another.
        return reduce(or_, [visit(step, known) for step in self.steps], known)
