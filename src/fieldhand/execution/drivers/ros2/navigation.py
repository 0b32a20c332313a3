"""Drives as goals of Nav2, and the meaning of their outcomes.

    corners in degrees ──▶ map frame ──▶ NavigateToPose, one corner after the other     ──▶ arrived? ──▶ the mission
                           (datum or     NavigateThroughPoses, all corners at once
                            fromLL)      FollowGPSWaypoints, as degrees
                                        FollowPath, the way itself
                                        ComputeAndTrackRoute, the route that it finds (route_drive.py)

At each corner the robot faces along the leg that led there, and at the end along the aisle, or so that a camera sees
the plant. Arrival is verified: the robot's own position is compared with the target, and for a camera its heading.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.protocol import NEAR_M, DriveGoal, Position
from fieldhand.execution.drivers.ros2.action_client import CANCEL_S, ActionClient
from fieldhand.execution.drivers.ros2.action_outcome import ActionOutcome, GoalEnd
from fieldhand.execution.drivers.ros2.drive_end import end_of, ended_without_code
from fieldhand.execution.drivers.ros2.headway import Headway
from fieldhand.execution.drivers.ros2.map_frame import (
    Point,
    aimed,
    degrees_to_map,
    geographic_pose,
    pose,
    query_map_points,
    site_to_map,
    yaw_in,
    yaw_of,
)
from fieldhand.execution.drivers.ros2.message_fields import number_at, seconds_at, value_at
from fieldhand.execution.drivers.ros2.node_states import NodeStates
from fieldhand.execution.drivers.ros2.path_parts import parts
from fieldhand.execution.drivers.ros2.service_call import TimeLimit
from fieldhand.execution.drivers.ros2.transport import Client, Publisher, RosMessage, Transport
from fieldhand.robot.bindings import FieldBinding, Ros2Bindings
from fieldhand.site.bearings import apart_deg

FROM_LL, SPEED_LIMIT = "robot_localization/srv/FromLL", "nav2_msgs/msg/SpeedLimit"
FOLLOW_PATH, ROUTE = "nav2_msgs/action/FollowPath", "nav2_msgs/action/ComputeAndTrackRoute"

#: Seconds after the end of a goal within which the position must come within tolerance: fixes lag behind.
SETTLE_S = 3.0
#: Metres by which the robot's map position may differ from its simultaneous fix: antennas are mounted off centre.
ELSEWHERE_M = 5.0
_FRAME, _STAMP = "current_pose.header.frame_id", "current_pose.header.stamp"
_ORIENTATION = "current_pose.pose.orientation"
_X, _Y = (FieldBinding(path=f"current_pose.pose.position.{axis}") for axis in "xy")
#: Seconds within which the nodes of a navigation that seems to have been restarted are discovered and answer.
DOUBT_S = 2.5
#: Metres within which two ends without a code occurred at the same place; how many one goal of Nav2 has at most.
_SAME_M, _MOST_UNEXPLAINED = 1.0, 4
#: Metres between the points of a path that is followed.
_PATH_STEP_M = 0.25
#: Length in metres below which a leg has no direction.
_NO_LEG_M = 0.01

GoalSteps = Generator[None, None, GoalEnd]


@dataclass(frozen=True, kw_only=True)
class NavigationGoals:
    """Goals of Nav2 that carry out a drive.

    Attributes:
        goals: Goal messages, each with its end point in metres of the site.
        site_to_map: Transformation from site to map coordinates; None if it is unknown.
    """

    goals: Sequence[tuple[RosMessage, Point]]
    site_to_map: Callable[[Point], Point] | None = None


class NavigationClient:
    """Client of the robot's Nav2 stack.

    Args:
        transport: Transport of the robot's graph.
        bindings: ROS 2 bindings of the robot.
        speed_m_s: Driving speed of the robot in m/s.
        position: Returns the robot's position; None before the first fix.
        stamp_s: Returns the time of that fix in seconds of the robot's clock; None if it carries no stamp.
        clock: Mission clock in seconds, for the time limit of a drive.
        steady: Monotonic clock in seconds, for the time limit of a reply.
        new_id: Returns goal ids.

    Raises:
        Ros2Error: A type is unknown.
    """

    def __init__(
        self,
        transport: Transport,
        bindings: Ros2Bindings,
        *,
        speed_m_s: float,
        position: Callable[[], Position | None],
        stamp_s: Callable[[], float | None],
        clock: Callable[[], float],
        steady: Callable[[], float],
        new_id: Callable[[], bytes],
    ) -> None:
        self.binding, self.distro = bindings.navigation, bindings.release
        self.position, self.stamp_s, self.clock, self.steady = position, stamp_s, clock, steady
        self.speed_m_s = speed_m_s
        self.client = ActionClient(
            transport,
            bindings.whole_name(self.binding.action),
            self.binding.type,
            steady=steady,
            accept_s=self.binding.accept_s,
            quiet_s=None if self.has_routes else self.binding.quiet_s,  # a route is reported at its nodes only
            new_id=new_id,
        )
        self.working: ActionClient | None = None
        if self.binding.working:
            self.working = ActionClient(
                transport,
                bindings.whole_name(self.binding.working_action),
                self.binding.working,
                steady=steady,
                accept_s=self.binding.accept_s,
                quiet_s=self.binding.quiet_s,
                new_id=new_id,
            )
        self.follow: ActionClient | None = None
        if self.binding.follow_path:
            name = bindings.whole_name(self.binding.follow_path)
            own = (client for client in self.clients if (client.name, client.type) == (name, FOLLOW_PATH))
            self.follow = next(own, None) or ActionClient(
                transport, name, FOLLOW_PATH, steady=steady, accept_s=self.binding.accept_s, new_id=new_id
            )
        self.nodes = NodeStates(transport, bindings, steady=steady)
        self._doubted_s: float | None = None
        #: Headings in degrees clockwise from north of the robot at the end of its last drive, and of the map's x axis;
        #: None if unknown.
        self.heading_deg: float | None = None
        self._x_axis_deg = None if self.binding.datum is None else self.binding.datum.heading_deg
        self.from_ll_name = bindings.whole_name(self.binding.from_ll) if self.binding.from_ll else ""
        self.from_ll: Client | None = None
        self.speed_name = bindings.whole_name(self.binding.speed_limit) if self.binding.speed_limit else ""
        self.speed: Publisher | None = None
        if self.speed_name:
            self.speed = transport.publish(self.speed_name, SPEED_LIMIT)
        if self.from_ll_name and not self._by_degrees:
            self.from_ll = transport.client(self.from_ll_name, FROM_LL)

    @property
    def _by_degrees(self) -> bool:
        return self.binding.type == "nav2_msgs/action/FollowGPSWaypoints"

    @property
    def clients(self) -> tuple[ActionClient, ...]:
        """Return the clients of all actions that drive."""
        return (self.client,) if self.working is None else (self.client, self.working)

    @property
    def stopping(self) -> tuple[ActionClient, ...]:
        """Return the clients of all actions that can move the robot: those that drive, and that of the controller."""
        follows = self.follow is not None and self.follow not in self.clients and self.follow.servers() > 0
        return (*self.clients, self.follow) if follows and self.follow is not None else self.clients

    @property
    def has_routes(self) -> bool:
        """True if the route server of the robot determines the ways of ordinary drives."""
        return self.binding.type == ROUTE

    @property
    def has_codes(self) -> bool:
        """True if the robot's release gives a code with every failure."""
        return self.distro != "humble"

    # --- its servers ---------------------------------------------------------------------------------------------

    def doubt(self) -> None:
        """Note that navigation may have been restarted: :meth:`away` asks its nodes until all are active."""
        if self._doubted_s is None:
            self._doubted_s = self.steady()

    def away(self) -> str | None:
        """Return why no goal can be sent now, in words; None if one can, as far as is known."""
        doubted_s = self._doubted_s
        if doubted_s is None:
            return None
        self.nodes.look()
        servers = self.client.servers()
        if servers != 1:
            self._doubted_s = self.steady()  # nothing that was answered before counts
            return f"nothing answers {self.client.name}" if not servers else f"{servers} servers answer it"
        if (problem := next(self.nodes.problems(doubted_s), None)) is not None:
            return ": ".join(filter(None, problem))
        if self.steady() - doubted_s < DOUBT_S and not self.nodes.all_active(doubted_s):
            return f"{self.client.name} was restarted"
        self._doubted_s = None
        return None

    def taken(self) -> str | None:
        """Return who else drives the robot, in words; None if nobody does."""
        if not self.client.others():
            return None
        return f"a goal of another client of {self.client.name} drives the robot, such as one clicked in RViz"

    def stop_controller(self) -> Generator[None, None, bool | None]:
        """Cancel every path that the controller follows: it drives on where the navigator has died.

        Returns:
            True once that is confirmed, False if it is not, and None if no controller is visible.
        """
        follow = self.follow
        if follow is None or follow.servers() == 0:
            return None
        follow.cancel_everything_again()
        until_s = self.steady() + CANCEL_S
        while not follow.cancel_everything():
            if self.steady() >= until_s:
                return False
            yield
        return True

    def heading_of(self, yaw: float | None) -> float | None:
        """Return the heading in degrees clockwise from north of a yaw in the map; None if it is not known."""
        if yaw is None or self._x_axis_deg is None:
            return None
        return (self._x_axis_deg - math.degrees(yaw)) % 360.0

    def note_heading(self, feedback: RosMessage) -> None:
        """Take the heading from the feedback of a drive, if it contains one."""
        if value_at(feedback, _FRAME) == self.binding.frame:
            self.heading_deg = self.heading_of(yaw_in(feedback, _ORIENTATION))

    def client_for(self, goal: DriveGoal) -> ActionClient:
        """Return the client of the action that carries out a drive; of a route, that of the controller."""
        return self.client if self.working is None or (goal.work is None and not self.has_routes) else self.working

    def plan(self, goal: DriveGoal) -> Generator[None, None, NavigationGoals]:
        """Compute the goals of Nav2 for a drive, in steps that yield while waiting for the robot.

        Raises:
            Ros2Error: The robot's map service does not answer, or answers with implausible points.
        """
        binding, heading = self.binding, goal.heading_deg
        if self._by_degrees:
            return NavigationGoals(goals=[(_by_degrees(goal), goal.path_m[-1])])
        asked = goal if heading is None else aimed(goal, heading)
        if self.from_ll is not None:
            limit = TimeLimit(binding.accept_s, self.steady, self.steady)
            points = yield from query_map_points(self.from_ll, self.from_ll_name, asked, limit, self.steady)
        elif binding.datum is not None:
            points = degrees_to_map(binding.datum, asked.path_degrees)
        else:
            raise Ros2Error("neither datum nor from_ll defines where the map lies", advice="name one in the profile")
        yaw: float | None = None
        if heading is not None:
            yaw, points = yaw_of(points[-2], points[-1]), points[:-1]
            self._x_axis_deg = (heading + math.degrees(yaw)) % 360.0
        placed = site_to_map(goal.path_m, points)
        kind, legs = self.client_for(goal).type, _legs(goal.path_m)
        corners = [legs[0][0], *(j for _, j in legs)]
        divided = parts([goal.path_m[k] for k in corners], binding.tolerance_m)
        if kind == "nav2_msgs/action/FollowPath":
            # Each ends at its yaw, else along its last leg.
            paths = [
                (
                    self.follow_goal([points[k] for k in corners[a : b + 1]], yaw if b == len(legs) else None),
                    goal.path_m[corners[b]],
                )
                for a, b in divided
            ]
            return NavigationGoals(goals=paths, site_to_map=placed)
        poses = [pose(binding.frame, points[i], points[j], yaw if (i, j) == legs[-1] else None) for i, j in legs]
        if kind == "nav2_msgs/action/NavigateThroughPoses":
            # Kilted uses nav_msgs/Goals: a header, then the poses.
            header: RosMessage = {"frame_id": binding.frame}
            some: list[tuple[RosMessage, Point]] = []
            for a, b in divided:
                listed = tuple(poses[a:b])
                goals = {"header": header, "goals": listed} if self.distro == "kilted" else listed
                some.append(({"poses": goals, "behavior_tree": binding.behavior_tree}, goal.path_m[corners[b]]))
            return NavigationGoals(goals=some, site_to_map=placed)
        ends = [goal.path_m[j] for _, j in legs]
        each: list[RosMessage] = [{"pose": p, "behavior_tree": binding.behavior_tree} for p in poses]
        return NavigationGoals(goals=list(zip(each, ends, strict=True)), site_to_map=placed)

    def follow_goal(self, points: Sequence[Point], yaw: float | None) -> RosMessage:
        """Return a goal of the controller: a path in the map, with points close to each other as controllers expect.

        Args:
            points: Corners of the path, at least two.
            yaw: Yaw at its end; None for that of the last leg.
        """
        frame = self.binding.frame
        poses: list[RosMessage] = []
        for one, two in itertools.pairwise(points):
            steps = max(1, math.ceil(math.dist(one, two) / _PATH_STEP_M))
            poses += [_pose_on(frame, one, two, k / steps) for k in range(0 if not poses else 1, steps + 1)]
        if yaw is not None:
            still = all(math.dist(one, points[-1]) <= _NO_LEG_M for one in points)
            poses[0 if still else -1 :] = [pose(frame, points[-1], points[-1], yaw)] * (len(poses) if still else 1)
        header: RosMessage = {"frame_id": frame}
        return {
            "path": {"header": header, "poses": tuple(poses)},
            "controller_id": self.binding.controller,
            "goal_checker_id": self.binding.goal_checker,
        }

    def limit_speed(self, speed_m_s: float) -> None:
        """Limit the robot's speed.

        Raises:
            Ros2Error: The robot accepts no speed limit.
        """
        if self.speed is not None:
            if self.speed.subscribers() == 0:
                raise Ros2Error(
                    f"nothing subscribes to {self.speed_name}", advice="check whether Nav2's controller is active"
                )
            self.speed.send({"percentage": False, "speed_limit": speed_m_s})
        elif speed_m_s < self.speed_m_s:
            raise Ros2Error(
                f"the drive is limited to {speed_m_s:g} m/s, but the robot accepts no speed limit",
                advice="name navigation.speed_limit in the profile",
            )

    def close(self) -> None:
        """Close all endpoints without sending anything."""
        for client in (*self.clients, *(() if self.follow is None else (self.follow,))):
            client.close()
        self.nodes.close()
        if self.speed is not None:
            self.speed.close()
        if self.from_ll is not None:
            self.from_ll.close()


class RunningDrive:
    """A drive in progress, advanced by :meth:`step`."""

    def __init__(self, navigation: NavigationClient, goal: DriveGoal) -> None:
        binding = navigation.binding
        self._navigation, self._goal = navigation, goal
        self._limit = TimeLimit(
            binding.slower * goal.length_m / goal.speed_m_s + binding.extra_s, navigation.clock, navigation.steady
        )
        self._cancelled = False
        self._judged: RosMessage = {}
        self._steps = self._carry_out()
        self._ending: GoalEnd | None = None

    def step(self) -> GoalEnd | None:
        """Advance the drive; return None while it runs."""
        if self._ending is None:
            try:
                next(self._steps)
            except StopIteration as done:
                self._ending = done.value
            except Ros2Error as error:
                self._ending = GoalEnd(state="failed", fault="failed", what=str(error))
        return self._ending

    def cancel(self) -> None:
        """Request cancellation; :meth:`step` reports the end."""
        self._cancelled = True

    def _carry_out(self) -> GoalSteps:
        plan = yield from self._planned()
        if plan is None:
            return GoalEnd(state="cancelled")
        for number, (message, there) in enumerate(plan.goals):
            if number and (why := self._navigation.taken()) is not None:
                return GoalEnd(state="failed", fault="interrupted", what=why)
            after_m = sum(math.dist(a, b) for (_, a), (_, b) in itertools.pairwise(plan.goals[number:]))
            ending = yield from self._reach(message, there, plan, after_m)
            if ending.state != "succeeded":
                return ending
        return self._faced()

    def _planned(self) -> Generator[None, None, NavigationGoals | None]:
        """Return the goals of the drive; None if it was cancelled before they were computed."""
        self._navigation.limit_speed(self._goal.speed_m_s)
        self._navigation.heading_deg = None
        planning = self._navigation.plan(self._goal)
        while not self._cancelled:
            try:
                next(planning)
            except StopIteration as planned:
                plan: NavigationGoals = planned.value
                return plan
            yield
        return None

    def _overtaken(self) -> str | None:
        """Return why the current goal of Nav2 is to be replaced; None if it is not."""
        return None

    def _faced(self) -> GoalEnd:
        """Return the end of a drive that has arrived: a failure if the robot says that its camera looks elsewhere."""
        goal, heading = self._goal, self._navigation.heading_deg
        if goal.faces is None or goal.heading_deg is None or heading is None:
            return GoalEnd(state="succeeded")
        off = apart_deg(heading, goal.heading_deg)
        if off <= goal.faces.view_deg / 2.0:
            return GoalEnd(state="succeeded")
        what = f"{self._navigation.client_for(goal).name} says that it has arrived, but the robot faces {heading:.0f}°"
        advice = "check the yaw tolerance of Nav2's goal checker"
        return GoalEnd(
            state="failed",
            fault="failed",
            what=f"{what}, {off:.0f}° off the {goal.heading_deg:.0f}° at which its camera sees the plant; {advice}",
        )

    def _reach(self, message: RosMessage, there: Point, plan: NavigationGoals, after_m: float) -> GoalSteps:
        """Carry out one goal of Nav2, after which some metres of the drive are left.

        Where a failure has no code, one counts as an obstacle only if it occurs twice at a place: Nav2 also fails where
        its behavior tree timed out on the planner.
        """
        stopped_at: Position | None = None
        for attempt in range(_MOST_UNEXPLAINED):
            ending, unexplained = yield from self._drive(message, there, plan, after_m)
            at = self._navigation.position()
            twice = stopped_at is not None and at is not None and math.dist(at.xy, stopped_at.xy) <= _SAME_M
            if not unexplained or ending.fault != "blocked" or twice or self._cancelled or self._limit.over:
                break
            if attempt < _MOST_UNEXPLAINED - 1 and (why := self._navigation.taken()) is not None:
                return GoalEnd(state="failed", fault="interrupted", what=why)
            stopped_at = at
        return ending

    def _drive(
        self, message: RosMessage, there: Point, plan: NavigationGoals, after_m: float
    ) -> Generator[None, None, tuple[GoalEnd, bool]]:
        """Send one goal of Nav2; return how it ended, and True if that was a failure without a code."""
        navigation, client = self._navigation, self._navigation.client_for(self._goal)
        binding = navigation.binding
        limit = TimeLimit(binding.stuck_s, navigation.clock, navigation.steady)
        headway, nearest_m, stuck = Headway(limit, binding.most_recoveries), math.inf, ""
        client.start(message)
        seen: RosMessage = {}
        while (outcome := client.step()) is None:
            nearest_m = min(nearest_m, _distance_m(navigation.position(), there))
            if client.feedback is not seen:
                seen = client.feedback
                navigation.note_heading(seen)
            if self._cancelled:
                client.cancel()
            elif not stuck and (why := headway.look(client.feedback)) is not None:
                stuck = why
                client.cancel(why)
            elif not stuck and self._limit.over:
                why = f"the drive did not end within {self._limit.seconds:.0f} s"
                near = after_m + _left_m(headway, nearest_m) <= NEAR_M
                stuck = why if headway.recoveries or near else ""
                client.cancel(why)
            elif (why := self._wrong_place(plan) or self._overtaken()) is not None:
                client.cancel(why)
            yield
        navigation.note_heading(client.feedback)
        near = after_m + _left_m(headway, nearest_m) <= NEAR_M
        if (outcome.server and not self._cancelled) or outcome.server == "restarted" or outcome.moving:
            return (yield from self._without_server(outcome, client)), False
        unexplained = ended_without_code(outcome) and not self._cancelled
        if unexplained and (ending := (yield from self._interrupted())) is not None:
            return ending, False
        ending = end_of(outcome, binding, cancelled=self._cancelled, has_codes=navigation.has_codes, near=near)
        if stuck and ending.state == "failed" and outcome.what == stuck:
            ending = GoalEnd(state="failed", fault="occupied" if near else "blocked", what=stuck)
        if ending.state == "succeeded":
            ending = yield from self._arrive(there)
        return ending, unexplained

    def _without_server(self, outcome: ActionOutcome, client: ActionClient) -> GoalSteps:
        """Return the end of a drive whose server rejects its goal, was restarted, or does not stop.

        The controller may then follow its last path still, so it is stopped.
        """
        navigation = self._navigation
        if outcome.server == "rejects":
            yield from self._ask_nodes()
            if (why := navigation.away()) is not None:
                return GoalEnd(state="failed", fault="interrupted", what=f"{outcome.what}: {why}")
            ending = end_of(outcome, navigation.binding, cancelled=False, has_codes=navigation.has_codes)
            return dataclasses.replace(ending, fault="interrupted") if client.was_accepted else ending
        navigation.doubt()
        stopped = yield from navigation.stop_controller()
        what = outcome.what
        if stopped and navigation.follow is not None:
            outcome = dataclasses.replace(outcome, moving=False)
            what = f"{what}; {navigation.follow.name} has confirmed that its controller follows no path any more"
        if self._cancelled and not outcome.moving and stopped is not False:
            return GoalEnd(state="cancelled", what=what)
        ending = end_of(outcome, navigation.binding, cancelled=False, has_codes=navigation.has_codes)
        if stopped is False and navigation.follow is not None:
            what = f"{navigation.follow.name} does not confirm that its controller stopped"
            ending = dataclasses.replace(ending, what=f"{ending.what}; {what}")
        elif stopped:
            ending = dataclasses.replace(ending, what=what)
        return dataclasses.replace(ending, fault="interrupted") if outcome.server and client.was_accepted else ending

    def _interrupted(self) -> Generator[None, None, GoalEnd | None]:
        """Return the end of a drive that Nav2 aborted without a code, if another client or a restart is the reason."""
        if self._navigation.taken() is not None:
            what = "a goal of another client took the place of this drive's, such as one clicked in RViz"
            return GoalEnd(state="failed", fault="interrupted", what=what)
        yield from self._ask_nodes()
        if (why := self._navigation.away()) is None:
            return None
        return GoalEnd(state="failed", fault="interrupted", what=f"navigation ended the drive: {why}")

    def _ask_nodes(self) -> Generator[None, None, None]:
        """Wait until the nodes of the navigation have answered, or are known to be away."""
        navigation = self._navigation
        navigation.doubt()
        until_s = navigation.steady() + DOUBT_S
        while navigation.away() is not None and navigation.steady() < until_s and not self._cancelled:
            yield

    def _wrong_place(self, plan: NavigationGoals) -> str | None:
        """Return why the robot's map position contradicts its fix: it would drive to the wrong place; None if they
        agree.
        """
        navigation = self._navigation
        feedback, at = navigation.client_for(self._goal).feedback, navigation.position()
        if feedback is self._judged:
            return None  # this feedback was already compared; the robot has moved since
        self._judged = feedback
        # A message that was not filled in has an empty frame.
        if plan.site_to_map is None or at is None or value_at(feedback, _FRAME) != navigation.binding.frame:
            return None
        x, y = number_at(feedback, _X), number_at(feedback, _Y)
        if x is None or y is None:
            return None
        away = math.dist(plan.site_to_map(at.xy), (x, y))
        if away <= ELSEWHERE_M + navigation.binding.tolerance_m + self._driven_between_m(feedback):
            return None
        return (
            f"the robot's fix is {away:.0f} m from its position in {navigation.client.name};"
            " check whether datum, its heading and frame are those of its map"
        )

    def _driven_between_m(self, feedback: RosMessage) -> float:
        """Return the distance in metres that the robot may have driven between its fix and this feedback, by their
        stamps.
        """
        navigation = self._navigation
        fixed_s, feedback_s = navigation.stamp_s(), seconds_at(feedback, _STAMP)
        return 0.0 if fixed_s is None or feedback_s is None else navigation.speed_m_s * abs(feedback_s - fixed_s)

    def _arrive(self, there: Point) -> GoalSteps:
        """Wait until the robot's own position is within tolerance of the target."""
        navigation = self._navigation
        tolerance, until = navigation.binding.tolerance_m, navigation.steady() + SETTLE_S
        while (away := _distance_m(navigation.position(), there)) > tolerance:
            if self._cancelled:
                return GoalEnd(state="cancelled")
            if navigation.steady() >= until:
                return GoalEnd(
                    state="failed",
                    fault="failed",
                    what=f"{navigation.client.name} says that it has arrived, but the robot stands {away:.1f} m away,"
                    f" at most {tolerance:g} m are allowed; check whether datum and frame are those of its map",
                )
            yield
        return GoalEnd(state="succeeded")


def _left_m(headway: Headway, nearest_m: float) -> float:
    """Return how near a robot came to a goal: by the rest of its way, or if that is unknown in a straight line."""
    return nearest_m if math.isinf(headway.least_m) else headway.least_m


def _pose_on(frame: str, one: Point, two: Point, share: float) -> RosMessage:
    """Return a pose on a leg, facing along it."""
    x, y = one[0] + (two[0] - one[0]) * share, one[1] + (two[1] - one[1]) * share
    return pose(frame, (x - (two[0] - one[0]), y - (two[1] - one[1])), (x, y))


def _legs(path: Sequence[Point]) -> list[tuple[int, int]]:
    """Return the corners between which legs run, as pairs of indices; a path of no length still has one leg."""
    corners = [0]
    for n in range(1, len(path)):
        if math.dist(path[n], path[corners[-1]]) > _NO_LEG_M:
            corners.append(n)
    return list(itertools.pairwise(corners)) or [(0, len(path) - 1)]


def _by_degrees(goal: DriveGoal) -> RosMessage:
    # Nav2 interprets the orientation in its map frame, whose axes point east and north here (REP 105).
    legs = [(goal.path_degrees[j], yaw_of(goal.path_m[i], goal.path_m[j])) for i, j in _legs(goal.path_m)]
    if goal.heading_deg is not None:
        legs[-1] = legs[-1][0], math.radians(90.0 - goal.heading_deg)
    poses = [geographic_pose(degrees, yaw) for degrees, yaw in legs]
    return {"number_of_loops": 0, "goal_index": 0, "gps_poses": tuple(poses)}


def _distance_m(position: Position | None, there: Point) -> float:
    return math.inf if position is None else math.dist(position.xy, there)
