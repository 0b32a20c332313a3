"""Simulated robot: drives at random cost, drains its battery, and reads what the world file defines."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from fieldhand.clock import Clock
from fieldhand.execution.drivers.protocol import (
    NEAR_M,
    ActionGoal,
    DriveGoal,
    GoalFault,
    GoalState,
    Position,
    Progress,
    StretchWork,
)
from fieldhand.execution.drivers.simulation.goal_course import EPSILON_S, GoalCourse, until_near_end
from fieldhand.execution.drivers.simulation.ground_truth import GroundTruth, Hindrance, Point
from fieldhand.execution.drivers.simulation.position_error import PositionError, apart
from fieldhand.execution.drivers.simulation.state import SimulationState
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.forecast.headings import turn_s
from fieldhand.forecast.visit_order import drives_for, start_place
from fieldhand.language import message
from fieldhand.robot.charging import DOCK, UNDOCK
from fieldhand.robot.model import RobotProfile
from fieldhand.site.bearings import apart_deg, first_heading, last_heading
from fieldhand.site.model import Place, Site
from fieldhand.site.working.stretch import total_m

#: Interval in seconds at which a robot that leaves its way is to be looked at.
_REPORTED_S = 0.5


class SimulatedDriver:
    """A :class:`~fieldhand.execution.drivers.protocol.Driver` in simulated time.

    A leg of ``d`` metres costs ``d * (alpha + Exp(1 - alpha))`` metres of driving
    (:class:`~fieldhand.robot.model.LegCost`) at the robot's speed; the battery drains by the profile's consumption per
    metre, second and action.

    Args:
        site, robot: Site and robot of the mission. The robot begins at the site's start.
        world: Sensor readings and faults.
        clock: Mission clock; only the mission advances it.
        rng: Generator for leg costs and for readings that the world leaves open.
        yaw_tolerance_deg: Degrees short of the heading of a drive at which it stops turning.

    In a world with :class:`~fieldhand.execution.drivers.simulation.world.Localisation`, :meth:`position` is that of a
    fix, :meth:`pose` the one by which it steers, and :meth:`true_position` where it is. All that happens to it depends
    on the latter.

    Raises:
        WorldError: The world does not fit the site or the robot.
    """

    def __init__(
        self,
        site: Site,
        robot: RobotProfile,
        world: World,
        clock: Clock,
        rng: np.random.Generator,
        *,
        yaw_tolerance_deg: float = 0.0,
    ) -> None:
        self._yaw_tolerance_deg = yaw_tolerance_deg
        self._heading_deg: float | None = None
        self._site = site
        self._robot = robot
        self._clock = clock
        entropy = getattr(rng.bit_generator.seed_seq, "entropy", None)
        self._seed = entropy if isinstance(entropy, int) else None
        self._truth = GroundTruth(world, site, robot, int(rng.integers(2**63)))
        self._rng = rng
        self._begun_s = clock.now()
        self._charge = world.charge_percent
        self._meter_step = world.meter_step_percent
        self._charged_s = self._begun_s
        start = start_place(drives_for(site, robot))
        self._xy: Point = start.stand or start.xy
        self._tolerance_m = world.goal_tolerance_m
        self._error = PositionError(world.localisation, lambda: self._truth.seed)
        #: Metres east and north from where it is to where it believes to be.
        self._off: Point = (0.0, 0.0)
        self._course: GoalCourse | None = None
        self._result = Progress(state="idle")
        self._lost: list[tuple[float, str]] = []
        #: Power in watts of implements that are on without being part of a goal, by action, and since when.
        self._loads: dict[str, float] = {}
        self._loaded_s, self._load_j = self._begun_s, 0.0
        self._docked = False
        self._recovers = False

    @property
    def seed(self) -> int | None:
        return self._seed

    def start_drive(self, goal: DriveGoal) -> None:
        self._begin()
        self._docked = False
        alpha = self._robot.leg_cost.alpha if goal.work is None else 1.0  # a given path is followed exactly
        steered, length_m = self._steered(goal)
        cost = length_m * (alpha + self._rng.exponential(1.0 - alpha) if alpha < 1.0 else 1.0)
        errors = self._error.along(steered, self._off, cost)
        path = apart(steered, errors)
        length_m = length_m if path is steered else _length_m(path)
        pace = cost / goal.speed_m_s / length_m if length_m > 0 else 0.0  # seconds per metre of the path
        now_s = self._clock.now() - self._begun_s
        turns_s, heading = self._turns(goal, path)
        course = whole = GoalCourse(
            start_s=self._clock.now(),
            lasts_s=cost / goal.speed_m_s + sum(turns_s),
            outcome="succeeded",
            metres=cost,
            path=path,
            errors=errors,
            turns_s=turns_s,
            heading_deg=heading,
        )
        if goal.work is not None and goal.work.action:
            course = whole = self._with_implement(course, goal, goal.work)
        if not self.lost():
            course = whole = replace(course, strays_m=self._truth.strays_by_m(goal.place))
        if not self.lost() and (what := self._truth.drive_fails(goal.place)):
            course = replace(course.cut(0.5), what=what, fault="failed")
        if goal.work is not None and (failing := self._truth.implement_fails(goal.work, path)) is not None:
            part, what = failing
            course = replace(whole.cut(part), what=what, fault="implement") if part <= course.reach else course
        met: list[tuple[Hindrance, GoalFault]] = []
        now_s += turns_s[0]
        if (hindrance := self._truth.obstacle(path, lambda metres: now_s + pace * metres)) is not None:
            near = hindrance.recovers and length_m - hindrance.at_m <= NEAR_M
            met.append((hindrance, "occupied" if near else "blocked"))
        if (hindrance := self._truth.lost_on(path)) is not None:
            met.append((hindrance, "lost"))
        if met:
            hindrance, fault = min(met, key=lambda pair: pair[0].at_m)
            part = min(1.0, hindrance.at_m / length_m) if length_m > 0 else 0.0
            if part <= course.reach:
                course = replace(whole.cut(part), what=hindrance.what, fault=fault, meets=hindrance)
        self._set_out(course)

    def _steered(self, goal: DriveGoal) -> tuple[tuple[Point, ...], float]:
        """Return the path along which the robot believes to drive, and its length in metres.

        It is that of the goal in a world in which the robot reaches its goals exactly. Otherwise it begins where the
        robot believes to be.
        """
        if not self._tolerance_m and not self._error.exists:
            return goal.path_m, goal.length_m
        x, y = self._true_xy()
        path = ((x + self._off[0], y + self._off[1]), *goal.path_m[1:])
        path = until_near_end(path, self._tolerance_m) if self._tolerance_m else path
        return path, _length_m(path)

    def _turns(self, goal: DriveGoal, path: tuple[Point, ...]) -> tuple[tuple[float, float], float | None]:
        """Return the seconds of turning on the spot before and after a drive, and the heading at its end.

        A robot that does not turn on the spot ends along its path, or as it is wanted within a right angle of it.
        """
        first, last = first_heading(path), last_heading(path)
        here = self._heading_deg if last is None else last
        wanted = here if goal.heading_deg is None else goal.heading_deg
        if (
            self._robot.turn_deg_s is None
            and here is not None
            and wanted is not None
            and apart_deg(here, wanted) > 90.0
        ):
            wanted = here
        seconds = turn_s(self._robot, self._heading_deg, first), turn_s(self._robot, here, wanted)
        if wanted is not None and here is not None:
            left = min(apart_deg(here, wanted), self._yaw_tolerance_deg)
            wanted = (wanted - math.copysign(left, (wanted - here + 180.0) % 360.0 - 180.0)) % 360.0
        return seconds, wanted

    def _with_implement(self, course: GoalCourse, goal: DriveGoal, work: StretchWork) -> GoalCourse:
        """Return a course with the time and energy of an implement."""
        implement = self._robot.action[work.action].implement
        on_m = total_m(work.on)
        if implement is None or not on_m:
            return course
        seconds = on_m / goal.speed_m_s + implement.on_delay_s
        joules = implement.power_w * seconds
        return replace(course, lasts_s=course.lasts_s + implement.on_delay_s, action_j=joules, on=work.on)

    def start_action(self, goal: ActionGoal) -> None:
        self._begin()
        action = self._robot.doable[goal.action]
        # A lost robot makes no capture, so none is counted.
        readings, what = ({}, "") if self.lost() else self._truth.capture(goal.action, self._reached(goal.place))
        self._set_out(
            GoalCourse(
                start_s=self._clock.now(),
                lasts_s=action.duration_s,
                outcome="failed" if what else "succeeded",
                fault="failed" if what else "none",
                action_j=action.energy_j,
                readings=readings,
                what=what,
                docks={DOCK: True, UNDOCK: False}.get(goal.action) if not what else None,
            )
        )

    def _reached(self, place: Place) -> Place:
        """Return the place at which a capture is made by a robot that believes to make it at another."""
        if self._off == (0.0, 0.0) or place.kind != "tree":
            return place
        xy = place.x - self._off[0], place.y - self._off[1]
        away = np.hypot(*(self._site.xy - xy).T)
        if away.min() <= self._site.spacing_m:
            return self._site.trees[int(away.argmin())].place
        ((lat, lon),) = self._site.projection.lat_lon([xy])
        return Place.of_robot(xy, lat=lat, lon=lon)

    def switch(self, action: str, *, on: bool) -> str:
        """Switch an implement outside of a goal, as an external client does; return why that failed, or an empty text.

        Its power drains the battery until it is switched off.
        """
        why = self._truth.switch_fails(action, Place.of_robot(self._xy, lat=0.0, lon=0.0)) if on else ""
        self._load_j, self._loaded_s = self._loaded_j(), self._clock.now()
        self._loads.pop(action, None)
        implement = self._robot.action[action].implement
        if on and not why and implement is not None:
            self._loads[action] = implement.power_w
        return why

    def _loaded_j(self) -> float:
        """Return the energy in joules that implements outside of goals have used since the last goal began."""
        return self._load_j + sum(self._loads.values()) * (self._clock.now() - self._loaded_s)

    def read_sensors(self, action: str, place: Place) -> Mapping[str, float]:
        """Return the readings of an action's sensors at a place without a capture; empty if they fail.

        Faults that occur a limited number of times are not used up away from trees, where usually no client listens.
        """
        readings, _ = self._truth.capture(action, place, counted=place.kind == "tree")
        return readings

    def events(self) -> Mapping[str, float | None]:
        return self._truth.events.values(self._clock.now() - self._begun_s)

    def poll(self) -> Progress:
        self._truth.events.note(self._clock.now() - self._begun_s, self._true_xy)
        course = self._course
        if course is None:
            return self._result
        done = course.done_at(self._clock.now())
        stopped = self.stopped()
        if stopped is not None and done < 1.0:
            return self._finish(course, "cancelled", done, stopped)
        if done < 1.0:
            return Progress(state="running", metres=course.moved(done) * course.metres, seconds=done * course.lasts_s)
        if course.meets is not None:
            self._truth.met(course.meets)
            self._recovers = course.meets.recovers
            if course.fault == "lost":
                self._lost.append((self._clock.now() - self._begun_s + course.meets.for_s, course.meets.what))
        return self._finish(course, course.outcome, 1.0, course.what, course.fault)

    def cancel(self) -> None:
        progress = self.poll()
        if self._course is not None and not progress.over:
            self._finish(self._course, "cancelled", self._course.done_at(self._clock.now()), "cancelled")

    def next_event_in(self) -> float | None:
        if self._course is None:
            return None
        over_s = self._course.start_s + self._course.lasts_s
        stop = self._truth.stop
        if stop is not None:
            over_s = min(over_s, self._begun_s + stop.at_s)
        if self._course.strays_m or self._course.errors:  # whoever watches looks as often as a robot reports it
            over_s = min(over_s, self._clock.now() + _REPORTED_S)
        return max(0.0, over_s - self._clock.now())

    def _true_xy(self) -> Point:
        """Return where it is, in local metres."""
        if self._course is None or not self._course.path:
            return self._xy
        return self._course.at(self._course.done_at(self._clock.now()))

    def _error_now(self) -> Point:
        course = self._course
        return self._off if course is None or not course.path else course.error(course.done_at(self._clock.now()))

    def position(self) -> Position:
        return self._placed(self._error.of_fix(self._error_now(), self._clock.now() - self._begun_s))

    def pose(self) -> Position:
        """Return the position by which it steers."""
        return self._placed(self._error_now())

    def true_position(self) -> Position:
        """Return where it is."""
        return self._placed((0.0, 0.0))

    @property
    def noise_m(self) -> float:
        """Standard deviation of each fix in metres, east and north."""
        return self._error.noise_m

    @property
    def goal_tolerance_m(self) -> float:
        """Distance in metres from its goal at which a drive ends."""
        return self._tolerance_m

    def _placed(self, error: Point) -> Position:
        x, y = self._true_xy()
        x, y = x + error[0], y + error[1]
        ((lat, lon),) = self._site.projection.lat_lon([(x, y)])
        course, heading = self._course, self._heading_deg
        if course is not None and course.path:
            facing = course.facing(course.done_at(self._clock.now()))
            heading = heading if facing is None else facing
        return Position(x=x, y=y, lat=lat, lon=lon, heading_deg=heading)

    def charge_percent(self) -> float:
        left, step = self._left(), self._meter_step
        return left if step <= 0.0 else min(100.0, step * round(left / step))

    def _left(self) -> float:
        """Return the true charge of the battery, not the meter's."""
        left = self._charge
        if self._course is not None:
            left -= self._used(self._course, self._course.done_at(self._clock.now()))
        elif self._docked and (charging := self._robot.energy.charging) is not None:
            seconds = max(0.0, self._clock.now() - self._charged_s)
            return float(charging.percent_after(left, seconds, self._robot.energy.capacity_j))
        else:
            idle = self._robot.percent(0.0, self._clock.now() - self._charged_s)
            left -= self._drained(idle, self._charged_s, self._clock.now())
        return max(0.0, left - self._robot.percent(0.0, 0.0, self._loaded_j()))

    def lost(self) -> str | None:
        now_s = self._clock.now() - self._begun_s
        if any(begins <= now_s + EPSILON_S and now_s < ends - EPSILON_S for begins, ends in self._truth.lost_spans):
            return "no position"
        return next((what for until_s, what in self._lost if now_s < until_s - EPSILON_S), None)

    def stopped(self) -> str | None:
        stop = self._truth.stop
        if stop is not None and self._clock.now() - self._begun_s >= stop.at_s - EPSILON_S:
            return stop.why
        return None

    def state(self) -> SimulationState:
        """Return the state from which a new driver continues; a running goal is dropped."""
        here, (east, north) = self.true_position(), self._error_now()
        captures, struck = self._truth.counts()
        return SimulationState(
            seconds=self._clock.now() - self._begun_s,
            x=here.x,
            y=here.y,
            charge_percent=self._left(),
            generator=self._rng.bit_generator.state,
            values_seed=self._truth.seed,
            captures=captures,
            struck=struck,
            lost=tuple(self._lost),
            met=self._truth.events.met,
            docked=self._docked,
            heading_deg=here.heading_deg,
            off_east_m=east,
            off_north_m=north,
        )

    def restore(self, state: SimulationState) -> None:
        """Continue from the state of a robot with the same site, profile and world.

        Raises:
            ValueError: The state of its random generator is invalid.
        """
        try:
            self._rng.bit_generator.state = state.generator
        except (TypeError, ValueError, KeyError, AttributeError, OverflowError) as error:
            raise ValueError(f"no state of a random generator: {error}") from error
        self._begun_s = self._clock.now() - state.seconds
        self._charge, self._charged_s = state.charge_percent, self._clock.now()
        self._xy, self._course, self._result = (state.x, state.y), None, Progress(state="idle")
        self._off = state.off_east_m, state.off_north_m
        self._lost, self._docked, self._heading_deg = list(state.lost), state.docked, state.heading_deg
        self._truth.restore(state.values_seed, state.captures, state.struck)
        self._truth.events.restore(state.met)

    @property
    def recovers(self) -> bool:
        """True if the last drive ended before an obstacle at which the robot's navigation recovers for ever."""
        return self._recovers

    def tree_of(self, fault: int) -> Place:
        """Return the tree that a fault of the world names."""
        return self._truth.tree_of(fault)

    def _begin(self) -> None:
        if not self.poll().over:
            raise RuntimeError("a goal is running: a driver has one at a time")
        self._recovers = False
        self._charge, self._charged_s = self._left(), self._clock.now()
        self._load_j, self._loaded_s = 0.0, self._clock.now()

    def _set_out(self, course: GoalCourse) -> None:
        """Start a course, shortened if the robot gets lost or its battery runs empty."""
        begins_s = course.start_s - self._begun_s
        lost_s = [
            at - begins_s for at, ends in self._truth.lost_spans if at < begins_s + course.lasts_s and begins_s < ends
        ]
        if (why := self.lost()) is not None:
            course = replace(course.cut(0.0), what=why, fault="lost")
        elif lost_s:
            part = course.moved(max(0.0, min(lost_s)) / course.lasts_s)
            course = replace(course.cut(part), what=message("no position", context="log"), fault="lost")
        if self._used(course, 1.0) > self._charge:
            part = course.moved(self._lasting(course))
            course = replace(course.cut(part), what=message("the battery is empty", context="log"), fault="empty")
        self._course = course

    def _lasting(self, course: GoalCourse) -> float:
        """Return the fraction of a course for which the battery lasts, 0 to 1."""
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = (low + high) / 2.0
            low, high = (middle, high) if self._used(course, middle) <= self._charge else (low, middle)
        return low

    def _finish(
        self, course: GoalCourse, state: GoalState, done: float, what: str, fault: GoalFault = "none"
    ) -> Progress:
        self._charge = max(0.0, self._charge - self._used(course, done))
        self._charged_s = course.start_s + done * course.lasts_s
        if course.path:
            self._xy, self._off = course.at(done), course.error(done)
            facing = course.facing(done)
            self._heading_deg = self._heading_deg if facing is None else facing
        if course.docks is not None and state == "succeeded":
            self._docked = course.docks
        self._course = None
        self._result = Progress(
            state=state,
            metres=course.moved(done) * course.metres,
            seconds=done * course.lasts_s,
            readings=course.readings if state == "succeeded" else {},
            what=what,
            fault=fault,
        )
        return self._result

    def _used(self, course: GoalCourse, done: float) -> float:
        """Return the battery consumption in percent of a fraction of a course."""
        used = self._robot.percent(course.moved(done) * course.metres, done * course.lasts_s, course.joules(done))
        return self._drained(used, course.start_s, course.start_s + done * course.lasts_s)

    def _drained(self, percent: float, from_s: float, to_s: float) -> float:
        """Return the battery's loss between two times for which its model gives ``percent``."""
        return percent * self._truth.drain(from_s - self._begun_s, to_s - self._begun_s)


def _length_m(path: tuple[Point, ...]) -> float:
    return sum(math.dist(a, b) for a, b in itertools.pairwise(path))
