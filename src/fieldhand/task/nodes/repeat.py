"""A node executed a number of times."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.language.words import say_times
from fieldhand.task.instructions import BeginRound, BeginSeries, Decide
from fieldhand.task.nodes.base import ChildNode, K, PlanNode, Program, Role, SayPlace, Span

if TYPE_CHECKING:
    from fieldhand.task.conditions import Condition
    from fieldhand.task.plan import Node
    from fieldhand.task.run import PlanRun


@dataclass(frozen=True, kw_only=True)
class Repeat(PlanNode):
    """``body`` a number of times, or until a condition is true after a round, whichever comes first.

    ``times`` is the maximum number of rounds, at least 1; ``until`` is None for exactly that number. Of
    the reading ``collects``, all readings so far are forgotten when it begins.
    """

    id: str = ""
    times: int
    body: Node
    until: Condition | None = None
    collects: str = ""
    said: tuple[Span, ...] = ()

    def execute(self, run: PlanRun) -> Program:
        if self.collects:
            yield BeginSeries(node=self, reading=self.collects)
        for left in reversed(range(self.times)):
            run.frame.left = (replace(self, times=left),) if left else ()
            yield BeginRound(node=self, left=left)
            yield from run.do(self.body)
            if self.until is not None and (yield Decide(node=self, condition=self.until)):
                break

    def say(self, place: SayPlace) -> str:  # noqa: ARG002
        return f"{'until it holds, at most ' if self.until else ''}{say_times(self.times)}"

    @property
    def role(self) -> Role:
        return "order"

    @property
    def parts(self) -> tuple[ChildNode, ...]:
        return (ChildNode(node=self.body, times=self.times if self.until is None else None),)

    def with_children(self, children: Sequence[Node]) -> Repeat:
        (body,) = children
        return replace(self, body=body)

    def goes_on_after(self, child: Node) -> bool:  # noqa: ARG002
        return self.times > 1

    def flow(self, known: K, visit: Callable[[Node, K], K], test: Callable[[Node, K], None]) -> K:
        after = visit(self.body, known)
        test(self, after)
        return known | after

    @property
    def rounds(self) -> int:
        return self.times

    @property
    def tested(self) -> Condition | None:
        return self.until
