"""A simulated robot on a graph in memory, and a client of it: both see the same time, moved by nothing but a test."""

from __future__ import annotations

import uuid
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from random import Random

from fieldhand.clock import SimulatedClock
from fieldhand.execution.drivers.ros2.action_client import ActionClient
from fieldhand.execution.drivers.ros2.action_outcome import ActionOutcome
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.simulated_robot.robot import GoalReport, SimulatedRobot
from fieldhand.execution.drivers.ros2.transport import SENSOR_QOS, RosMessage
from fieldhand.execution.drivers.simulation.state import SimulationState
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.robot.bindings import Distro, NavigationBinding, Ros2Bindings
from fieldhand.robot.model import RobotProfile
from ros2.in_memory import Graph
from support.missions.rig import husky, orchard

SITE = orchard()
STEP_S = 0.1
#: Longer than any goal of these tests takes.
LONG_S = 600.0


@cache
def interfaces_of(distro: Distro, own: tuple[tuple[str, str], ...]) -> Interfaces:
    return Interfaces.of(distro, dict(own))


def bindings(robot: RobotProfile) -> Ros2Bindings:
    assert robot.ros2 is not None
    return robot.ros2


def reached_by(robot: RobotProfile, *, distro: Distro = "humble", **navigation: object) -> RobotProfile:
    """The robot with another release, and other keys of its navigation."""
    ros2 = bindings(robot)
    changed: NavigationBinding = replace(ros2.navigation, **navigation)  # type: ignore[arg-type]
    return replace(robot, ros2=replace(ros2, distro=distro, navigation=changed))


@dataclass
class SimulatedRobotRig:
    """Both, with what the robot has said of its goals."""

    world: World = field(default_factory=World)
    robot: RobotProfile = field(default_factory=husky)
    seed: int = 0
    state: SimulationState | None = None
    said: list[GoalReport] = field(default_factory=list)

    def __post_init__(self) -> None:
        ros2 = bindings(self.robot)
        self.interfaces = interfaces_of(ros2.release, tuple(ros2.interfaces.items()))
        self.clock = SimulatedClock()
        graph = Graph(self.clock.now, complete=self.interfaces.complete)
        self.client = graph.node()
        self.simulated = SimulatedRobot(
            SITE,
            self.robot,
            self.world,
            graph.node(),
            self.interfaces,
            self.clock,
            seed=self.seed,
            sim_time=True,
            report=self.said.append,
            state=self.state,
        )
        self._ids = Random(0)
        self.navigation = self.action(ros2.navigation.action, ros2.navigation.type)

    def action(self, name: str, type_name: str) -> ActionClient:
        whole = bindings(self.robot).whole_name(name)
        return ActionClient(
            self.client,
            whole,
            type_name,
            steady=self.clock.now,
            accept_s=5.0,
            quiet_s=15.0 if "nav2" in type_name else None,
            new_id=lambda: uuid.UUID(int=self._ids.getrandbits(128)).bytes,
        )

    def step(self, seconds: float = STEP_S) -> None:
        """Let time pass."""
        until = self.clock.now() + seconds
        while self.clock.now() < until - 1e-9:
            self.simulated.step()
            self.clock.advance(STEP_S)

    def during(self, seconds: float, action: ActionClient) -> None:
        """Let time pass, in which a goal is carried out."""
        until = self.clock.now() + seconds
        while self.clock.now() < until - 1e-9:
            action.step()
            self.step()

    def finish(self, action: ActionClient) -> ActionOutcome:
        """Until the goal is over."""
        until = self.clock.now() + LONG_S
        while (outcome := action.step()) is None:
            assert self.clock.now() < until, "the goal is never over"
            self.step()
        return outcome

    def drive(self, *corners: tuple[float, float]) -> ActionOutcome:
        """Through corners in local metres, by the robot's navigation."""
        self.navigation.start(self.goal(*corners))
        return self.finish(self.navigation)

    def goal(self, *corners: tuple[float, float]) -> RosMessage:
        degrees = [tuple(map(float, point)) for point in SITE.projection.degrees(corners)]
        kind = bindings(self.robot).navigation.type
        if kind.endswith("FollowGPSWaypoints"):
            return {
                "gps_poses": [
                    {"position": {"latitude": lat, "longitude": lon}, "orientation": {"w": 1.0}} for lat, lon in degrees
                ]
            }
        poses = [pose(*self.in_map(lat, lon)) for lat, lon in degrees]
        if kind.endswith("NavigateToPose"):
            return {"pose": poses[0]}
        return {"poses": {"goals": poses} if bindings(self.robot).release == "kilted" else poses}

    def in_map(self, lat: float, lon: float) -> tuple[float, float]:
        """By the robot's own service."""
        point = self.ask("fromLL", "robot_localization/srv/FromLL", ll_point={"latitude": lat, "longitude": lon})
        at = point["map_point"]
        assert isinstance(at, Mapping)
        return at["x"], at["y"]

    def ask(self, name: str, type_name: str, /, within_s: float = LONG_S, **request: object) -> RosMessage:
        """The answer of a service."""
        client = self.client.client(bindings(self.robot).whole_name(name), type_name)
        client.ask(request)
        until = self.clock.now() + within_s
        while not (replies := client.replies()):
            assert self.clock.now() < until, "no answer"
            self.step()
        client.close()
        return replies[0][1]

    def heard(self, topic: str, type_name: str, seconds: float = 2.0) -> tuple[RosMessage, ...]:
        """Return the messages that arrive on a topic from now on."""
        subscription = self.client.subscribe(bindings(self.robot).whole_name(topic), type_name, SENSOR_QOS)
        messages: list[RosMessage] = []
        until = self.clock.now() + seconds
        while self.clock.now() < until:
            self.step()
            messages += subscription.take()
        subscription.close()
        return tuple(messages)

    def here(self) -> tuple[float, float]:
        """In local metres, as its receiver says."""
        fix = self.heard("gps/fix", "sensor_msgs/msg/NavSatFix", seconds=0.2)[-1]
        x, y = SITE.projection.metres(fix["latitude"], fix["longitude"])[0]
        return float(x), float(y)

    def charge(self) -> float:
        """In percent, as its battery says."""
        said = self.heard("battery_state", "sensor_msgs/msg/BatteryState", seconds=1.2)[-1]["percentage"]
        assert isinstance(said, float)
        return 100.0 * said


def pose(x: float, y: float, /, *, frame: str = "map", **orientation: float) -> RosMessage:
    """A ``PoseStamped``."""
    return {
        "header": {"frame_id": frame},
        "pose": {"position": {"x": x, "y": y}, "orientation": orientation or {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}},
    }
