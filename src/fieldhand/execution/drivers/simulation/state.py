"""State of a simulated robot, stored across restarts of its program."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class SimulationState:
    """State of a simulated robot without a goal, from which another one continues.

    Attributes:
        seconds: Time since it was first created, by which faults of its world occur.
        x, y: Position in local metres.
        charge_percent: Battery charge.
        generator: State of its numpy random generator.
        values_seed: Seed of the readings that its world leaves open.
        captures: Number of draws per quantity and place: (quantity, place, count).
        struck: Number of occurrences per fault of its world: (number, count).
        lost: Until when, in seconds, its position is lost, and why.
        met: When, in seconds, the robot came to events of its world that last for a while: (number, time).
        docked: True if it is connected to its charger.
        heading_deg: Heading in degrees clockwise from north; None if it has not moved yet.
        off_east_m, off_north_m: Metres from where it is to where it believes to be.
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
    met: tuple[tuple[int, float], ...] = ()
    docked: bool = False
    heading_deg: float | None = None
    off_east_m: float = 0.0
    off_north_m: float = 0.0
