"""A small robot that drives: Nav2 as a script, with a fix, a battery, odometry and an emergency stop that follow it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

from fieldhand.clock import SimulatedClock
from fieldhand.execution.drivers.ros2.driver import Ros2Driver
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.navigation import FROM_LL, SPEED_LIMIT
from fieldhand.execution.drivers.ros2.transport import QosProfile, RosMessage, Transport
from fieldhand.robot.bindings import (
    ActionBinding,
    BatteryBinding,
    CallBinding,
    Datum,
    FieldBinding,
    NavigationBinding,
    NextMessage,
    PositionBinding,
    Ros2Bindings,
    StopBinding,
    TopicBinding,
)
from fieldhand.robot.model import RobotProfile
from fieldhand.site.projection import Projection
from ros2.in_memory import Graph, Node
from ros2.scripted import Script, ScriptedAction
from support.missions.rig import husky, orchard

SITE = orchard()
TICK_S = 0.1
SPEED = 1.0

#: Some way off the site, and turned.
DATUM = Datum(lat=37.002, lon=-120.003, heading_deg=30.0)

SAMPLE, READ = "farm_msgs/action/Sample", "farm_msgs/srv/Read"
INTERFACES = {
    SAMPLE: (
        "string place\nfloat64 lat\nint32 depth\nbool wet\n---\nbool ok\nstring words\nfloat64[] co2\n---\nfloat32 part"
    ),
    READ: "string kind\n---\nbool ok\nstring words\nfloat64 kelvin",
}

ACTIONS = {
    "read_co2": ActionBinding(
        call=CallBinding(
            kind="action",
            name="sample",
            type=SAMPLE,
            request={"place": "$place", "lat": "$lat", "depth": 3, "wet": True},
            readings={"co2": FieldBinding(path="co2[1]", scale=1e4, offset=-1.0)},
            success="ok",
            message="words",
            within_s=20.0,
        )
    ),
    "read_ambient_temperature": ActionBinding(
        call=CallBinding(
            kind="service",
            name="/thermometer",
            type=READ,
            request={"kind": "$kind"},
            readings={"ambient_temperature": FieldBinding(path="kelvin", offset=-273.15)},
            success="ok",
            message="words",
            within_s=5.0,
        )
    ),
    "take_thermal_picture": ActionBinding(
        topics={
            "canopy_temperature": NextMessage(
                topic="canopy",
                type="sensor_msgs/msg/Temperature",
                value=FieldBinding(path="temperature"),
                within_s=4.0,
            )
        }
    ),
}


def bindings(**changes: Any) -> Ros2Bindings:
    """Of the robot below."""
    whole = Ros2Bindings(
        distro="jazzy",
        namespace="/husky",
        navigation=NavigationBinding(
            action="navigate_to_pose", type="nav2_msgs/action/NavigateToPose", datum=DATUM, tolerance_m=0.3
        ),
        position=PositionBinding(fix=TopicBinding(topic="fix", type="sensor_msgs/msg/NavSatFix", stale_s=2.0)),
        battery=BatteryBinding(
            topic=TopicBinding(topic="battery", type="sensor_msgs/msg/BatteryState", stale_s=5.0),
            value=FieldBinding(path="percentage", scale=100.0),
        ),
        odometry=TopicBinding(topic="odom", type="nav_msgs/msg/Odometry", stale_s=2.0),
        stop=StopBinding(topic=TopicBinding(topic="stop", type="std_msgs/msg/Bool", stale_s=5.0), path="data"),
        actions=ACTIONS,
        interfaces=INTERFACES,
    )
    return replace(whole, **changes)


def navigating(**changes: Any) -> NavigationBinding:
    return replace(bindings().navigation, **changes)


@cache
def interfaces(distro: Any = "jazzy") -> Interfaces:
    return Interfaces.of(distro, INTERFACES)


SAMPLED = Script(lasts_s=2.0, result={"ok": True, "co2": (0.0, 0.0412)})


@dataclass
class Robot:
    """The robot's end. Everything that it does wrong is a switch."""

    node: Transport
    clock: SimulatedClock
    bound: Ros2Bindings
    xy: tuple[float, float] = SITE.start.xy
    percentage: float = 0.9
    fix_status: int = 0
    sigma_m: float = 0.02
    pressed: bool = False
    silent: set[str] = field(default_factory=set)
    blocked: Callable[[tuple[float, float]], bool] = lambda xy: False
    lost: Callable[[Robot], bool] = lambda robot: False
    ends: str = "succeeded"
    result: dict[str, object] = field(default_factory=dict)
    refuses_cancel: bool = False
    sample: Script = SAMPLED
    reading: Callable[[RosMessage], RosMessage | None] = lambda request: {"ok": True, "kelvin": 298.15}
    canopy: float | None = 31.5
    shift_m: float = 0.0
    fix_every: int = 1
    map_turned_deg: float = 0.0
    fix_shift_m: float = 0.0
    accepts: bool = True
    is_lost: bool = False
    driven_m: float = 0.0
    limits: list[float] = field(default_factory=list)
    way: list[tuple[float, float]] = field(default_factory=list)

    def __post_init__(self) -> None:
        b, name = self.bound, self.bound.whole_name
        self.navigation = ScriptedAction(
            self.node, name(b.navigation.action), b.navigation.type, self.clock.now, self._set_out
        )
        self.sampler = ScriptedAction(self.node, name("sample"), SAMPLE, self.clock.now, lambda goal: self.sample)
        self.thermometer = self.node.serve("/thermometer", READ)
        self.from_ll = self.node.serve(name("fromLL"), FROM_LL)
        self.heard = self.node.subscribe(name("speed_limit"), SPEED_LIMIT, QosProfile())
        sensor = QosProfile(reliable=False, depth=5)
        self.topics = {
            short: self.node.publish(name(short), type_name, sensor)
            for short, type_name in (
                ("fix", "sensor_msgs/msg/NavSatFix"),
                ("battery", "sensor_msgs/msg/BatteryState"),
                ("odom", "nav_msgs/msg/Odometry"),
                ("stop", "std_msgs/msg/Bool"),
                ("canopy", "sensor_msgs/msg/Temperature"),
            )
        }
        self._ticks = itertools.count()

    def step(self) -> None:
        if isinstance(self.node, Node) and self.node.vanished_s is not None:
            return
        number, self.is_lost = next(self._ticks), self.lost(self)
        self.navigation.step()
        self.sampler.step()
        self._drive()
        self._serve()
        if number % self.fix_every == 0:
            lat, lon = SITE.projection.degrees([(self.xy[0] + self.fix_shift_m, self.xy[1])])[0]
            status = -1 if self.is_lost else self.fix_status
            covariance = (self.sigma_m**2, 0.0, 0.0, 0.0, self.sigma_m**2, 0.0, 0.0, 0.0, 1.0)
            self._say("fix", {
                "status": {"status": status}, "latitude": float(lat), "longitude": float(lon),
                "position_covariance": covariance, "position_covariance_type": 2,
            })  # fmt: skip
            self._say("odom", {"pose": {"pose": {"position": {"x": 100.0 + self.driven_m, "y": 5.0}}}})
        if number % 5 == 0:
            self.percentage -= 1e-6
            self._say("battery", {"percentage": self.percentage})
            self._say("stop", {"data": self.pressed})
        if number % 10 == 0 and self.canopy is not None:
            self._say("canopy", {"temperature": self.canopy})

    def _say(self, short: str, message: RosMessage) -> None:
        if short not in self.silent:
            self.topics[short].send(message)

    def _serve(self) -> None:
        self.limits += [float(str(m["speed_limit"])) for m in self.heard.take()]
        for to, request in self.thermometer.requests():
            if (response := self.reading(request)) is not None:
                self.thermometer.reply(to, response)
        for to, request in self.from_ll.requests():
            point: Any = request["ll_point"]
            x, y = into_map((point["latitude"], point["longitude"]))
            self.from_ll.reply(to, {"map_point": {"x": x, "y": y, "z": 0.0}})

    def _set_out(self, goal: Any) -> Script:
        """A goal of Nav2: it lasts until the robot is there."""
        self.way = [(x + self.shift_m, y) for x, y in self._corners(goal)]
        return Script(
            accepts=self.accepts,
            lasts_s=math.inf,
            feedback_every_s=0.2,
            cancels=not self.refuses_cancel,
            cancel_takes_s=0.3,
            result={},
            feedback=self._feedback,
        )

    def _feedback(self) -> RosMessage:
        if "GPS" in self.bound.navigation.type:
            return {}
        x, y = into_map(SITE.projection.degrees([self.xy])[0])
        turn = math.radians(self.map_turned_deg)
        at = {"x": x * math.cos(turn) - y * math.sin(turn), "y": x * math.sin(turn) + y * math.cos(turn)}
        return {"current_pose": {"header": {"frame_id": "map"}, "pose": {"position": at}}}

    def _corners(self, goal: Any) -> list[tuple[float, float]]:
        if "gps_poses" in goal:
            degrees = [(p["position"]["latitude"], p["position"]["longitude"]) for p in goal["gps_poses"]]
            return [in_site(d) for d in degrees]
        poses = goal["poses"] if "poses" in goal else (goal["pose"],)
        points = [p["pose"]["position"] for p in (poses["goals"] if isinstance(poses, dict) else poses)]
        return [in_site(out_of_map((p["x"], p["y"]))) for p in points]

    def _drive(self) -> None:
        going = self.navigation.executing
        if not going or going[-1].cancelled_s is not None or self.pressed or self.is_lost:
            return
        left = TICK_S * SPEED
        while self.way and left > 1e-9:
            away = math.dist(self.xy, self.way[0])
            part = min(1.0, left / away) if away > 0 else 1.0
            there = tuple(a + part * (b - a) for a, b in zip(self.xy, self.way[0], strict=True))
            if self.blocked((there[0], there[1])):
                self._over(going[-1], "aborted", {"error_code": 208, "error_msg": "no valid path"})
                return
            self.driven_m += part * away
            left -= part * away
            self.xy = (there[0], there[1])
            if part == 1.0:
                self.way.pop(0)
        if not self.way:
            self._over(going[-1], self.ends, self.result)

    def _over(self, goal: Any, state: str, result: dict[str, object]) -> None:
        goal.script = replace(goal.script, result=result, lasts_s=0.0, ends=state)


class RobotClock(SimulatedClock):
    """Time passes for the robot, too."""

    def __init__(self) -> None:
        super().__init__()
        self.robots: list[Robot] = []

    def advance(self, seconds: float) -> None:
        until = self.now() + max(0.0, seconds)
        while self.now() < until - 1e-9:
            super().advance(min(TICK_S, until - self.now()))
            for robot in self.robots:
                robot.step()


@dataclass
class World:
    """A robot, what connects it with a computer, and the profile of both."""

    clock: RobotClock
    graph: Graph
    robot: Robot
    computer: Node
    profile: RobotProfile

    def connect(self, **changes: Any) -> Ros2Driver:
        options: dict[str, Any] = {
            "clock": self.clock, "steady": self.clock.now, "sleep": self.clock.advance, "look_every_s": 0.2
        }  # fmt: skip
        bound = self.profile.ros2
        assert bound is not None
        return Ros2Driver.connect(self.computer, interfaces(bound.release), SITE, self.profile, **options | changes)


def world(bound: Ros2Bindings | None = None, *, seed: int = 0, **switches: Any) -> World:
    bound = bound or bindings()
    clock = RobotClock()
    types = interfaces(bound.release)
    checked: dict[str, set[str]] = {}

    def complete(type_name: str, message: RosMessage) -> RosMessage:
        """Check messages that are sent ten times a second against their type the first time only."""
        if not type_name.startswith(("sensor_msgs/", "nav_msgs/", "std_msgs/")):
            return types.complete(type_name, message)
        if checked.get(type_name) != set(message):
            types.complete(type_name, message)
            checked[type_name] = set(message)
        return message

    graph = Graph(clock.now, seed=seed, complete=complete)
    robot = Robot(graph.node(), clock, bound, **switches)
    clock.robots.append(robot)
    return World(clock, graph, robot, graph.node(), replace(husky(), ros2=bound, speed_m_s=SPEED))


def in_site(degrees: tuple[float, float]) -> tuple[float, float]:
    x, y = SITE.projection.metres(*degrees)[0]
    return float(x), float(y)


def into_map(degrees: tuple[float, float]) -> tuple[float, float]:
    """As a map whose x axis leads DATUM.heading_deg clockwise from north has it."""
    east, north = Projection(DATUM.lat, DATUM.lon).metres(*degrees)[0]
    turn = math.radians(DATUM.heading_deg - 90.0)
    return (
        float(east * math.cos(turn) - north * math.sin(turn)),
        float(east * math.sin(turn) + north * math.cos(turn)),
    )


def out_of_map(xy: tuple[float, float]) -> tuple[float, float]:
    turn = math.radians(90.0 - DATUM.heading_deg)
    east = xy[0] * math.cos(turn) - xy[1] * math.sin(turn)
    north = xy[0] * math.sin(turn) + xy[1] * math.cos(turn)
    lat, lon = Projection(DATUM.lat, DATUM.lon).degrees([(east, north)])[0]
    return float(lat), float(lon)
