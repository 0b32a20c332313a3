"""Progress of a drive towards its goal, by the feedback of navigation.

Nav2 may recover and drive on for ever before an obstacle at its goal: every recovery is a success, after which it
begins anew. It reports the length of the way that is left, and counts its recoveries.
"""

from __future__ import annotations

import math

from fieldhand.execution.drivers.ros2.message_fields import number_at
from fieldhand.execution.drivers.ros2.service_call import TimeLimit
from fieldhand.execution.drivers.ros2.transport import RosMessage
from fieldhand.robot.bindings import FieldBinding

#: Metres by which the rest of the way must shrink to count as coming nearer.
_NEARER_M = 0.5
#: Metres by which it grows where Nav2 has chosen another way, and how often that counts in one drive.
_OTHER_WAY_M, _MOST_WAYS = 5.0, 3

#: The ``distance_to_goal`` of FollowPath is wrong in Nav2 1.3: it compares the position in the frame of the local
#: costmap, usually odom, with a path in that of the map. The controller reports a lack of progress itself (code 105).
_LEFT = FieldBinding(path="distance_remaining")
_RECOVERIES = FieldBinding(path="number_of_recoveries")


class Headway:
    """Monitor of one goal of Nav2.

    Args:
        limit: Seconds without coming nearer after which the drive is stuck.
        most_recoveries: Recoveries without coming nearer after which it is.

    Attributes:
        recoveries: Number of recoveries of this goal.
        least_m: Least metres of the way that were left; infinite if the feedback does not tell.
    """

    def __init__(self, limit: TimeLimit, most_recoveries: int) -> None:
        self._limit, self._most_recoveries = limit, most_recoveries
        self._best_m: float | None = None
        self.least_m = math.inf
        self._before = self.recoveries = self._ways = 0

    def look(self, feedback: RosMessage) -> str | None:
        """Return why the drive is stuck, in words; None if it is not, or if the feedback does not tell."""
        left_m = number_at(feedback, _LEFT)
        self.recoveries = max(self.recoveries, int(number_at(feedback, _RECOVERIES) or 0))
        if left_m is None or left_m <= 0.0:
            return None
        self.least_m = min(self.least_m, left_m)
        other_way = self._best_m is not None and left_m > self._best_m + _OTHER_WAY_M and self._ways < _MOST_WAYS
        if self._best_m is None or left_m < self._best_m - _NEARER_M or other_way:
            self._ways += other_way
            self._best_m, self._before = left_m, self.recoveries
            self._limit.renew()
            return None
        vain = self.recoveries - self._before
        if vain >= self._most_recoveries:
            return f"it came no nearer to its goal in {_times(vain)}"
        if self._limit.over:
            what = f"it came no nearer to its goal for {self._limit.seconds:g} s"
            return f"{what}, with {_times(vain)}" if vain else what
        return None


def _times(recoveries: int) -> str:
    return "1 recovery" if recoveries == 1 else f"{recoveries} recoveries"
