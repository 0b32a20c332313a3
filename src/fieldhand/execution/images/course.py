"""Heading of the robot as its positions show it."""

from __future__ import annotations

import math

from fieldhand.execution.drivers.protocol import Position

#: Metres between two positions from which their direction is known.
_LEAST_M = 0.5


class Course:
    """Direction of the last metres driven.

    Attributes:
        heading_deg: Degrees clockwise from true north; None before the robot has moved.
    """

    def __init__(self) -> None:
        self.heading_deg: float | None = None
        self._from: tuple[float, float] | None = None

    def add(self, position: Position) -> None:
        """Add the next position."""
        if self._from is None:
            self._from = position.xy
        east, north = position.x - self._from[0], position.y - self._from[1]
        if math.hypot(east, north) >= _LEAST_M:
            self.heading_deg = math.degrees(math.atan2(east, north)) % 360.0
            self._from = position.xy
