"""Mission clock, which continues after the process is restarted, and a timeout based on it."""

from __future__ import annotations

import math
import time

from fieldhand.clock import Clock, PacedClock

#: Seconds of the wall clock between two polls of the robot and of commands.
LOOK_EVERY_S = 0.1

#: Seconds and polls within which a robot must stand still after a cancelled goal. Where its time runs faster than the
#: wall clock, messages need more polls.
STOP_WITHIN_S, STOP_LOOKS = 10.0, 200


class MissionClock:
    """Mission time: constant between two polls, never decreasing, continued after a replay.

    Args:
        source: Underlying clock. If it jumps back, the mission clock stands still.
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
        """Let time pass; :meth:`now` changes at the next :meth:`look`."""
        self._source.advance(seconds)

    def look(self) -> float:
        """Read the source, and return the time."""
        self._now = max(self._now, self._ahead + self._source.now())
        return self._now

    def skip(self, seconds: float) -> None:
        """Count seconds that have passed while nobody looked."""
        self._now, self._ahead = self._now + seconds, self._ahead + seconds

    def set(self, now: float) -> None:
        """Set the time to a recorded one."""
        self._now, self._ahead = now, now - self._source.now()

    def rest(self) -> None:
        """Wait until the next poll is due, without advancing a clock that jumps."""
        if math.isinf(self.speed):
            time.sleep(LOOK_EVERY_S)
        else:
            self._source.advance(LOOK_EVERY_S * self.speed)


class StopTimeout:
    """Timeout for a robot that must stand still.

    Args:
        clock: Mission clock.
    """

    def __init__(self, clock: Clock) -> None:
        self._clock, self._until_s, self._looks = clock, clock.now() + STOP_WITHIN_S, 0

    def expired(self) -> bool:
        """Count a poll, and return True if both time and polls are used up."""
        self._looks += 1
        return self._clock.now() >= self._until_s and self._looks > STOP_LOOKS
