"""The time of day beside the mission's own time: it is recorded, and nothing depends on it."""

from __future__ import annotations

from datetime import UTC, datetime

from fieldhand.execution.recorded_inputs import RecordedInputs

#: Seconds by which the time of day may deviate from the mission's between two events without having been set.
SET_S = 2.0


class TimeOfDay:
    """The time of day when a mission began, and by how much it was set since.

    Args:
        inputs: Observes the mission's time and the time of day.
    """

    def __init__(self, inputs: RecordedInputs) -> None:
        self._inputs = inputs
        self._began_s = inputs.seen.wall
        self._ahead_s = 0.0 if self._began_s is None else self._began_s - inputs.seen.t

    @property
    def began_at(self) -> str:
        """ISO 8601 in UTC; empty if there is no time of day."""
        if self._began_s is None:
            return ""
        return datetime.fromtimestamp(self._began_s, UTC).isoformat(timespec="milliseconds")

    def set_by(self) -> float:
        """Return by how many seconds it was set since this was last called."""
        seen = self._inputs.seen
        if self._began_s is None or seen.wall is None:
            return 0.0
        ahead_s = seen.wall - seen.t
        by_s = ahead_s - self._ahead_s
        self._ahead_s = ahead_s
        return by_s if abs(by_s) > SET_S else 0.0
