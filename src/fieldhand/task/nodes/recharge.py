"""Recharging as a step of the plan."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.places.sources.marker import Marker
from fieldhand.task.instructions import Charge, DriveTo, Locate, Permit
from fieldhand.task.nodes.base import PlanNode, Program, Role, SayPlace, Span

if TYPE_CHECKING:
    from fieldhand.places.selector import Selector
    from fieldhand.task.instructions import OpaquePlace
    from fieldhand.task.run import PlanRun


@dataclass(frozen=True, kw_only=True)
class Recharge(PlanNode):
    """Drive to the charger marker of the site, dock and charge the battery; the charger becomes the current place.

    Attributes:
        until_percent: Charge at which charging ends; by default that of the robot's profile.
        duration_s: Seconds at the charger instead; with both, whichever is over first.
    """

    id: str = ""
    until_percent: float | None = None
    duration_s: float | None = None
    said: tuple[Span, ...] = ()

    def execute(self, run: PlanRun) -> Program:  # noqa: ARG002
        place: OpaquePlace = yield Locate(node=self, selector=self.selector)
        yield Permit(node=self, place=place)
        yield DriveTo(node=self, place=place)
        yield Charge(node=self)

    def say(self, place: SayPlace) -> str:
        return f"recharge at {place(self.selector)}"

    @property
    def role(self) -> Role:
        return "action"

    @property
    def selector(self) -> Selector:
        return Marker(name="charger")

    @property
    def recharge(self) -> Recharge:
        return self
