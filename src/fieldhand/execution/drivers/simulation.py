"""The simulated robot: it drives at random cost, empties its battery, and finds what the world file says."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from fieldhand.clock import Clock
from fieldhand.execution.drivers.groundtruth import GroundTruth, Point
from fieldhand.execution.drivers.protocol import ActionGoal, DriveGoal, GoalState, Position, Progress
from fieldhand.execution.world import World
from fieldhand.forecast.routes import beginning, drives_for
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

#: Seconds within which two moments are one: clocks add floating-point numbers.
EPSILON_S = 1e-6


@dataclass(frozen=True, kw_only=True)
class _Course:
    """How a goal will go, decided when it starts: the simulation knows the future, the mission does not.

    Attributes:
        start_s: When it started.
        lasts_s: How long it goes on, until it is done or fails.
        metres: Driven by then, by odometry.
        path: Where it leads through, in local metres; empty for an action.
        reach: How much of the path is done by then, 0 to 1.
        action_j: Energy of the action, spread evenly over the time.
    """

    start_s: float
    lasts_s: float
    outcome: GoalState
    metres: float = 0.0
    path: tuple[Point, ...] = ()
    reach: float = 1.0
    action_j: float = 0.0
    readings: Mapping[str, float] = field(default_factory=dict)
    what: str = ""

    def done_at(self, now: float) -> float:
        """The part of the course that is done, 0 to 1."""
        if now >= self.start_s + self.lasts_s - EPSILON_S:
            return 1.0
        return max(0.0, now - self.start_s) / self.lasts_s


class SimulatedDriver:
    """A :class:`~fieldhand.execution.drivers.protocol.Driver` in simulated time.

    A leg of ``d`` metres costs ``d * (alpha + Exp(1 - alpha))`` metres of driving
    (:class:`~fieldhand.robot.model.LegCost`), at the robot's speed, and the battery empties by what the profile says
    of metres, seconds and actions.

    Args:
        site, robot: What the mission runs on. The robot begins at the site's start.
        world: What sensors read, and what goes wrong.
        clock: The mission's clock; only the mission advances it.
        rng: Of the cost of legs, and of readings that the world leaves open.

    Raises:
        WorldError: The world does not fit the site or the robot.
    """

    def __init__(self, site: Site, robot: RobotProfile, world: World, clock: Clock, rng: np.random.Generator) -> None:
        self._site = site
        self._robot = robot
        self._clock = clock
        entropy = getattr(rng.bit_generator.seed_seq, "entropy", None)
        self._seed = entropy if isinstance(entropy, int) else None
        self._truth = GroundTruth(world, site, robot, int(rng.integers(2**63)))
        self._rng = rng
        self._begun_s = clock.now()
        self._charge = world.charge_percent
        self._charged_s = self._begun_s
        start = beginning(drives_for(site, robot))
        self._xy: Point = start.stand or start.xy
        self._course: _Course | None = None
        self._result = Progress(state="idle")

    @property
    def seed(self) -> int | None:
        return self._seed

    def start_drive(self, goal: DriveGoal) -> None:
        self._begin()
        alpha = self._robot.leg_cost.alpha
        cost = goal.length_m * (alpha + self._rng.exponential(1.0 - alpha) if alpha < 1.0 else 1.0)
        outcome: GoalState = "succeeded"
        reach, what = 1.0, ""
        hindrance = self._truth.obstacle(goal.path_m)
        if hindrance is not None:
            at, what = hindrance
            outcome, reach = "failed", min(1.0, at / goal.length_m) if goal.length_m > 0 else 0.0
        self._set_out(
            _Course(
                start_s=self._clock.now(),
                lasts_s=reach * cost / goal.speed_m_s,
                outcome=outcome,
                metres=reach * cost,
                path=goal.path_m,
                reach=reach,
                what=what,
            )
        )

    def start_action(self, goal: ActionGoal) -> None:
        self._begin()
        action = self._robot.action[goal.action]
        readings, what = self._truth.capture(goal.action, goal.place)
        self._set_out(
            _Course(
                start_s=self._clock.now(),
                lasts_s=action.duration_s,
                outcome="failed" if what else "succeeded",
                action_j=action.energy_j,
                readings=readings,
                what=what,
            )
        )

    def poll(self) -> Progress:
        course = self._course
        if course is None:
            return self._result
        done = course.done_at(self._clock.now())
        stopped = self.stopped()
        if stopped is not None and done < 1.0:
            return self._finish(course, "cancelled", done, stopped)
        if done < 1.0:
            return Progress(state="running", metres=done * course.metres, seconds=done * course.lasts_s)
        return self._finish(course, course.outcome, 1.0, course.what)

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
        return max(0.0, over_s - self._clock.now())

    def position(self) -> Position:
        x, y = self._xy
        if self._course is not None and self._course.path:
            x, y = _along(self._course.path, self._course.reach * self._course.done_at(self._clock.now()))
        lat, lon = self._site.projection.degrees([(x, y)])[0]
        return Position(x=x, y=y, lat=float(lat), lon=float(lon))

    def charge_percent(self) -> float:
        left = self._charge
        if self._course is not None:
            left -= self._used(self._course, self._course.done_at(self._clock.now()))
        else:
            left -= self._truth.drain * self._robot.percent(0.0, self._clock.now() - self._charged_s)
        return max(0.0, left)

    def stopped(self) -> str | None:
        stop = self._truth.stop
        if stop is not None and self._clock.now() - self._begun_s >= stop.at_s - EPSILON_S:
            return stop.why
        return None

    def _begin(self) -> None:
        if not self.poll().over:
            raise RuntimeError("a goal is running: a driver has one at a time")
        self._charge, self._charged_s = self.charge_percent(), self._clock.now()

    def _set_out(self, course: _Course) -> None:
        """Begin a course; one that the battery cannot hold out fails where it is empty."""
        needs = self._used(course, 1.0)
        if needs > self._charge:
            part = self._charge / needs
            course = _Course(
                start_s=course.start_s,
                lasts_s=part * course.lasts_s,
                outcome="failed",
                metres=part * course.metres,
                path=course.path,
                reach=part * course.reach,
                action_j=part * course.action_j,
                what="the battery is empty",
            )
        self._course = course

    def _finish(self, course: _Course, state: GoalState, done: float, what: str) -> Progress:
        self._charge = max(0.0, self._charge - self._used(course, done))
        self._charged_s = course.start_s + done * course.lasts_s
        if course.path:
            self._xy = _along(course.path, course.reach * done)
        self._course = None
        self._result = Progress(
            state=state,
            metres=done * course.metres,
            seconds=done * course.lasts_s,
            readings=course.readings if state == "succeeded" else {},
            what=what,
        )
        return self._result

    def _used(self, course: _Course, done: float) -> float:
        """Percent of the battery that a part of a course takes."""
        used = self._robot.percent(done * course.metres, done * course.lasts_s, done * course.action_j)
        return self._truth.drain * used


def _along(path: tuple[Point, ...], part: float) -> Point:
    """The point at a part of a path's length, 0 to 1."""
    lengths = [math.dist(a, b) for a, b in itertools.pairwise(path)]
    left = part * sum(lengths)
    if part >= 1.0:
        return path[-1]
    for (ax, ay), (bx, by), length in zip(path[:-1], path[1:], lengths, strict=True):
        if length > 0 and left <= length:
            return (ax + (bx - ax) * left / length, ay + (by - ay) * left / length)
        left -= length
    return path[-1]
