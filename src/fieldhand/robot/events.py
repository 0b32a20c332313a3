"""Events of a robot: what its sensors report all the time, apart from the readings of its actions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

#: Meaning of an event that is unknown because its sensor is silent.
Unheard = Literal["holds", "ignored"]

#: Default time in seconds for which an event must not have held until it counts as over.
CLEAR_S = 5.0


@dataclass(frozen=True, kw_only=True)
class MonitoredEvent:
    """An event that the robot detects while it drives, works and waits: true or false, or a measured value.

    Attributes:
        name: Identifier in lower case with underscores: ``person_near``.
        description: Clause that says what holds: "someone is near".
        words: Nouns that people use for it ("person", "rain", "wind").
        verbs: Verbs that mean it by themselves: "rain" for "it rains".
        states: What the nouns must be: "closed" of a gate; or what it must be: "windy".
        unit: Unit of a measured event; empty for one that is true or false.
        above, below: Threshold beyond which a measured event holds where a Task gives none; at most one of them.
        typical: Value of a measured event in a simulation whose world does not set it.
        clear_s: Seconds for which it must not have held until it counts as over.
        unless_heard: Meaning of a silent sensor: the event ``holds``, or is ``ignored``.
        labels: Descriptions in other languages, by language code.
    """

    name: str
    description: str
    words: tuple[str, ...]
    verbs: tuple[str, ...] = ()
    states: tuple[str, ...] = ()
    unit: str = ""
    above: float | None = None
    below: float | None = None
    typical: float = 0.0
    clear_s: float = CLEAR_S
    unless_heard: Unheard = "holds"
    labels: Mapping[str, str] = field(default_factory=dict)

    @property
    def can_hold(self) -> bool:
        """True if it can hold without a threshold in the Task."""
        return not self.unit or self.above is not None or self.below is not None

    def holds(self, value: float) -> bool:
        """Return True if it holds at a value, by the profile's own threshold if it is measured."""
        if not self.unit:
            return value != 0.0
        return (self.above is not None and value > self.above) or (self.below is not None and value < self.below)
