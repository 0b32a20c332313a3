"""Time as an argument: the clock that a mission runs on."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Protocol, runtime_checkable


class Clock(Protocol):
    """Seconds since the mission began, and a way to let time pass."""

    def now(self) -> float:
        """Seconds since the clock was made."""
        ...

    def advance(self, seconds: float) -> None:
        """Let ``seconds`` (0 or more) pass."""
        ...


@runtime_checkable
class PacedClock(Clock, Protocol):
    """A clock on which time passes by itself, whoever waits."""

    @property
    def speed(self) -> float:
        """Seconds that pass here in one second of the wall clock, above 0."""
        ...


class WallClock(Protocol):
    """The time of day. Anyone may set it, so nothing is decided by it: it only says when a mission was."""

    def now(self) -> float:
        """Seconds since 1970 began, in UTC."""
        ...


class SystemWallClock:
    """The computer's own time of day."""

    def now(self) -> float:
        return time.time()


class SimulatedWallClock:
    """A time of day that goes with a mission's clock, but for being set.

    Args:
        clock: The mission's.
        begins_s: Seconds since 1970 when this object is made.
        jumps: When it is set, in seconds from then on, and by how many seconds.
    """

    def __init__(self, clock: Clock, begins_s: float, jumps: Sequence[tuple[float, float]] = ()) -> None:
        self._clock, self._begins_s, self._jumps = clock, begins_s, tuple(jumps)
        self._made_s = clock.now()

    def now(self) -> float:
        passed = self._clock.now() - self._made_s
        return self._begins_s + passed + sum(by for at, by in self._jumps if passed >= at)


class SimulatedClock:
    """A clock that jumps: time passes as fast as the program runs."""

    def __init__(self) -> None:
        self._now = 0.0

    def now(self) -> float:
        return self._now

    def advance(self, seconds: float) -> None:
        self._now += max(0.0, seconds)


class ScaledClock:
    """A clock on which ``speed`` seconds pass in one second of the wall clock.

    Args:
        speed: 1 is real time. Must be above 0.
    """

    def __init__(self, speed: float = 1.0) -> None:
        if not speed > 0:
            raise ValueError(f"speed must be above 0, not {speed}")
        self._speed = speed
        self._start = time.monotonic()

    @property
    def speed(self) -> float:
        """Seconds that pass here in one second of the wall clock."""
        return self._speed

    def now(self) -> float:
        return (time.monotonic() - self._start) * self._speed

    def advance(self, seconds: float) -> None:
        time.sleep(max(0.0, seconds) / self._speed)


def clock_time(seconds: float) -> str:
    """Minutes and seconds since the mission began: "3:07"; from an hour on "1:03:07"."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"
