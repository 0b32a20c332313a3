"""The time of a mission, which outlasts the process that carries it out."""

from __future__ import annotations

import math
import time

from fieldhand.clock import Clock, PacedClock

#: Seconds of the wall clock between two looks at the robot, and at what people want.
LOOK_EVERY_S = 0.1


class MissionClock:
    """The mission's time: it stands still between two looks, never goes back, and goes on where the tape ends.

    Args:
        source: What drives it. If that jumps back, this one stands.
    """

    def __init__(self, source: Clock) -> None:
        self._source = source
        self._now = 0.0
        self._ahead = -source.now()

    @property
    def speed(self) -> float:
        """Seconds that pass here in one second of the wall clock; infinite where time jumps."""
        return self._source.speed if isinstance(self._source, PacedClock) else math.inf

    def now(self) -> float:
        return self._now

    def advance(self, seconds: float) -> None:
        """Let time pass; it is seen at the next look."""
        self._source.advance(seconds)

    def look(self) -> float:
        """Take the time of this instant."""
        self._now = max(self._now, self._ahead + self._source.now())
        return self._now

    def set(self, now: float) -> None:
        """It is that time, as it was then."""
        self._now, self._ahead = now, now - self._source.now()

    def rest(self) -> None:
        """Wait a moment of the wall clock in which nothing is to happen; a clock that jumps does not."""
        if math.isinf(self.speed):
            time.sleep(LOOK_EVERY_S)
        else:
            self._source.advance(LOOK_EVERY_S * self.speed)
