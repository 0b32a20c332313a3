"""Nav2's route server: computes the route between the graph's nodes nearest to the robot and a goal, and tracks it.

Its graph is that of ``fieldhand export nav2``: the places beside the trees on both sides, markers and gates, and the
corners of the drives between them. As the real one it drives nothing: its client has the controller follow the path.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence

import numpy as np

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.protocol import Progress
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.map_frame import degrees_to_map, map_to_degrees, pose
from fieldhand.execution.drivers.ros2.simulated_robot.action_server import ServerGoal
from fieldhand.execution.drivers.ros2.simulated_robot.pose_messages import numbers, part
from fieldhand.execution.drivers.ros2.simulated_robot.robot_platform import Point, SimulatedPlatform
from fieldhand.execution.drivers.ros2.transport import RosMessage
from fieldhand.forecast.visit_order import drives_for
from fieldhand.robot.bindings import Datum, NavigationBinding
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

#: Error code of a goal to which no route leads.
NO_VALID_ROUTE = 405
#: Metres from the last node within which a route is completed (``boundary_radius_to_achieve_node``).
_ACHIEVED_M = 1.0


class RouteServer:
    """A :class:`GoalHandler` that computes and tracks routes.

    Args:
        binding: Navigation of the robot, which names the frame.
        type_name: Action type.
        interfaces: Definitions of the robot's release, which determine the fields of results.
        platform, site, profile: What drives, and where.
        datum: Origin of the map.
        stamped: Returns a header for a frame name.
        report: Called at the end of each goal with its result and progress.
    """

    def __init__(
        self,
        binding: NavigationBinding,
        type_name: str,
        interfaces: Interfaces,
        platform: SimulatedPlatform,
        site: Site,
        profile: RobotProfile,
        datum: Datum,
        *,
        stamped: Callable[[str], RosMessage],
        report: Callable[[str, Progress], None],
    ) -> None:
        self._binding, self._platform, self._site, self._datum = binding, platform, site, datum
        self._drives = drives_for(site, profile)
        self._stamped, self._report = stamped, report
        self._has_words = "error_msg" in interfaces.fields(f"{type_name}_Result")
        self._goal: ServerGoal | None = None
        self._nodes = self._find_nodes()
        self._last = 0

    def _find_nodes(self) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
        """Return the places at which the robot can stand, shape (n, 2)."""
        trees = [tree.place for tree in self._site.trees]
        stands = [c.xy for options in self._drives.sides(trees) for c in options if not c.why_not]
        others = [*self._site.markers.values(), *(gate.place for gate in self._site.gates)]
        able = [place for place in others if not self._drives.problem(place)]
        return np.array([*stands, *(p.stand or p.xy for p in self._drives.stands(able))]).reshape(-1, 2)

    def rejection_reason(self, goal: RosMessage) -> str | None:
        try:
            self._goal_xy(goal)
        except Ros2Error as error:
            return str(error)
        return None

    def begin(self, goal: ServerGoal) -> None:
        """Compute a route; a running goal is pre-empted."""
        if self._goal is not None:
            before, self._goal = self._goal, None
            self._report("pre-empted", Progress(state="cancelled"))
            before.aborted({})
        self._goal = goal
        self.reroute()

    def reroute(self, *, avoiding: Sequence[Point] = ()) -> None:
        """Compute the route of the current goal from where the robot is, and publish it.

        Args:
            avoiding: Nodes that the route must not end at, as if they were blocked.
        """
        goal = self._goal
        if goal is None:
            return
        here = self._nearest(self._platform.position.xy)
        self._last = self._nearest(self._goal_xy(goal.goal_message), avoiding)
        way = self._drives.way_between(self._at(here), self._at(self._last))
        if way is None:
            self._fail(NO_VALID_ROUTE, "no valid route")
            return
        self._publish(goal, way[0], rerouted=True)

    def fail(self, code: int, words: str) -> None:
        """Abort the current goal with an error code."""
        self._fail(code, words)

    def cancel(self, goal: ServerGoal) -> None:
        if goal is self._goal:
            self._goal = None
            self._report("cancelled", Progress(state="cancelled"))
            goal.cancelled({})

    def step(self) -> None:
        """Complete the route once the robot is at its last node."""
        goal = self._goal
        if goal is None or math.dist(self._platform.position.xy, self._at(self._last)) > _ACHIEVED_M:
            return
        self._goal = None
        self._report("succeeded", Progress(state="succeeded"))
        goal.succeeded({})

    def _fail(self, code: int, words: str) -> None:
        goal, self._goal = self._goal, None
        if goal is not None:
            self._report("failed", Progress(state="failed", what=words))
            goal.aborted({"error_code": code} | ({"error_msg": words} if self._has_words else {}))

    def _publish(self, goal: ServerGoal, way: Sequence[Point], *, rerouted: bool) -> None:
        """Publish a route as feedback: its path, with a pose at each corner."""
        degrees = self._site.projection.lat_lon(way)
        corners = degrees_to_map(self._datum, degrees)
        frame = self._binding.frame
        poses = [pose(frame, corners[0], corners[0]), *(pose(frame, *leg) for leg in itertools.pairwise(corners))]
        header = self._stamped(self._binding.frame)
        goal.feedback(
            {
                "path": {"header": header, "poses": tuple(poses)},
                "rerouted": rerouted,
                "next_node_id": self._last % 65_536,
            }
        )

    def _goal_xy(self, goal: RosMessage) -> Point:
        """Return the position of a goal in local metres.

        Raises:
            Ros2Error: The goal names nodes, or is malformed.
        """
        if not goal.get("use_poses"):
            raise Ros2Error("this robot takes poses, not the ids of nodes", advice="set use_poses")
        wanted = part(goal, "goal")
        frame = part(wanted, "header").get("frame_id")
        if frame != self._binding.frame:
            raise Ros2Error(f"the pose is in frame {frame!r}; the map is {self._binding.frame!r}")
        x, y = numbers(part(part(wanted, "pose"), "position"), "x", "y")
        lat, lon = map_to_degrees(self._datum, (x, y))
        east, north = self._site.projection.metres(lat, lon)[0]
        return float(east), float(north)

    def _at(self, node: int) -> Point:
        return float(self._nodes[node, 0]), float(self._nodes[node, 1])

    def _nearest(self, xy: Point, avoiding: Sequence[Point] = ()) -> int:
        away = np.hypot(*(self._nodes - np.array(xy)).T)
        for one in avoiding:
            away[np.hypot(*(self._nodes - np.array(one)).T) < _ACHIEVED_M] = np.inf
        return int(away.argmin())
