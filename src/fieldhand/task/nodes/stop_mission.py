"""The end of the mission as a step of the plan."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from fieldhand.task.nodes.base import PlanNode, Program, Role, SayPlace, Span, Stopped

if TYPE_CHECKING:
    from fieldhand.task.run import PlanRun


@dataclass(frozen=True, kw_only=True)
class StopMission(PlanNode):
    """End the mission here and take an exit; no enclosing node continues.

    ``exit`` selects the exit: ``nominal`` as after a completed plan, ``faulted`` as after an abort.
    """

    id: str = ""
    exit: Literal["nominal", "faulted"] = "nominal"
    said: tuple[Span, ...] = ()

    def execute(self, run: PlanRun) -> Program:  # noqa: ARG002
        yield from ()
        raise Stopped(self)

    def say(self, place: SayPlace) -> str:  # noqa: ARG002
        return f"stop ({self.exit} exit)"

    @property
    def role(self) -> Role:
        return "end"

    @property
    def ends_plan(self) -> bool:
        return True
