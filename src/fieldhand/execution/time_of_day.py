"""Time of day at which a mission began, and changes of the wall clock; recorded only, nothing depends on them."""

from __future__ import annotations

from datetime import datetime

from fieldhand.compatibility import UTC
from fieldhand.execution.recorded_inputs import RecordedInputs

#: Deviation in seconds from the mission clock between two events beyond which the wall clock was changed.
SET_S = 2.0


class TimeOfDay:
    """Tracks the time of day.

    Args:
        inputs: Recorded inputs, which include the time of day.
    """

    def __init__(self, inputs: RecordedInputs) -> None:
        self._inputs = inputs
        self._began_s = inputs.observation.wall
        self._ahead_s = 0.0 if self._began_s is None else self._began_s - inputs.observation.t

    @property
    def began_at(self) -> str:
        """Beginning of the mission in ISO 8601, UTC; empty if there is no time of day."""
        if self._began_s is None:
            return ""
        return datetime.fromtimestamp(self._began_s, UTC).isoformat(timespec="milliseconds")

    def set_by(self) -> float:
        """Return the seconds by which the wall clock was changed since the last call."""
        seen = self._inputs.observation
        if self._began_s is None or seen.wall is None:
            return 0.0
        ahead_s = seen.wall - seen.t
        by_s = ahead_s - self._ahead_s
        self._ahead_s = ahead_s
        return by_s if abs(by_s) > SET_S else 0.0
