"""Clocks of a mission: simulated, scaled and wall-clock time, passed in as arguments."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Protocol, runtime_checkable


class Clock(Protocol):
    """A monotonic clock that counts seconds from its creation and can wait."""

    def now(self) -> float:
        """Return the seconds since the clock was created."""
        ...

    def advance(self, seconds: float) -> None:
        """Let ``seconds`` (0 or more) pass; waits on a paced clock."""
        ...


@runtime_checkable
class PacedClock(Clock, Protocol):
    """A clock whose time passes by itself, at a fixed ratio to real time."""

    @property
    def speed(self) -> float:
        """Seconds of this clock per second of real time, above 0."""
        ...


class WallClock(Protocol):
    """The date and time of day. It can be set at any time, so it only dates a mission and decides nothing."""

    def now(self) -> float:
        """Return the seconds since 1970-01-01 00:00 UTC."""
        ...


class SystemWallClock:
    """The computer's date and time of day."""

    def now(self) -> float:
        return time.time()


class SimulatedWallClock:
    """A simulated date and time that advances with a mission's clock and can jump as if it were set.

    Args:
        clock: Clock of the mission.
        begins_s: Initial time, in seconds since 1970.
        jumps: Times of jumps, in seconds from now, each with the seconds by which the time of day jumps.
    """

    def __init__(self, clock: Clock, begins_s: float, jumps: Sequence[tuple[float, float]] = ()) -> None:
        self._clock, self._begins_s, self._jumps = clock, begins_s, tuple(jumps)
        self._made_s = clock.now()

    def now(self) -> float:
        passed = self._clock.now() - self._made_s
        return self._begins_s + passed + sum(by for at, by in self._jumps if passed >= at)


class SimulatedClock:
    """A clock that never waits: :meth:`advance` jumps ahead, so a mission runs as fast as the program."""

    def __init__(self) -> None:
        self._now = 0.0

    def now(self) -> float:
        return self._now

    def advance(self, seconds: float) -> None:
        self._now += max(0.0, seconds)


class ScaledClock:
    """A clock that runs at a multiple of real time.

    Args:
        speed: Seconds of this clock per second of real time, above 0; 1 is real time.
    """

    def __init__(self, speed: float = 1.0) -> None:
        if not speed > 0:
            raise ValueError(f"speed must be above 0, not {speed}")
        self._speed = speed
        self._start = time.monotonic()

    @property
    def speed(self) -> float:
        """Seconds of this clock per second of real time."""
        return self._speed

    def now(self) -> float:
        return (time.monotonic() - self._start) * self._speed

    def advance(self, seconds: float) -> None:
        time.sleep(max(0.0, seconds) / self._speed)


def clock_time(seconds: float) -> str:
    """Return a time in seconds as minutes and seconds, "3:07", or with hours, "1:03:07"."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"
