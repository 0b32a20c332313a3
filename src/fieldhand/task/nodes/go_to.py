"""A drive to a place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.task.instructions import BindLabel, DriveTo, Locate, Permit
from fieldhand.task.nodes.base import PlanNode, Program, Role, SayPlace, Span

if TYPE_CHECKING:
    from fieldhand.places.selector import Selector
    from fieldhand.task.instructions import OpaquePlace
    from fieldhand.task.run import PlanRun


@dataclass(frozen=True, kw_only=True)
class GoTo(PlanNode):
    """Drive to a place; the selector must give one. ``label`` binds it for later nodes."""

    id: str = ""
    place: Selector
    label: str = ""
    said: tuple[Span, ...] = ()

    def execute(self, run: PlanRun) -> Program:  # noqa: ARG002
        place: OpaquePlace = yield Locate(node=self, selector=self.place)
        yield Permit(node=self, place=place)
        place = yield DriveTo(node=self, place=place)
        yield BindLabel(node=self, label=self.label, places=(place,))

    def say(self, place: SayPlace) -> str:
        return f"go to {place(self.place)}"

    @property
    def role(self) -> Role:
        return "place"

    @property
    def only_drives(self) -> bool:
        return True

    @property
    def selector(self) -> Selector:
        return self.place
