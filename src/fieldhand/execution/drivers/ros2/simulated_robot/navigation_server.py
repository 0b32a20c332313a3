"""The Nav2 action that a profile names, carried out by the simulated platform: rejection, pre-emption, abortion,
results.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.protocol import GoalFault, Progress
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.map_frame import degrees_to_map, map_to_degrees, orientation
from fieldhand.execution.drivers.ros2.simulated_robot.action_server import ServerGoal
from fieldhand.execution.drivers.ros2.simulated_robot.controller_server import ControllerServer
from fieldhand.execution.drivers.ros2.simulated_robot.place_lookup import PlaceLookup
from fieldhand.execution.drivers.ros2.simulated_robot.pose_messages import listed, numbers, part, yaw_of_quaternion
from fieldhand.execution.drivers.ros2.simulated_robot.robot_platform import Point, SimulatedPlatform, length_m
from fieldhand.execution.drivers.ros2.transport import RosMessage
from fieldhand.robot.bindings import Datum, Ros2Bindings
from fieldhand.site.model import Place, Site

#: Error codes of Nav2's controller, from Iron on: no progress; pose unknown; other failures.
_CODES: Mapping[GoalFault, int] = {"blocked": 105, "occupied": 105, "lost": 102}
_OTHERWISE = 100
#: Error code of Nav2's planner for a goal outside the map, and the extent of the simulated map in metres.
_OUTSIDE, _REACH_M = 204, 20_000.0
#: Seconds between feedback messages; tolerance of a quaternion's length; limit of poses in a goal.
_FEEDBACK_S, _OFF, _MOST_POSES = 0.1, 0.1, 10_000
#: Duration of a recovery in seconds.
_RECOVERY_S = 8.0
#: Distance in metres from the robot within which the first poses of a path count as passed.
_PASSED_M = 0.05
#: Distance in metres from a leg within which the robot is on it.
_ON_M = 1e-3


class NavigationServer:
    """A :class:`GoalHandler` that drives.

    Args:
        bindings: Name the action and its frame.
        interfaces: Definitions of the robot's release, which determine the fields of results.
        platform, site, places: What drives, and where.
        datum: Origin of the map.
        speed: Returns the speed limit in m/s.
        now: Returns the time in seconds.
        stamped: Returns a header for a frame name.
        report: Called at the end of each goal with its result and progress.
        type_name: Action type; empty for that of navigation.
        controller: Controller that follows the paths; None if the action is that of a controller itself.

    Attributes:
        active: False while its node is inactive, when it rejects all goals.
    """

    def __init__(
        self,
        bindings: Ros2Bindings,
        interfaces: Interfaces,
        platform: SimulatedPlatform,
        site: Site,
        places: PlaceLookup,
        datum: Datum,
        *,
        speed: Callable[[], float],
        now: Callable[[], float],
        stamped: Callable[[str], RosMessage],
        report: Callable[[str, Progress], None],
        type_name: str = "",
        controller: ControllerServer | None = None,
    ) -> None:
        self.active = True
        self._controller = controller
        self._recovering_s: float | None = None
        self._unexplained = 0
        self._binding, self._interfaces = bindings.navigation, interfaces
        self._type = type_name or bindings.navigation.type
        self._platform, self._site, self._places, self._datum = platform, site, places, datum
        self._speed, self._now, self._stamped, self._report = speed, now, stamped, report
        self._result = f"{self._type}_Result"
        self._goal: ServerGoal | None = None
        self._through: tuple[Point, ...] = ()
        self._legs: tuple[tuple[Point, Point], ...] = ()
        self._leg = 0
        self._begun_s = self._feedback_s = 0.0

    @property
    def driving(self) -> bool:
        """True while it carries out a goal."""
        return self._goal is not None and self._platform.driving

    def goal_to(self, place: Place) -> RosMessage:
        """Return a goal that leads to a place."""
        ((x, y),) = degrees_to_map(self._datum, [(place.lat, place.lon)])
        header: RosMessage = {"frame_id": self._binding.frame}
        pose: RosMessage = {
            "header": header,
            "pose": {"position": {"x": x, "y": y, "z": 0.0}, "orientation": orientation(0.0)},
        }
        if self._type.endswith("/NavigateToPose"):
            return {"pose": pose}
        if self._type.endswith("/FollowGPSWaypoints"):
            position = {"latitude": place.lat, "longitude": place.lon}
            return {"gps_poses": ({"position": position, "orientation": orientation(0.0)},)}
        if self._type.endswith("/FollowPath"):
            return {"path": {"header": header, "poses": (pose,)}}
        return {"poses": (pose,)}

    def abort_unexplained(self, times: int = 1) -> None:
        """Abort the current goal without a reason, and the next ones as soon as they begin."""
        self._unexplained = times - 1
        goal, self._goal = self._goal, None
        if goal is not None:
            self._report("failed", self._stop_now())
            goal.aborted({})

    def die(self) -> None:
        """Drop the current goal without a word; the controller follows the path on."""
        self._goal = self._recovering_s = None
        if self._controller is not None:
            self._controller.leave()
        elif self._type.endswith("/FollowPath") and self._platform.driving:
            self._stop_now()  # a controller follows nothing any more

    def rejection_reason(self, goal: RosMessage) -> str | None:
        if not self.active:
            return "the navigator is inactive"
        if self._platform.activity and not self._platform.driving:
            return f"the robot is {self._platform.activity}"
        try:
            self._corners(goal)
        except Ros2Error as error:
            return str(error)
        return None

    def begin(self, goal: ServerGoal) -> None:
        """Start driving. As in Nav2, a running goal is aborted, and its drive ends where the robot is."""
        if self._goal is not None:
            before, self._goal = self._goal, None
            self._report("pre-empted", self._stop_now())
            before.aborted({})
        elif self._platform.driving:
            self._stop_now()  # the path that a navigator left which has died
        corners, heading = self._corners(goal.goal_message), self._heading(goal.goal_message)
        here = self._platform.position
        passed_m = max(_PASSED_M, self._platform.goal_tolerance_m)
        while len(corners) > 1 and math.dist(here.xy, corners[0]) < passed_m:
            corners = corners[1:]  # a controller prunes what is behind the robot
        while self._type.endswith("/FollowPath") and len(corners) > 1 and _nears(here.xy, *corners[:2]):
            corners = corners[1:]  # and begins where its path is nearest
        corners = self._until_reached(here.xy, corners)
        self._goal, self._begun_s, self._feedback_s = goal, self._now(), -math.inf
        if any(math.dist(here.xy, corner) > _REACH_M for corner in corners):
            self._end(Progress(state="failed", what="the goal lies outside of the map"), _OUTSIDE)
            return
        self._through, self._legs, self._leg = corners, tuple(pairwise((here.xy, *corners))), 0
        self._platform.drive(corners, self._places.nearest(corners[-1]), self._speed(), self._over, heading_deg=heading)
        if self._controller is not None:
            self._controller.follow(self.abort_unexplained)
        if self._unexplained:
            self.abort_unexplained(self._unexplained)

    def _until_reached(self, here: Point, corners: tuple[Point, ...]) -> tuple[Point, ...]:
        """Return a path up to where its end counts as reached.

        Nav2's goal checkers compare the position with the end alone, not with how much of the path is left.
        """
        tolerance_m = self._platform.goal_tolerance_m
        if not tolerance_m or self._type.endswith("/FollowGPSWaypoints"):  # each of those is a goal
            return corners
        for number, (a, b) in enumerate(pairwise((here, *corners))):
            at = _nearest_on(corners[-1], a, b)
            if math.dist(at, corners[-1]) <= tolerance_m:
                return (*corners[:number], at)
        return corners

    def _stop_now(self) -> Progress:
        """End the drive where the robot is."""
        self._recovering_s = None
        progress = self._platform.stop_now()
        if self._controller is not None:
            self._controller.done(succeeded=False)
        return progress

    def cancel(self, goal: ServerGoal) -> None:
        if goal is not self._goal:
            return
        self._goal = None
        self._report("cancelled", self._stop_now())
        goal.cancelled({})

    def step(self) -> None:
        """Publish feedback on the current goal."""
        now = self._now()
        if self._goal is not None and now - self._feedback_s >= _FEEDBACK_S:
            self._feedback_s = now
            self._goal.feedback(self._feedback(self._goal, now))

    def _corners(self, goal: RosMessage) -> tuple[Point, ...]:
        """Return the corners of a goal in local metres.

        Raises:
            Ros2Error: The goal is malformed.
        """
        if "gps_poses" in goal:
            if goal.get("number_of_loops"):
                raise Ros2Error("this robot drives no loops", advice="send the waypoints once")
            degrees = [_geographic(pose) for pose in listed(goal["gps_poses"])[_first(goal) :]]
        else:
            degrees = [self._in_map(pose) for pose in self._poses(goal)]
        if not degrees:
            raise Ros2Error("the goal has no poses")
        if len(degrees) > _MOST_POSES:
            raise Ros2Error(f"the goal has more than {_MOST_POSES} poses")
        east_north = self._site.projection.metres([lat for lat, _ in degrees], [lon for _, lon in degrees])
        return tuple((float(x), float(y)) for x, y in east_north)

    def _heading(self, goal: RosMessage) -> float:
        """Return the heading at the end of a valid goal, in degrees clockwise from north."""
        if "gps_poses" in goal:
            # Nav2 interprets it in its map frame, whose axes point east and north (REP 105).
            axis_deg, last = 90.0, part(listed(goal["gps_poses"])[-1], "orientation")
        else:
            axis_deg, last = self._datum.heading_deg, part(part(self._poses(goal)[-1], "pose"), "orientation")
        return (axis_deg - math.degrees(yaw_of_quaternion(last))) % 360.0

    @staticmethod
    def _poses(goal: RosMessage) -> Sequence[object]:
        followed = goal.get("path")
        goal = followed if isinstance(followed, Mapping) else goal
        poses: object = goal.get("poses", (goal.get("pose"),))
        # From Kilted on, the poses are wrapped in a message with its own header.
        return listed(poses.get("goals") if isinstance(poses, Mapping) else poses)

    def _in_map(self, pose: object) -> tuple[float, float]:
        header, inner = part(pose, "header"), part(pose, "pose")
        frame = header.get("frame_id")
        if frame != self._binding.frame:
            raise Ros2Error(f"the pose is in frame {frame!r}; the map is {self._binding.frame!r}")
        x, y, _ = numbers(part(inner, "position"), "x", "y", "z")
        _upright(part(inner, "orientation"))
        return map_to_degrees(self._datum, (x, y))

    def _over(self, progress: Progress) -> None:
        if self._controller is not None:
            self._controller.done(succeeded=progress.state == "succeeded")
        if self._platform.recovers and self._goal is not None:
            self._recovering_s = self._now()
            return
        self._end(progress, _CODES.get(progress.fault, _OTHERWISE))

    def _end(self, progress: Progress, code: int) -> None:
        goal = self._goal
        if goal is not None and progress.state == "succeeded":
            goal.feedback(self._feedback(goal, self._now()))
        self._goal = None
        if goal is None:
            return
        self._report(progress.state, progress)
        if progress.state == "succeeded":
            goal.succeeded({})
        else:
            goal.aborted(self._failure(goal.goal_message, progress, code))

    def _failure(self, goal_message: RosMessage, progress: Progress, code: int) -> RosMessage:
        """Return a result that describes a failure: empty in Humble, with a code from Iron on, with a text from Kilted
        on.
        """
        fields = self._interfaces.fields(self._result)
        words = progress.what or progress.state
        result: dict[str, object] = {"error_msg": words} if "error_msg" in fields else {}
        if "missed_waypoints" in fields:
            missed = fields["missed_waypoints"].base
            numbered = "index" if "index" in self._interfaces.fields(missed) else "waypoint_index"
            result["missed_waypoints"] = ({numbered: _first(goal_message) + self._index_ahead(), "error_code": code},)
            constants = self._interfaces.constants(self._result)
            code_of_all = constants.get("STOP_ON_MISSED_WAYPOINT", constants.get("UNKNOWN", _OTHERWISE))
        else:
            code_of_all = code
        if "error_code" in fields:
            result["error_code"] = code_of_all
        return result

    def _feedback(self, goal: ServerGoal, now: float) -> RosMessage:
        if self._type.endswith("/FollowPath"):
            left = length_m((self._platform.position.xy, *self._through[self._index_ahead() :]))
            return {"distance_to_goal": left, "speed": self._platform.speed_m_s}
        if self._type.endswith("/FollowGPSWaypoints"):
            return {"current_waypoint": _first(goal.goal_message) + self._index_ahead()}
        at = self._platform.position
        ((x, y),) = degrees_to_map(self._datum, [(at.lat, at.lon)])
        ahead = self._through[self._index_ahead() :]
        left_m = length_m((at.xy, *ahead))
        yaw = math.radians(self._datum.heading_deg - self._platform.heading_deg)
        feedback: dict[str, object] = {
            "current_pose": {
                "header": self._stamped(self._binding.frame),
                "pose": {
                    "position": {"x": x, "y": y, "z": 0.0},
                    "orientation": orientation(yaw),
                },
            },
            "navigation_time": _duration(now - self._begun_s),
            "number_of_recoveries": self._recoveries(now),
            "distance_remaining": left_m,
        }
        if self._type.endswith("/NavigateThroughPoses"):
            feedback["number_of_poses_remaining"] = len(ahead)
        return feedback

    def _recoveries(self, now: float) -> int:
        """Return the number of recoveries: each succeeds, and the robot comes no nearer."""
        return 0 if self._recovering_s is None else int((now - self._recovering_s) / _RECOVERY_S)

    def _index_ahead(self) -> int:
        """Return the index of the next corner: the end of the leg that the robot is on."""
        at = self._platform.position
        on = (n for n, leg in enumerate(self._legs) if n >= self._leg and _away(at.xy, *leg) < _ON_M)
        self._leg = next(on, self._leg)
        return self._leg


def _nears(point: Point, one: Point, two: Point) -> bool:
    """Return True if the second of two poses of a path is nearer to a point."""
    return math.dist(point, two) < math.dist(point, one)


def _away(point: Point, a: Point, b: Point) -> float:
    """Return the distance in metres from a point to a leg."""
    return math.dist(point, _nearest_on(point, a, b))


def _nearest_on(point: Point, a: Point, b: Point) -> Point:
    """Return the point of a leg that is nearest to a point."""
    length = math.dist(a, b)
    if length == 0:
        return a
    part = ((point[0] - a[0]) * (b[0] - a[0]) + (point[1] - a[1]) * (b[1] - a[1])) / length**2
    part = min(1.0, max(0.0, part))
    return (a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]))


def _first(goal: RosMessage) -> int:
    """Return the index of the first waypoint of a goal."""
    first = goal.get("goal_index", 0)
    return first if isinstance(first, int) else 0


def _geographic(pose: object) -> tuple[float, float]:
    lat, lon = numbers(part(pose, "position"), "latitude", "longitude")
    if not (abs(lat) <= 90 and abs(lon) <= 180):
        raise Ros2Error(f"{lat}, {lon} is not a place on earth")
    _upright(part(pose, "orientation"))
    return lat, lon


def _upright(orientation: RosMessage) -> None:
    """Raise an error unless the quaternion has length 1; one that was never filled in is all zeros."""
    length = math.hypot(*numbers(orientation, "x", "y", "z", "w"))
    if not abs(length - 1.0) <= _OFF:
        raise Ros2Error(f"the orientation is not a unit quaternion: its length is {length:g}")


def _duration(seconds: float) -> RosMessage:
    return {"sec": int(seconds), "nanosec": int(seconds % 1.0 * 1e9)}
