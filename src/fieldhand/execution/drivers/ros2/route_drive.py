"""Drives along the routes of Nav2's route server, on the graph that ``fieldhand export nav2`` writes.

    ComputeAndTrackRoute ──▶ feedback: a path ──▶ FollowPath ──▶ arrived?
                    └──▶ feedback: another path (rerouted) ──┘

The route server drives nothing: it computes a route, reports the nodes that the robot passes, and runs the operations
of the graph. Its path begins and ends at the nodes nearest to the robot and the goal; before and after it the robot
keeps to the approved way. A path that leaves that way is not followed: at first the approved way is, as it is, and
where the route server changes its route on the way, the drive ends as blocked, so that another way is decided on.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Generator, Mapping, Sequence

from fieldhand.execution.drivers.protocol import DriveGoal
from fieldhand.execution.drivers.ros2.action_client import CANCEL_S
from fieldhand.execution.drivers.ros2.action_outcome import ActionOutcome, GoalEnd
from fieldhand.execution.drivers.ros2.drive_end import end_of
from fieldhand.execution.drivers.ros2.map_frame import Point, yaw_in
from fieldhand.execution.drivers.ros2.message_fields import value_at
from fieldhand.execution.drivers.ros2.navigation import GoalSteps, NavigationClient, RunningDrive
from fieldhand.execution.drivers.ros2.service_call import TimeLimit
from fieldhand.execution.drivers.ros2.transport import RosMessage

#: Metres within which a route meets the approved way, or the robot.
_MEETS_M = 0.5
#: Metres from the approved way beyond which a route is another one.
_BESIDE_M = 2.0
#: Routes that are followed in one drive at most: a route server that changes its mind for ever blocks the robot.
_MOST_ROUTES = 20


class RouteDrive(RunningDrive):
    """A drive on a route of Nav2, advanced by :meth:`step`."""

    def __init__(self, navigation: NavigationClient, goal: DriveGoal) -> None:
        self._route: tuple[Point, ...] = ()
        self._followed: tuple[Point, ...] = ()
        self._tracked = False
        self._lost: ActionOutcome | None = None
        super().__init__(navigation, goal)

    def _carry_out(self) -> GoalSteps:
        plan = yield from self._planned()
        if plan is None:
            return GoalEnd(state="cancelled")
        navigation, tracker = self._navigation, self._navigation.client
        ((message, there),) = plan.goals
        approved, end = path_of(message), _last_pose(message)
        tracker.start({"use_poses": True, "use_start": False, "goal": end})
        self._tracked = True
        limit = TimeLimit(navigation.binding.accept_s, navigation.steady, navigation.steady)
        while not self._route and self._lost is None and not self._cancelled and not limit.over:
            self._look()
            yield
        ending = GoalEnd(state="cancelled")
        if self._lost is None and not self._cancelled:
            if not self._route:
                what = f"{tracker.name} reported no route within {limit.seconds:g} s"
                ending = GoalEnd(state="failed", fault="failed", what=what)
            else:
                ending = yield from self._follow(message, there, plan, approved)
        elif self._lost is not None:
            ending = self._failed(self._lost)
        yield from self._untrack()
        return self._faced() if ending.state == "succeeded" else ending

    def _follow(self, message: RosMessage, there: Point, plan: object, approved: Sequence[Point]) -> GoalSteps:
        """Follow the route, and each that replaces it."""
        navigation, yaw = self._navigation, yaw_in(_last_pose(message), "pose.orientation")
        begin = approved[0]
        for number in range(_MOST_ROUTES):
            self._followed = self._route
            away_m = max(math.dist(at, approved[_nearest(approved, at)]) for at in self._route)
            if number and away_m > _BESIDE_M:
                what = f"{navigation.client.name} chose a route that leaves the approved way by {away_m:.0f} m"
                return GoalEnd(state="failed", fault="blocked", what=what)
            way = None if away_m > _BESIDE_M else joined_way(approved, self._route, begin)
            if way is None:
                yield from self._untrack()
            goal = message if way is None else navigation.follow_goal(way, yaw)
            ending = yield from self._reach(goal, there, plan, 0.0)  # type: ignore[arg-type]
            if self._lost is not None and ending.state != "succeeded" and not self._cancelled:
                return self._failed(self._lost)
            if self._cancelled or self._route == self._followed or ending.state == "succeeded":
                return ending
            at, placed = navigation.position(), getattr(plan, "site_to_map", None)
            begin = placed(at.xy) if at is not None and placed is not None else approved[0]
        what = f"{navigation.client.name} changed its route {_MOST_ROUTES} times"
        return GoalEnd(state="failed", fault="blocked", what=what)

    def _overtaken(self) -> str | None:
        if not self._tracked:
            return None
        self._look()
        if self._lost is not None:
            return self._lost.what or "the route server ended its route"
        return "the route server chose another way" if self._route != self._followed else None

    def _look(self) -> None:
        """Read the feedback of the route server, and the end of its goal unless that is a success."""
        tracker = self._navigation.client
        outcome = tracker.step()
        path = value_at(tracker.feedback, "path")
        points = path_of({"path": path}) if isinstance(path, Mapping) else ()
        if points:
            self._route = points
        if outcome is not None:
            self._tracked = False
            self._lost = None if outcome.how == "succeeded" else outcome

    def _failed(self, outcome: ActionOutcome) -> GoalEnd:
        """Return the end of a drive whose route failed."""
        navigation = self._navigation
        return end_of(outcome, navigation.binding, cancelled=self._cancelled, has_codes=navigation.has_codes)

    def _untrack(self) -> Generator[None, None, None]:
        """End the goal of the route server: the robot has arrived, or follows its route no longer."""
        tracker, until_s = self._navigation.client, self._navigation.steady() + CANCEL_S
        tracker.cancel()
        while tracker.busy and tracker.step() is None and self._navigation.steady() < until_s:
            yield
        self._tracked = False


def joined_way(approved: Sequence[Point], route: Sequence[Point], begin: Point) -> list[Point] | None:
    """Return the way along a route, with the parts of the approved way that lead to it and on from it.

    Args:
        approved: The approved way, with points close to each other.
        route: Points of the route.
        begin: Position of the robot.

    Returns:
        None if the route does not meet the approved way at both ends.
    """
    first, last = _nearest(approved, route[0]), _nearest(approved, route[-1])
    begins = _nearest(approved, begin)
    if math.dist(approved[last], route[-1]) > _MEETS_M:
        return None
    if math.dist(begin, route[0]) <= _MEETS_M:
        lead: list[Point] = [begin]
    elif math.dist(approved[first], route[0]) <= _MEETS_M and math.dist(approved[begins], begin) <= _MEETS_M:
        lead = [begin, *approved[begins:first]] if begins <= first else [begin, *approved[first:begins][::-1]]
    else:
        return None
    way = [*lead, *route, *approved[last + 1 :]]
    kept = [way[0], *(two for one, two in itertools.pairwise(way) if math.dist(one, two) > 1e-6)]
    return kept if len(kept) > 1 else [*kept, approved[-1]]


def path_of(message: RosMessage) -> tuple[Point, ...]:
    """Return the points of a goal's or a feedback's path, without those that are not numbers."""
    poses = value_at(message, "path.poses")
    found: list[Point] = []
    for pose in poses if isinstance(poses, Sequence) else ():
        at = value_at(pose, "pose.position") if isinstance(pose, Mapping) else None
        x, y = (at.get("x"), at.get("y")) if isinstance(at, Mapping) else (None, None)
        if isinstance(x, float) and isinstance(y, float) and math.isfinite(x) and math.isfinite(y):
            found.append((x, y))
    return tuple(found)


def _last_pose(message: RosMessage) -> RosMessage:
    path = message["path"]
    assert isinstance(path, Mapping)  # noqa: S101  made by the navigation client
    pose: RosMessage = path["poses"][-1]
    return pose


def _nearest(points: Sequence[Point], at: Point) -> int:
    return min(range(len(points)), key=lambda k: math.dist(points[k], at))
