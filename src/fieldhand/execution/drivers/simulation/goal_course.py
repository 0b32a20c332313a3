"""Course of a goal of the simulated robot: where it is, and what it has used, at each time until the end."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from fieldhand.execution.drivers.protocol import GoalFault, GoalState
from fieldhand.execution.drivers.simulation.ground_truth import Hindrance, Point
from fieldhand.site.bearings import last_heading
from fieldhand.site.working.stretch import total_m

#: Seconds within which two times are equal: clocks add floating-point numbers.
EPSILON_S = 1e-6

#: Part of a path, before and behind its middle, on which a robot strays; part of it that gives its direction.
_STRAYS, _STEP = 0.25, 0.001


@dataclass(frozen=True, kw_only=True)
class GoalCourse:
    """Course of a goal, determined when it starts, but unknown to the mission.

    Attributes:
        start_s: Time of its start in seconds.
        lasts_s: Duration until it is done or fails.
        metres: Distance driven by its end, by odometry.
        path: Corners in local metres; empty for an action.
        errors: Metres east and north from each corner to where the robot believes it is there; empty if it knows.
        reach: Fraction of the path covered by its end, 0 to 1.
        action_j: Energy of the action in joules, spread evenly over its duration, or over the metres on which an
            implement is on.
        on: Those parts of the whole path, as metres from its begin.
        strays_m: Greatest distance in metres to the right of the path, in its middle.
        meets: Hindrance that ends it.
        turns_s: Seconds before and after the path in which the robot turns on the spot.
        heading_deg: Heading at its end, in degrees clockwise from north; None for that of the path there.
        docks: Connected to the charger after it succeeded; None for no change.
    """

    start_s: float
    lasts_s: float
    outcome: GoalState
    metres: float = 0.0
    path: tuple[Point, ...] = ()
    errors: tuple[Point, ...] = ()
    reach: float = 1.0
    action_j: float = 0.0
    on: tuple[tuple[float, float], ...] = ()
    readings: Mapping[str, float] = field(default_factory=dict)
    what: str = ""
    fault: GoalFault = "none"
    strays_m: float = 0.0
    meets: Hindrance | None = None
    turns_s: tuple[float, float] = (0.0, 0.0)
    heading_deg: float | None = None
    docks: bool | None = None

    def cut(self, part: float) -> GoalCourse:
        """Return the course, failed after this fraction of its path, or of an action."""
        before_s, after_s = self.turns_s
        return replace(
            self,
            lasts_s=(before_s if part > 0.0 else 0.0) + part * (self.lasts_s - before_s - after_s),
            outcome="failed",
            metres=part * self.metres,
            reach=part * self.reach,
            action_j=self.action_j if self.on else part * self.action_j,
            readings={},
            meets=None,
            turns_s=(before_s if part > 0.0 else 0.0, 0.0),
            heading_deg=None,
            docks=None,
        )

    def moved(self, done: float) -> float:
        """Return the fraction of the path, or of an action, that is done at a fraction of the time."""
        if self.turns_s == (0.0, 0.0):
            return done
        before_s, after_s = self.turns_s
        moves_s = self.lasts_s - before_s - after_s
        if done >= 1.0 or moves_s <= 0.0:
            return 1.0 if done * self.lasts_s >= before_s else 0.0
        return min(1.0, max(0.0, (done * self.lasts_s - before_s) / moves_s))

    def facing(self, done: float) -> float | None:
        """Return the heading at a fraction of the time; None if the path has no length."""
        if done >= 1.0 and self.heading_deg is not None:
            return self.heading_deg
        here = _along(self.path, self.reach * self.moved(done))
        k = next((k for k, leg in enumerate(itertools.pairwise(self.path)) if _is_between(here, *leg)), -2)
        return last_heading(self.path[: k + 2] if k >= 0 else self.path)

    def joules(self, done: float) -> float:
        """Return the energy of the action up to a fraction of the course."""
        if not self.on:
            return self.moved(done) * self.action_j
        at_m = self.moved(done) * self.reach * sum(math.dist(a, b) for a, b in itertools.pairwise(self.path))
        worked_m = sum(max(0.0, min(end, at_m) - begin) for begin, end in self.on)
        return self.action_j * min(1.0, worked_m / total_m(self.on))

    def at(self, done: float) -> Point:
        """Return the position of the robot after a fraction of the course."""
        part = self.reach * self.moved(done)
        x, y = _along(self.path, part)
        away_m = self.strays_m * max(0.0, 1.0 - abs(part - 0.5) / _STRAYS)
        if away_m == 0.0:
            return (x, y)
        (x0, y0), (x1, y1) = (_along(self.path, min(1.0, max(0.0, part + step))) for step in (-_STEP, _STEP))
        length = math.hypot(x1 - x0, y1 - y0)
        return (x, y) if length == 0.0 else (x + away_m * (y1 - y0) / length, y - away_m * (x1 - x0) / length)

    def error(self, done: float) -> Point:
        """Return how far from its position the robot believes to be, in metres east and north."""
        return _along(self.errors, self.reach * self.moved(done), self.path) if self.errors else (0.0, 0.0)

    def done_at(self, now: float) -> float:
        """Return the fraction of the course that is done, 0 to 1."""
        if now >= self.start_s + self.lasts_s - EPSILON_S:
            return 1.0
        return max(0.0, now - self.start_s) / self.lasts_s


def _is_between(point: Point, a: Point, b: Point) -> bool:
    """Return True if a point of a path lies on this leg of it."""
    return math.dist(a, point) + math.dist(point, b) <= math.dist(a, b) + EPSILON_S and math.dist(a, b) > 0.0


def until_near_end(path: tuple[Point, ...], tolerance_m: float) -> tuple[Point, ...]:
    """Return a path without its last part, all of which is within a distance of its end."""
    end, last = path[-1], len(path) - 1
    while last > 0 and math.dist(path[last - 1], end) <= tolerance_m:
        last -= 1
    if last == 0:
        return (path[0], path[0])
    (ax, ay), (bx, by) = path[last], path[last - 1]
    length = math.dist((ax, ay), (bx, by))
    ux, uy = (bx - ax) / length, (by - ay) / length
    along = (end[0] - ax) * ux + (end[1] - ay) * uy
    across = (end[0] - ax) * uy - (end[1] - ay) * ux
    left = along + math.sqrt(max(0.0, tolerance_m**2 - across**2))
    return (*path[:last], (ax + left * ux, ay + left * uy))


def _along(path: tuple[Point, ...], part: float, driven: tuple[Point, ...] = ()) -> Point:
    """Return the point at a fraction of a path's length, 0 to 1.

    Args:
        driven: Path with as many corners, whose lengths count instead.
    """
    lengths = [math.dist(a, b) for a, b in itertools.pairwise(driven or path)]
    left = part * sum(lengths)
    if part >= 1.0:
        return path[-1]
    for (ax, ay), (bx, by), length in zip(path[:-1], path[1:], lengths, strict=True):
        if length > 0 and left <= length:
            return (ax + (bx - ax) * left / length, ay + (by - ay) * left / length)
        left -= length
    return path[-1]
