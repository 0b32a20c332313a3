"""The time of a mission, which outlasts the process that carries it out, and a timeout on it."""

from __future__ import annotations

import math
import time

from fieldhand.clock import Clock, PacedClock

#: Seconds of the wall clock between two looks at the robot and at orders.
LOOK_EVERY_S = 0.1

#: Seconds and looks that a robot is given to stand still after a goal was cancelled: where its time passes faster than
#: the wall clock, messages need more looks.
STOP_WITHIN_S, STOP_LOOKS = 10.0, 200


class MissionClock:
    """The mission's time: constant between two looks, never decreasing, continued where a replay ends.

    Args:
        source: The clock behind it. If that jumps back, this one stands.
    """

    def __init__(self, source: Clock) -> None:
        self._source = source
        self._now = 0.0
        self._ahead = -source.now()

    @property
    def speed(self) -> float:
        """Mission seconds per second of the wall clock; infinite if time jumps."""
        return self._source.speed if isinstance(self._source, PacedClock) else math.inf

    def now(self) -> float:
        return self._now

    def advance(self, seconds: float) -> None:
        """Let time pass; :meth:`now` changes at the next look."""
        self._source.advance(seconds)

    def look(self) -> float:
        """Read the source, and return the time."""
        self._now = max(self._now, self._ahead + self._source.now())
        return self._now

    def set(self, now: float) -> None:
        """Set the time to a recorded one."""
        self._now, self._ahead = now, now - self._source.now()

    def rest(self) -> None:
        """Wait until the next look is due without letting a clock that jumps advance."""
        if math.isinf(self.speed):
            time.sleep(LOOK_EVERY_S)
        else:
            self._source.advance(LOOK_EVERY_S * self.speed)


class StopTimeout:
    """A timeout for a robot that is to stand still.

    Args:
        clock: The mission's.
    """

    def __init__(self, clock: Clock) -> None:
        self._clock, self._until_s, self._looks = clock, clock.now() + STOP_WITHIN_S, 0

    def expired(self) -> bool:
        """Count a look, and return True if time and looks are used up."""
        self._looks += 1
        return self._clock.now() >= self._until_s and self._looks > STOP_LOOKS
