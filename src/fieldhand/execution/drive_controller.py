"""Goals that outlast a pause and a power cut.

An interrupted drive is resumed from where the robot then stands. Where the speed limit changes on the way, the drive is
continued with another goal of the driver, so any driver obeys it. A pause never interrupts a capture: the robot stops
once it is made. A capture interrupted by a power cut is in doubt, and the profile decides what is done about it.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable

from fieldhand.errors import FieldhandError, OutputError
from fieldhand.execution.drivers.protocol import AT_M, ActionGoal, DriveGoal, Progress
from fieldhand.execution.recorded_inputs import RecordedInputs
from fieldhand.forecast.headings import NEAR_DEG, facing, way_in
from fieldhand.forecast.slow_ground import NO_SLOW_GROUND, SlowGround, rests
from fieldhand.language import message
from fieldhand.robot.camera import Camera
from fieldhand.robot.model import InDoubtPolicy, RobotProfile
from fieldhand.site.bearings import apart_deg, last_heading
from fieldhand.site.drives import Drive, Drives
from fieldhand.site.model import Place, Site
from fieldhand.site.working.stretch import Stretch

#: Metres from the path of a stretch beyond which the robot is not on it.
_OFF_M = 1.5
#: Odometry may fall short of the path by this factor.
_ODOMETRY = 1.2


class DriveController:
    """Carries out one goal of a mission at a time, in as many driver goals as needed.

    Args:
        inputs: Starts goals of the driver and observes the robot.
        site, robot: Site and robot of the mission.
        ways: Returns the drives that are possible now.
        speed: Returns the speed limit of a drive that begins now, in m/s.
        on_restart: Called before a drive continues an interrupted one.
        on_doubt: Called for each capture in doubt with the chosen policy and its progress.
        slow: Ground on which the robot drives slowly.
        on_strayed: Called with the metres by which the robot has left the way of a drive, before it is stopped.

    Attributes:
        paused: True while nothing new begins and the robot stands still.
        limit_m_s: Highest speed at the moment, whatever the goals say; infinite without a limit.
        reached_m: Distance along the path of the current or last stretch up to which it was driven.
    """

    def __init__(
        self,
        inputs: RecordedInputs,
        site: Site,
        robot: RobotProfile,
        *,
        ways: Callable[[], Drives],
        speed: Callable[[], float],
        on_restart: Callable[[DriveGoal], None],
        on_doubt: Callable[[ActionGoal, InDoubtPolicy, Progress], None],
        slow: SlowGround = NO_SLOW_GROUND,
        on_strayed: Callable[[float], None] = lambda _: None,
    ) -> None:
        self.paused = False
        self._inputs, self._site, self._robot, self._ways, self._speed = inputs, site, robot, ways, speed
        self._on_restart, self._on_doubt, self._on_strayed = on_restart, on_doubt, on_strayed
        #: Metres by which the robot has left the way of the part under way; None while it is on it.
        self._off_way_m: float | None = None
        self._slow, self.limit_m_s = slow, math.inf
        #: The part of a drive that is under way without the limit of the moment, and what follows it.
        self._part: DriveGoal | None = None
        self._rest: DriveGoal | None = None
        self._goal: DriveGoal | ActionGoal | None = None
        self._under_way = False
        self._approaching = False
        self._strayed = False
        self._broken_off = False
        self._cancelled = False
        self._before = Progress(state="idle")
        self._result: Progress | None = None
        self.reached_m = 0.0
        self._part_from_m = 0.0
        #: Heading at which the last drive ended, as it was commanded; None if it is unknown.
        self._heading_deg: float | None = None

    def start(self, goal: DriveGoal | ActionGoal) -> None:
        """Begin a goal, after the pause if the mission is paused."""
        self._goal, self._result, self._before = goal, None, Progress(state="running")
        self._under_way = self._cancelled = False
        self.reached_m, self._rest = 0.0, None
        if not self.paused:
            self._begin()

    def poll(self) -> Progress:
        """Return the combined progress of all parts of the goal; ``idle`` before the first."""
        while self._result is None and self._goal is not None:
            if not self._under_way:
                if self._cancelled:
                    self._end(Progress(state="cancelled", what="cancelled"))
                    continue
                if self.paused:
                    return dataclasses.replace(self._before, state="running")
                self._begin()
                continue
            progress = self._inputs.observation.progress
            if not progress.over:
                self._track(progress)
                self._keep_to_way()
                return self._sum(progress)
            self._under_way = False
            self._conclude(self._goal, self._judged(progress))
        return self._result or Progress(state="idle")

    def cancel(self) -> None:
        """Request cancellation of the goal; :meth:`poll` reports its end."""
        self._cancelled = True
        if self._under_way:
            self._inputs.cancel()

    def limit(self, speed_m_s: float) -> None:
        """Drive no faster than this from now on; a drive under way that this changes is continued at the new speed."""
        before, self.limit_m_s = self.limit_m_s, speed_m_s
        if not self._under_way or self._part is None or self._broken_off or self._cancelled:
            return
        full = self._part.speed_m_s
        if min(full, before) != min(full, speed_m_s) and not self._inputs.observation.progress.over:
            self._broken_off = True
            self._inputs.cancel()

    def first_speed_m_s(self, goal: DriveGoal) -> float:
        """Return the speed with which a drive begins."""
        return min(self._first_part(goal)[0].speed_m_s, self.limit_m_s)

    # --- pause ---------------------------------------------------------------------------------------------------

    def pause(self) -> None:
        """Stop the robot as soon as possible: cancel a drive, finish a capture."""
        self.paused = True
        if self._under_way and (self._approaching or isinstance(self._goal, DriveGoal)):
            self._broken_off = True
            self._inputs.cancel()

    def unpause(self) -> None:
        """End the pause."""
        self.paused = False

    def at_rest(self) -> bool:
        """Return True if the robot stands still until the pause ends."""
        return self.paused and (self.poll().over or not self._under_way)

    # --- goals ---------------------------------------------------------------------------------------------------

    def _begin(self) -> None:
        """Start the goal, or what is left of it."""
        goal, rest = self._goal, self._rest
        self._broken_off, self._part, self._rest, self._off_way_m = False, None, None, None
        works = isinstance(goal, DriveGoal) and goal.work is not None
        try:
            if (
                rest is not None
                and goal is not None
                and (self._approaching or not works)
                and self._is_at(rest.path_m[0])
            ):
                self._drive(rest, goal)
                self._under_way = True
                return
            self._approaching = False
            if isinstance(goal, DriveGoal) and goal.work is not None:
                self._begin_stretch(goal)
            elif isinstance(goal, DriveGoal):
                begins_here = self._is_at(goal.path_m[0])
                self._drive(goal if begins_here else self._way_to(goal.place, goal.speed_m_s, goal.faces), goal)
            elif goal is not None:
                self._strayed = self._strayed and not self._inputs.observation.position.is_at(goal.place)
                camera = self._robot.doable[goal.action].camera
                turn = None if self._strayed else self._turn_for(goal.place, camera)
                self._approaching = self._strayed or turn is not None
                if self._strayed:
                    self._drive(self._way_to(goal.place, self._speed(), camera), goal)
                elif turn is not None:
                    self._drive(turn, goal, silent=True)
                else:
                    self._inputs.start(goal)
        except OutputError:
            raise
        except FieldhandError as error:
            self._end(Progress(state="failed", fault="failed", what=error.what))
            return
        self._under_way = True

    def _turn_for(self, place: Place, camera: Camera | None) -> DriveGoal | None:
        """Return the turn on the spot that a camera needs at a place; None if the robot has the heading already."""
        if camera is None or self._robot.turn_deg_s is None:
            return None
        faces = facing(self._ways(), self._robot, place, camera, self._heading_deg)
        if faces.sees is None or faces.heading_deg is None:
            return None
        if self._heading_deg is not None and apart_deg(self._heading_deg, faces.heading_deg) <= NEAR_DEG:
            return None
        here = place.stand or place.xy
        (degrees,) = self._site.projection.lat_lon([here])
        return DriveGoal(
            place=place,
            path_m=(here, here),
            path_degrees=(degrees, degrees),
            length_m=0.0,
            speed_m_s=self._speed(),
            heading_deg=faces.heading_deg,
            faces=camera,
        )

    def _drive(self, way: DriveGoal, goal: DriveGoal | ActionGoal, *, silent: bool = False) -> None:
        """Start a way, or its first part if the speed changes on it."""
        self._heading_deg = None
        part, self._rest = self._first_part(way)
        self._part, speed = part, min(part.speed_m_s, self.limit_m_s)
        if way is not goal and not silent:
            self._on_restart(dataclasses.replace(way, speed_m_s=speed))
        self._inputs.start(dataclasses.replace(part, speed_m_s=speed) if speed != part.speed_m_s else part)

    def _first_part(self, way: DriveGoal) -> tuple[DriveGoal, DriveGoal | None]:
        """Return the part of a way up to where slow ground changes the speed, and the rest."""
        parts = self._slow.pieces(way.path_m, way.length_m, way.speed_m_s) if self._slow else ()
        if len(parts) < 2:
            return (dataclasses.replace(way, speed_m_s=parts[0].speed_m_s) if parts else way), None
        return cut_way(self._site, way, parts[0].to_m, parts[0].speed_m_s)

    def _keep_to_way(self) -> None:
        """Stop a drive that has left its way by more than the profile allows."""
        corridor_m, part, seen = self._robot.corridor_m, self._part, self._inputs.observation
        stops = self._off_way_m is not None or self._cancelled or self._broken_off
        if corridor_m is None or part is None or stops or seen.lost is not None:
            return
        away_m = Stretch(name="", points=part.path_m, on=()).away_m(seen.position.xy)
        if away_m > corridor_m:
            self._off_way_m = away_m
            self._on_strayed(away_m)
            self._inputs.cancel()

    def _judged(self, progress: Progress) -> Progress:
        """Return the end of a driver goal; a drive that was stopped because it left its way has failed."""
        if self._off_way_m is None or progress.state != "cancelled" or self._cancelled or self._broken_off:
            return progress
        if self._inputs.observation.stopped is not None:
            return progress
        what = message("left the approved way by {metres} m", context="log", metres=f"{self._off_way_m:.1f}")
        return dataclasses.replace(progress, state="failed", fault="failed", what=what)

    def _is_at(self, xy: tuple[float, float]) -> bool:
        return math.dist(self._inputs.observation.position.xy, xy) <= AT_M

    def _conclude(self, goal: DriveGoal | ActionGoal, progress: Progress) -> None:
        """Conclude the mission's goal, or prepare its next part, after a driver goal has ended."""
        part = self._part
        if progress.state == "succeeded" and part is not None:
            self._heading_deg = last_heading(part.path_m) if part.heading_deg is None else part.heading_deg
        no_more = self._cancelled or self._inputs.observation.stopped is not None
        cut = progress.state == "cut_off"
        if progress.state != "succeeded":
            self._rest = None
        if not cut or self._harmful(goal):
            self._track(progress)
        if self._rest is not None and no_more:
            self._end(dataclasses.replace(progress, state="cancelled"))
        elif self._rest is not None:
            self._before = self._sum(progress)
        elif isinstance(goal, ActionGoal) and not self._approaching:
            if not cut:
                self._end(progress)
                return
            then = "skip" if no_more else self._robot.doable[goal.action].in_doubt
            self._on_doubt(goal, then, progress)
            # The robot may have been moved during a repair.
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

    # --- stretches -------------------------------------------------------------------------------------------------

    def _begin_stretch(self, goal: DriveGoal) -> None:
        """Start what is left of a stretch, after a drive to where it begins if the robot is elsewhere."""
        rest = rest_of(self._site, goal, self.reached_m)
        begins_here = self._is_at(rest.path_m[0])
        self._approaching = not begins_here
        if begins_here:
            self._part_from_m = self.reached_m
            self._drive(rest, rest if self.reached_m == 0.0 else goal)
            return
        (degrees,) = self._site.projection.lat_lon([rest.path_m[0]])
        begin = Place.of_robot(rest.path_m[0], lat=degrees[0], lon=degrees[1], name=goal.place.id)
        self._drive(self._way_to(begin, self._robot.speed_m_s), goal)

    def _harmful(self, goal: DriveGoal | ActionGoal) -> bool:
        """Return True if no part of a stretch may be worked twice, so that a power cut leaves none to be repeated."""
        work = goal.work if isinstance(goal, DriveGoal) else None
        return work is not None and bool(work.action) and self._robot.action[work.action].in_doubt == "skip"

    def _track(self, progress: Progress) -> None:
        """Record how far the robot has come along a stretch."""
        goal = self._goal
        if not isinstance(goal, DriveGoal) or goal.work is None or self._approaching:
            return
        if progress.state == "succeeded":
            worked_m = goal.length_m if self._rest is None or self._part is None else self._part.length_m
            self.reached_m = min(goal.length_m, self._part_from_m + worked_m)
            return
        path, at = Stretch(name="", points=goal.path_m, on=()), self._inputs.observation.position.xy
        if path.away_m(at) > _OFF_M:
            return
        # A path may come back to where it began: the robot is no farther along than it has driven.
        farthest_m = self._part_from_m + _ODOMETRY * progress.metres + AT_M
        self.reached_m = path.project(at, after_m=self.reached_m, before_m=farthest_m)

    def _end(self, progress: Progress) -> None:
        self._result = dataclasses.replace(self._sum(progress), state=progress.state)

    def _sum(self, progress: Progress) -> Progress:
        """Add the interrupted parts of the goal."""
        return dataclasses.replace(
            progress,
            state="running",
            metres=self._before.metres + progress.metres,
            seconds=self._before.seconds + progress.seconds,
        )

    def _way_to(self, place: Place, speed_m_s: float, camera: Camera | None = None) -> DriveGoal:
        """Return the drive to a place from where the robot is, for a picture of a camera if one is given.

        Raises:
            DriveFault: There is no way.
        """
        here = self._inputs.observation.position.as_place()
        ways = self._ways()
        return drive_goal(ways, self._robot, way_in(ways, self._robot, here, place, camera), speed_m_s, camera)


def rest_of(site: Site, goal: DriveGoal, from_m: float) -> DriveGoal:
    """Return what is left of the goal of a stretch from a distance along it."""
    work = goal.work
    if work is None or from_m <= 0.0:
        return goal
    rest = Stretch(name=goal.place.id, points=goal.path_m, on=work.on).part(from_m, goal.length_m)
    if rest is None:
        rest = Stretch(name=goal.place.id, points=(goal.path_m[-1], goal.path_m[-1]), on=())
    return dataclasses.replace(
        goal,
        path_m=rest.points,
        path_degrees=site.projection.lat_lon(rest.points),
        length_m=rest.length_m,
        work=dataclasses.replace(work, on=rest.on),
    )


def cut_way(site: Site, way: DriveGoal, at_m: float, speed_m_s: float) -> tuple[DriveGoal, DriveGoal]:
    """Return the part of a way up to a distance along it, with a speed of its own, and the rest."""
    whole = Stretch(name=way.place.id, points=way.path_m, on=() if way.work is None else way.work.on)
    first = whole.part(0.0, at_m)
    rest = rests(way.path_m, at_m)
    if first is None:  # pragma: no cover  pieces are longer
        return way, way
    degrees = site.projection.lat_lon(first.points)
    lat, lon = degrees[-1]
    return (
        dataclasses.replace(
            way,
            place=Place.of_robot(first.points[-1], lat=lat, lon=lon, name=way.place.id),
            path_m=first.points,
            path_degrees=degrees,
            length_m=first.length_m,
            speed_m_s=speed_m_s,
            work=None if way.work is None else dataclasses.replace(way.work, on=first.on),
            heading_deg=None,
            faces=None,
        ),
        dataclasses.replace(
            way, path_m=rest, path_degrees=site.projection.lat_lon(rest), length_m=max(0.0, way.length_m - at_m)
        ),
    )


def drive_goal(
    drives: Drives, robot: RobotProfile, drive: Drive, speed_m_s: float, camera: Camera | None = None
) -> DriveGoal:
    """Return the goal of a drive, at whose end the robot stands along the aisle, or so that a camera sees the plant."""
    corners = tuple((float(x), float(y)) for x, y in drive.points)
    faces = facing(drives, robot, drive.end, camera, drives.heading_after(drive))
    return DriveGoal(
        place=drive.end,
        path_m=corners,
        path_degrees=drives.site.projection.lat_lon(corners),
        length_m=drive.length_m,
        speed_m_s=speed_m_s,
        heading_deg=faces.heading_deg,
        faces=camera if faces.sees else None,
    )
