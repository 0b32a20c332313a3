"""The pace of the current drive: metres driven, by odometry, for the metres of its way that are done."""

from __future__ import annotations

from shapely.geometry import LineString, Point

from fieldhand.execution.active_mission import ActiveMission


class LegPace:
    """The pace of a mission's current drive, since it was first looked at.

    A drive that goes on after a pause or around an obstacle has a new way, on which the pace is measured anew.

    Args:
        mission: The mission.

    Attributes:
        driven_m: Metres driven.
        done_m: Metres of the way that are done.
    """

    def __init__(self, mission: ActiveMission) -> None:
        self._mission = mission
        self._way: tuple[tuple[float, float], ...] = ()
        self._begun_m = self._begun_at_m = 0.0
        self.driven_m = self.done_m = 0.0

    def look(self) -> None:
        """Update the pace; the robot is driving."""
        mission = self._mission
        at_m = LineString(mission.driven).project(Point(mission.observation.position.xy))
        metres = mission.spent.metres
        if self._way is not mission.driven:
            self._way, self._begun_m, self._begun_at_m = mission.driven, metres, at_m
        self.driven_m = max(0.0, metres - self._begun_m)
        self.done_m = max(0.0, at_m - self._begun_at_m)
