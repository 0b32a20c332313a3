"""An action of the robot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language.words import say_action
from fieldhand.task.instructions import BindLabel, Capture, DriveTo, ForgetReading, Locate, Permit, SetReading
from fieldhand.task.nodes.base import PlanNode, Program, Role, SayPlace, Span

if TYPE_CHECKING:
    from fieldhand.places.selector import Selector
    from fieldhand.task.instructions import OpaquePlace, Reading
    from fieldhand.task.run import PlanRun


@dataclass(frozen=True, kw_only=True)
class Act(PlanNode):
    """One action of the robot.

    The robot drives to the place, which must be the only one of the selector, binds the label to it and makes the
    captures there. Without a selector, the action is done at the current place; a robot displaced by a failed drive
    first drives back there. The reading of an earlier round is cleared first, so that it decides nothing if this action
    fails.

    Attributes:
        at: Place; by default the current one.
        at_said: Character ranges of the request that name the place.
        count: Captures at that place.
        parameters: Name and value of each parameter that the profile declares for the action.
        label: Binds the place for later nodes.
        reading: Binds the measured values, of several captures the last.
    """

    id: str = ""
    action: str
    at: Selector | None = None
    at_said: tuple[Span, ...] = ()
    count: int = 1
    parameters: tuple[tuple[str, str | float], ...] = ()
    label: str = ""
    reading: str = ""
    said: tuple[Span, ...] = ()

    def execute(self, run: PlanRun) -> Program:  # noqa: ARG002
        if self.reading:
            yield ForgetReading(node=self, reading=self.reading)
        place: OpaquePlace = yield Locate(node=self, selector=self.at)
        yield Permit(node=self, place=place)
        place = yield DriveTo(node=self, place=place, back=self.at is None)
        yield BindLabel(node=self, label=self.label, places=(place,))
        value: Reading = yield Capture(node=self)
        if self.reading:
            yield SetReading(node=self, reading=self.reading, value=value)

    def say(self, place: SayPlace) -> str:
        there = "" if self.at is None else f" at {place(self.at)}"
        return f"{say_action(self.action, self.count)}{there}"

    @property
    def role(self) -> Role:
        return "action"

    @property
    def act(self) -> Act:
        return self

    @property
    def selector(self) -> Selector | None:
        return self.at
