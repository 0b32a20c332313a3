"""A wait at the current place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language.words import say_wait
from fieldhand.task.instructions import WaitFor
from fieldhand.task.nodes.base import PlanNode, Program, Role, SayPlace, Span

if TYPE_CHECKING:
    from fieldhand.task.run import PlanRun


@dataclass(frozen=True, kw_only=True)
class Wait(PlanNode):
    """Stand still for ``seconds`` at the current place; to wait elsewhere, go there first.

    The robot stays where it is, even if a failed drive left it on the way: it does not drive back. The time counts
    towards budgets, and idle power towards the battery.

    Attributes:
        seconds: Above 0.
    """

    id: str = ""
    seconds: float
    said: tuple[Span, ...] = ()

    def execute(self, run: PlanRun) -> Program:  # noqa: ARG002
        yield WaitFor(node=self, seconds=self.seconds)

    def say(self, place: SayPlace) -> str:  # noqa: ARG002
        return f"wait {say_wait(self.seconds)}"

    @property
    def role(self) -> Role:
        return "action"

    @property
    def dwell_s(self) -> float:
        return self.seconds
