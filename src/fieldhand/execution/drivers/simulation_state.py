"""The state of a simulated robot that outlasts the program that simulates it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class SimulationState:
    """The state of a simulated robot without a goal, from which another one continues.

    Attributes:
        seconds: Since it was first made; faults of its world come by them.
        x, y: Where it stands, in local metres.
        charge_percent: Of the battery.
        generator: State of its random generator, as numpy has it.
        values_seed: Of the readings that its world leaves open.
        captures: How often each quantity was drawn at each place, by both names.
        struck: How often each fault of its world has happened, by its number.
        lost: Until which second it does not know where it is, and why.
    """

    seconds: float
    x: float
    y: float
    charge_percent: float
    generator: Mapping[str, object]
    values_seed: int
    captures: tuple[tuple[str, str, int], ...] = ()
    struck: tuple[tuple[int, int], ...] = ()
    lost: tuple[tuple[float, str], ...] = ()
