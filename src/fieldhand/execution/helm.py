"""Goals that outlast a pause and a power cut: between the mission, which knows of neither, and the driver.

A drive that was cut short is gone on with from where the robot then stands. A capture is never cut short by a pause:
the robot waits when it is made. One that the power cut off is in doubt, and what the profile says is done.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable

from fieldhand.errors import FieldhandError, OutputError
from fieldhand.execution.drivers.protocol import ActionGoal, DriveGoal, Driver, Position, Progress
from fieldhand.robot.model import InDoubtPolicy, RobotProfile
from fieldhand.site.drives import Drives
from fieldhand.site.model import Place, Site

#: Metres within which the robot is where it was.
AT_M = 0.5


class Helm:
    """A :class:`~fieldhand.execution.drivers.protocol.Driver` on top of another.

    Args:
        driver: Who moves the robot.
        site, robot: Of the mission.
        ways: Gives the ways that are left now.
        set_out: Told of each drive that begins in place of one that was cut short.
        doubt: Told of each capture that is in doubt, and what is done about it.

    Attributes:
        held: Nothing new begins, and no wheel turns.
    """

    def __init__(
        self,
        driver: Driver,
        site: Site,
        robot: RobotProfile,
        *,
        ways: Callable[[], Drives],
        set_out: Callable[[DriveGoal], None],
        doubt: Callable[[ActionGoal, InDoubtPolicy, Progress], None],
    ) -> None:
        self.held = False
        self._driver, self._site, self._robot, self._ways = driver, site, robot, ways
        self._set_out, self._doubt = set_out, doubt
        self._goal: DriveGoal | ActionGoal | None = None
        self._under_way = False
        self._approaching = False
        self._strayed = False
        self._broken_off = False
        self._cancelled = False
        self._before = Progress(state="idle")
        self._result: Progress | None = None

    # --- pause ---------------------------------------------------------------------------------------------------

    def hold(self) -> None:
        """Let the robot stand still as soon as it can: a drive is broken off, a capture is finished."""
        self.held = True
        if self._under_way and (self._approaching or isinstance(self._goal, DriveGoal)):
            self._broken_off = True
            self._driver.cancel()

    def go_on(self) -> None:
        """The pause is over."""
        self.held = False

    def at_rest(self) -> bool:
        """Whether the robot stands still for as long as it is held."""
        return self.held and (self.poll().over or not self._under_way)

    # --- a driver ------------------------------------------------------------------------------------------------

    @property
    def seed(self) -> int | None:
        return self._driver.seed

    def start_drive(self, goal: DriveGoal) -> None:
        self._take(goal)

    def start_action(self, goal: ActionGoal) -> None:
        self._take(goal)

    def poll(self) -> Progress:
        while self._result is None and self._goal is not None:
            if not self._under_way:
                if self._cancelled:
                    self._end(Progress(state="cancelled", what="cancelled"))
                    continue
                if self.held:
                    return dataclasses.replace(self._before, state="running")
                self._begin()
                continue
            progress = self._driver.poll()
            if not progress.over:
                return self._sum(progress)
            self._under_way = False
            self._conclude(self._goal, progress)
        return self._result or Progress(state="idle")

    def cancel(self) -> None:
        self._cancelled = True
        if self._under_way:
            self._driver.cancel()

    def next_event_in(self) -> float | None:
        return self._driver.next_event_in()

    def position(self) -> Position:
        return self._driver.position()

    def charge_percent(self) -> float:
        return self._driver.charge_percent()

    def stopped(self) -> str | None:
        return self._driver.stopped()

    def lost(self) -> str | None:
        return self._driver.lost()

    # --- a goal --------------------------------------------------------------------------------------------------

    def _take(self, goal: DriveGoal | ActionGoal) -> None:
        self._goal, self._result, self._before = goal, None, Progress(state="running")
        self._under_way = self._cancelled = False
        if not self.held:
            self._begin()

    def _begin(self) -> None:
        """Let the driver begin the goal, or what is left of it."""
        goal = self._goal
        self._broken_off = self._approaching = False
        try:
            if isinstance(goal, DriveGoal):
                self._drive(goal if self._is_at(goal.path_m[0]) else self._way_to(goal.place, goal.speed_m_s), goal)
            elif goal is not None:
                self._strayed = self._strayed and not self._is_at(goal.place.stand or goal.place.xy)
                self._approaching = self._strayed
                if self._strayed:
                    self._drive(self._way_to(goal.place, self._robot.speed_m_s), goal)
                else:
                    self._driver.start_action(goal)
        except OutputError:
            raise
        except FieldhandError as error:
            self._end(Progress(state="failed", fault="failed", what=error.what))
            return
        self._under_way = True

    def _drive(self, way: DriveGoal, goal: DriveGoal | ActionGoal) -> None:
        if way is not goal:
            self._set_out(way)
        self._driver.start_drive(way)

    def _conclude(self, goal: DriveGoal | ActionGoal, progress: Progress) -> None:
        """What a goal of the driver that is over means for the one that the mission gave."""
        no_more = self._cancelled or self._driver.stopped() is not None
        cut = progress.state == "cut_off"
        if isinstance(goal, ActionGoal) and not self._approaching:
            if not cut:
                self._end(progress)
                return
            then = "skip" if no_more else self._robot.action[goal.action].in_doubt
            self._doubt(goal, then, progress)
            # Whoever mended the robot may have moved it.
            self._strayed = True
            if then == "skip":
                self._end(progress)
        elif cut or progress.state == "cancelled":
            if no_more or not (cut or self._broken_off):
                self._end(dataclasses.replace(progress, state="cancelled"))
            else:
                self._before = self._sum(progress)
        elif self._approaching and progress.state == "succeeded":
            self._strayed, self._before = False, self._sum(progress)
        else:
            self._end(progress)

    def _end(self, progress: Progress) -> None:
        self._result = dataclasses.replace(self._sum(progress), state=progress.state)

    def _sum(self, progress: Progress) -> Progress:
        """With what was done of the goal before it was cut short."""
        return dataclasses.replace(
            progress,
            state="running",
            metres=self._before.metres + progress.metres,
            seconds=self._before.seconds + progress.seconds,
        )

    def _is_at(self, xy: tuple[float, float]) -> bool:
        at = self._driver.position()
        return math.dist((at.x, at.y), xy) <= AT_M

    def _way_to(self, place: Place, speed_m_s: float) -> DriveGoal:
        """The drive from where the robot is.

        Raises:
            DriveFault: There is no way.
        """
        at = self._driver.position()
        here = Place(kind="point", id="on the way", x=at.x, y=at.y, lat=at.lat, lon=at.lon, stand=(at.x, at.y))
        drive = self._ways().between(here, place)
        corners = tuple((float(x), float(y)) for x, y in drive.points)
        degrees = tuple((float(lat), float(lon)) for lat, lon in self._site.projection.degrees(corners))
        return DriveGoal(
            place=drive.end, path_m=corners, path_degrees=degrees, length_m=drive.length_m, speed_m_s=speed_m_s
        )
