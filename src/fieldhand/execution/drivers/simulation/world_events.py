"""Events of a world: when and where they occur in a simulation."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Annotated

from pydantic import Field, FiniteFloat, StrictBool, model_validator

from fieldhand.execution.drivers.simulation.world import ScriptedEvent
from fieldhand.execution.drivers.simulation.world_faults import FaultDistance, Second, Strict, TreeRefModel
from fieldhand.robot.events import MonitoredEvent

#: Seconds within which two times are equal: clocks add floating-point numbers.
_SAME_S = 1e-6

Point = tuple[float, float]


class ScriptedEventModel(Strict):
    """An event in a world file."""

    event: str
    value: FiniteFloat | StrictBool | None = None
    silent: StrictBool = False
    from_s: Second = 0.0
    until_s: Second | None = None
    at: TreeRefModel | None = None
    within_m: FaultDistance = 5.0
    for_s: Annotated[float, Field(gt=0, allow_inf_nan=False)] | None = None
    chance: Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)] | None = None
    every_s: Annotated[float, Field(ge=1, allow_inf_nan=False)] = 60.0

    @model_validator(mode="after")
    def _consistent(self) -> ScriptedEventModel:
        if self.until_s is not None and self.until_s <= self.from_s:
            raise ValueError(f"until_s {self.until_s:g} is not after from_s {self.from_s:g}")
        if self.at is not None and self.chance is not None:
            raise ValueError("give either at or chance, not both")
        if self.for_s is not None and self.at is None and self.chance is None:
            raise ValueError("for_s needs at or chance; give until_s otherwise")
        if self.silent and self.value is not None:
            raise ValueError("a silent sensor has no value")
        return self

    def scripted(self) -> ScriptedEvent:
        """Return the event for execution."""
        return ScriptedEvent(
            event=self.event,
            value=1.0 if self.value is None else float(self.value),
            silent=self.silent,
            from_s=self.from_s,
            until_s=self.until_s,
            at=None if self.at is None else self.at.reference(),
            within_m=self.within_m,
            for_s=self.for_s,
            chance=self.chance,
            every_s=self.every_s,
        )


class EventScript:
    """The events of one simulated mission.

    Args:
        scripted: Events of the world.
        known: Events of the robot.
        middles: Position of the tree of each scripted event that has one, by its number, in local metres.
        seed: Seed that decides about events with a chance.
    """

    def __init__(
        self,
        scripted: Sequence[ScriptedEvent],
        known: Iterable[MonitoredEvent],
        middles: Mapping[int, Point],
        seed: Callable[[], int],
    ) -> None:
        self._scripted, self._known, self._middles, self._seed = tuple(scripted), tuple(known), middles, seed
        self._met: dict[int, float] = {}

    @property
    def met(self) -> tuple[tuple[int, float], ...]:
        """Events of limited duration at trees: number, and time in seconds at which the robot first came there."""
        return tuple(self._met.items())

    def restore(self, met: Iterable[tuple[int, float]]) -> None:
        """Continue from the :attr:`met` of another one."""
        self._met = dict(met)

    def note(self, now_s: float, position: Callable[[], Point]) -> None:
        """Record which events the robot has come to by a time of the mission in seconds."""
        if not self._middles:
            return
        x, y = position()
        for number, (cx, cy) in self._middles.items():
            near = (x - cx) ** 2 + (y - cy) ** 2 <= self._scripted[number].within_m ** 2
            if near and _is_due(self._scripted[number], now_s):
                self._met.setdefault(number, now_s)
            elif self._scripted[number].for_s is None:
                self._met.pop(number, None)

    def values(self, now_s: float) -> dict[str, float | None]:
        """Return the value of each event of the robot at a time of the mission; None if its sensor is silent."""
        values: dict[str, float | None] = {e.name: e.typical if e.unit else 0.0 for e in self._known}
        for number, one in enumerate(self._scripted):
            if self._occurs(number, one, now_s):
                values[one.event] = None if one.silent else one.value
        return values

    def _occurs(self, number: int, one: ScriptedEvent, now_s: float) -> bool:
        if one.at is not None:
            since = self._met.get(number)
            return since is not None and (one.for_s is None or now_s < since + one.for_s - _SAME_S)
        if not _is_due(one, now_s):
            return False
        if one.chance is None:
            return True
        period = int((now_s - one.from_s) // one.every_s)
        key = f"{self._seed()}\0event\0{number}\0{period}".encode()
        drawn = int.from_bytes(hashlib.sha256(key).digest()[:8], "big") / 2.0**64
        passed = now_s - one.from_s - period * one.every_s
        return drawn < one.chance and (one.for_s is None or passed < one.for_s)


def _is_due(one: ScriptedEvent, now_s: float) -> bool:
    return one.from_s - _SAME_S <= now_s and (one.until_s is None or now_s < one.until_s - _SAME_S)
