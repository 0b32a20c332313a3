"""Heading of the robot: as it reports it, as the end of a drive was commanded, or as its positions show it."""

from __future__ import annotations

import math

from fieldhand.execution.drivers.protocol import Position

#: Metres between two positions from which their direction is known.
_LEAST_M = 0.5


class Course:
    """Heading of the robot, or if it is unknown the direction of the last metres driven.

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
        if position.heading_deg is not None:
            self.turned(position.heading_deg, position)
            return
        east, north = position.x - self._from[0], position.y - self._from[1]
        if math.hypot(east, north) >= _LEAST_M:
            self.heading_deg = math.degrees(math.atan2(east, north)) % 360.0
            self._from = position.xy

    def turned(self, heading_deg: float | None, position: Position) -> None:
        """Note that the robot has this heading at a position, if it is known, whatever its last metres show."""
        if heading_deg is not None:
            self.heading_deg, self._from = heading_deg, position.xy
