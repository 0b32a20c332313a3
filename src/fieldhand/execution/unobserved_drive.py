"""Metres that a robot drove on while the program that observes it was dead.

Navigation finishes the goal that it has, though nobody listens. What it drove is found afterwards from the robot's own
odometer, which measured it; without one it is estimated from the last known position and the present one, along the
path of the goal if both are on it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, get_args

from fieldhand.execution.drivers.protocol import AT_M, DriveGoal, Position
from fieldhand.site.working.stretch import Stretch
from fieldhand.task.results import UnobservedBy

if TYPE_CHECKING:
    from fieldhand.execution.journal.records import Observation

#: Metres from the path of a goal beyond which the robot is not on it.
_OFF_M = 2.0
#: Metres below which two positions are the same.
_SEEN_M = 0.05
#: Bounds of what an odometer can have counted, as multiples of the straight line and of the distance at the goal's
#: speed: beyond them it was reset, or it counted what somebody else drove.
_LEAST, _MOST = 0.4, 3.0


@dataclass(frozen=True, kw_only=True)
class UnobservedDrive:
    """A drive that nobody observed: its metres, the seconds that they took, and how they are known."""

    metres: float = 0.0
    seconds: float = 0.0
    by: UnobservedBy = ""

    @property
    def is_seen(self) -> bool:
        """True if it is more than the positions are uncertain."""
        return self.metres > _SEEN_M


def drive_since(
    last: Observation, goal: DriveGoal, now: Position, odometer_m: float | None, *, within_s: float
) -> UnobservedDrive:
    """Return what the robot drove since the last look at it.

    Args:
        last: The last observation of the goal, or the one before it started.
        goal: The drive that was under way.
        now: Position of the robot, which stands.
        odometer_m: Present reading of its odometer; None if it has none.
        within_s: Seconds that have passed; infinite if unknown.
    """
    straight_m = math.dist(last.position.xy, now.xy)
    metres, by = _along_path(goal, last.position, now, straight_m)
    counted_m = None if odometer_m is None or last.odometer_m is None else odometer_m - last.odometer_m
    least_m, most_m = _LEAST * straight_m - AT_M, _MOST * goal.speed_m_s * within_s + AT_M
    if counted_m is not None and max(0.0, least_m) <= counted_m <= most_m:
        metres, by = counted_m, "odometer"
    if metres <= _SEEN_M:
        return UnobservedDrive()
    return UnobservedDrive(metres=metres, seconds=min(metres / goal.speed_m_s, within_s), by=by)


def _along_path(goal: DriveGoal, before: Position, now: Position, straight_m: float) -> tuple[float, UnobservedBy]:
    """Return the distance between two positions along the path of a goal, or straight on if they are not on it."""
    path = Stretch(name="", points=goal.path_m, on=())
    if max(path.away_m(before.xy), path.away_m(now.xy)) > _OFF_M:
        return straight_m, "line"
    from_m = path.project(before.xy)
    return max(straight_m, path.project(now.xy, after_m=from_m) - from_m), "path"


def unobserved_of(metres: float, seconds: float, by: str) -> UnobservedDrive:
    """Return what a journal has recorded.

    Raises:
        ValueError: It is no such record.
    """
    if by not in get_args(UnobservedBy):
        raise ValueError(f"{by!r} is no source of a distance")
    known: UnobservedBy = next(name for name in get_args(UnobservedBy) if name == by)
    return UnobservedDrive(metres=float(metres), seconds=float(seconds), by=known)
