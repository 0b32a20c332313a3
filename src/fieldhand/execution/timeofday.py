"""The time of day beside the mission's own time: it is written down, and nothing is decided by it."""

from __future__ import annotations

from datetime import UTC, datetime

from fieldhand.clock import Clock, WallClock

#: Seconds by which the time of day may run off the mission's between two events before somebody has set it.
SET_S = 2.0


class TimeOfDay:
    """Notes the time of day when a mission begins, and every time that somebody sets it.

    Args:
        clock: The mission's; nobody sets that.
        wall: The time of day; None where there is none.
    """

    def __init__(self, clock: Clock, wall: WallClock | None) -> None:
        self._clock, self._wall = clock, wall
        self._began_s = 0.0 if wall is None else wall.now()
        self._ahead_s = self._began_s - clock.now()

    @property
    def began_at(self) -> str:
        """ISO 8601 in UTC; empty where there is none."""
        if self._wall is None:
            return ""
        return datetime.fromtimestamp(self._began_s, UTC).isoformat(timespec="milliseconds")

    def set_by(self) -> float:
        """By how many seconds it was set since this was last asked; 0 where it was not."""
        if self._wall is None:
            return 0.0
        ahead_s = self._wall.now() - self._clock.now()
        by_s = ahead_s - self._ahead_s
        self._ahead_s = ahead_s
        return by_s if abs(by_s) > SET_S else 0.0
