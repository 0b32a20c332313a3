"""A driver of its own: a cart that follows every path at constant speed, by dead reckoning."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from itertools import pairwise

from fieldhand.clock import Clock, ScaledClock
from fieldhand.errors import InputError
from fieldhand.execution.drivers.protocol import ActionGoal, DriveGoal, Position, Progress
from fieldhand.execution.drivers.registry import DriverKind
from fieldhand.execution.vehicle import Connection, Vehicle
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task

Point = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class CartFaults:
    """Faults of a cart, for tests.

    Attributes:
        obstacle_m: Metres into a drive at which an obstacle blocks it; None for none.
        lost_s: Seconds of the cart's clock between which its position is unknown.
        broken: Actions that fail.
    """

    obstacle_m: float | None = None
    lost_s: tuple[float, float] = (math.inf, math.inf)
    broken: frozenset[str] = frozenset()


@dataclass(frozen=True, kw_only=True)
class _Goal:
    """The current goal, and how it will end if nothing stops it.

    Attributes:
        started_s: Time of its start.
        end: How it ends: metres and seconds in all.
        path: Corners of the drive in local metres; empty for an action.
        energy_j: Energy of the action.
    """

    started_s: float
    end: Progress
    path: tuple[Point, ...] = ()
    energy_j: float = 0.0


@dataclass(kw_only=True)
class CartDriver:
    """A :class:`~fieldhand.execution.drivers.protocol.Driver` for the cart.

    Args:
        site, robot: Site and profile of the mission.
        clock: Clock of the mission; the cart's own time.
        at: Where the cart stands, in local metres.
        faults: Faults, for tests.
    """

    site: Site
    robot: RobotProfile
    clock: Clock
    at: Point
    faults: CartFaults = field(default_factory=CartFaults)
    seed: int | None = None

    def __post_init__(self) -> None:
        self._goal: _Goal | None = None
        self._last = Progress(state="idle")
        self._used_j = 0.0
        self._begun_s = self.clock.now()

    def start_drive(self, goal: DriveGoal) -> None:
        length, obstacle = goal.length_m, self.faults.obstacle_m
        end = Progress(state="succeeded", metres=length, seconds=length / goal.speed_m_s)
        if obstacle is not None and obstacle < length:
            end = Progress(
                state="failed", metres=obstacle, seconds=obstacle / goal.speed_m_s, what="an obstacle", fault="blocked"
            )
        lost_after = self.faults.lost_s[0] - self.clock.now()
        if 0 <= lost_after < end.seconds:
            metres = lost_after * goal.speed_m_s
            end = Progress(state="failed", metres=metres, seconds=lost_after, what="position lost", fault="lost")
        self._start(_Goal(started_s=self.clock.now(), end=end, path=goal.path_m))

    def start_action(self, goal: ActionGoal) -> None:
        action = self.robot.action[goal.action]
        end = Progress(
            state="succeeded",
            seconds=action.duration_s,
            readings={name: self.robot.quantity[name].typical for name in action.measures},
        )
        if goal.action in self.faults.broken:
            end = Progress(state="failed", seconds=action.duration_s, what="the sensor gave an error", fault="failed")
        self._start(_Goal(started_s=self.clock.now(), end=end, energy_j=action.energy_j))

    def poll(self) -> Progress:
        goal = self._goal
        if goal is None:
            return self._last
        elapsed = self.clock.now() - goal.started_s
        if elapsed >= goal.end.seconds - 1e-6:
            return self._finish(goal, goal.end)
        return replace(self._partly(goal, elapsed), state="running", readings={}, what="", fault="none")

    def cancel(self) -> None:
        if self._goal is not None and not self.poll().over:
            partly = self._partly(self._goal, self.clock.now() - self._goal.started_s)
            self._finish(self._goal, replace(partly, state="cancelled", readings={}, what="", fault="none"))

    def next_event_in(self) -> float | None:
        if self.poll().over or self._goal is None:
            return None
        return max(0.0, self._goal.started_s + self._goal.end.seconds - self.clock.now())

    def position(self) -> Position:
        progress = self.poll()
        x, y = self.at if self._goal is None else _along(self._goal.path, progress.metres) or self.at
        lat, lon = (float(value) for value in self.site.projection.degrees([(x, y)])[0])
        return Position(x=x, y=y, lat=lat, lon=lon)

    def charge_percent(self) -> float:
        progress, goal = self.poll(), self._goal
        used_j = self._used_j + (0.0 if goal is None else self._energy(goal, progress))
        used_j += (self.clock.now() - self._begun_s) * self.robot.energy.idle_w
        return max(0.0, 100.0 * (1.0 - used_j / self.robot.energy.capacity_j))

    def lost(self) -> str | None:
        since, until = self.faults.lost_s
        return "no satellite fix" if since <= self.clock.now() + 1e-6 and self.clock.now() < until else None

    def stopped(self) -> str | None:
        return None

    def _start(self, goal: _Goal) -> None:
        if not self.poll().over:
            raise RuntimeError("a driver has goals one at a time")
        if self.lost():
            goal = replace(goal, end=Progress(state="failed", what="position lost", fault="lost"))
        self._goal = goal

    def _finish(self, goal: _Goal, end: Progress) -> Progress:
        self._used_j += self._energy(goal, end)
        self.at = _along(goal.path, end.metres) or self.at
        self._goal, self._last = None, end
        return end

    def _partly(self, goal: _Goal, elapsed_s: float) -> Progress:
        part = elapsed_s / goal.end.seconds if goal.end.seconds > 0 else 1.0
        return replace(goal.end, metres=part * goal.end.metres, seconds=elapsed_s)

    def _energy(self, goal: _Goal, progress: Progress) -> float:
        """Return the energy of a goal so far in joules, without idle power."""
        part = progress.seconds / goal.end.seconds if goal.end.seconds > 0 else 1.0
        return progress.metres * self.robot.energy.drive_j_per_m + part * goal.energy_j


@contextmanager
def connect(site: Site, robot: RobotProfile, task: Task, by: Connection, within_s: float) -> Iterator[Vehicle]:
    """Connect to the cart; it starts at the site's start.

    Its option ``pace`` is the number of its seconds in one of ours.

    Raises:
        InputError: An option is unknown, or no number above 0.
    """
    del task, within_s  # the cart can do everything in its profile, and responds at once
    clock = ScaledClock(_pace(by))
    driver = CartDriver(site=site, robot=robot, clock=clock, at=site.start.stand or site.start.xy)
    yield Vehicle(driver=driver, clock=clock, charge_percent=driver.charge_percent(), by=by)
    driver.cancel()


def _pace(by: Connection) -> float:
    unknown = set(by.options) - {"pace"}
    try:
        pace = float(by.options.get("pace", "1"))
    except ValueError:
        pace = math.nan
    if unknown or not 0 < pace < math.inf:
        raise InputError(
            f"the cart has no option '{min(unknown)}'" if unknown else "the pace is not a number above 0",
            where="--driver-option",
            advice="give pace=1 for real time, pace=100 for a hundred times as fast",
        )
    return pace


def _along(path: tuple[Point, ...], metres: float) -> Point | None:
    """Return the point of a path after some metres; None for an empty path."""
    if not path:
        return None
    left = metres
    for (ax, ay), (bx, by) in pairwise(path):
        length = math.dist((ax, ay), (bx, by))
        if left <= length:
            part = left / length if length > 0 else 0.0
            return ax + part * (bx - ax), ay + part * (by - ay)
        left -= length
    return path[-1]


CART = DriverKind(connect=connect, summary="the example cart, at constant speed")
