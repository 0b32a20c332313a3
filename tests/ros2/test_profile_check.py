"""``robot check``: every binding is tried; what is missing or wrong is said, with what to do, and nothing else is."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from dataclasses import replace

import pytest

from fieldhand.errors import ProfileError
from fieldhand.execution.drivers.ros2.dds import open_dds
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.profile_check import ProfileReport, bindings_of, check_live, check_types
from fieldhand.execution.drivers.ros2.transport import SENSOR_QOS, STATUS_QOS, RosMessage, Transport
from fieldhand.robot.bindings import FieldBinding
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from ros2.in_memory import Graph
from support.processes.command import fieldhand
from support.processes.patience import LONG_S

HUSKY = load_robot("husky")
INTERFACES = Interfaces.of("humble", bindings_of(HUSKY).interfaces)
SAYS: dict[str, tuple[str, RosMessage]] = {
    "/gps/fix": ("sensor_msgs/msg/NavSatFix", {"latitude": 52.1, "longitude": 5.6}),
    "/battery_state": ("sensor_msgs/msg/BatteryState", {"percentage": 0.83}),
    "/odometry/filtered": ("nav_msgs/msg/Odometry", {}),
    "/platform/emergency_stop": ("std_msgs/msg/Bool", {"data": False}),
    "/air_temperature": ("sensor_msgs/msg/Temperature", {"temperature": 19.5}),
}
ACTIONS = {
    "/navigate_to_pose": "nav2_msgs/action/NavigateToPose",
    "/thermal_camera/take_picture": "fieldhand_husky/action/TakeThermalPicture",
}


def robot(node: Transport, says: dict[str, tuple[str, RosMessage]] = SAYS, without: str = "") -> Callable[[], None]:
    """A Husky; what is returned lets it speak once."""
    for action, of in ACTIONS.items():
        if action != without:
            node.serve(f"{action}/_action/send_goal", f"{of}_SendGoal")
            node.serve(f"{action}/_action/get_result", f"{of}_GetResult")
            node.serve(f"{action}/_action/cancel_goal", "action_msgs/srv/CancelGoal")
            node.publish(f"{action}/_action/feedback", f"{of}_FeedbackMessage")
            node.publish(f"{action}/_action/status", "action_msgs/msg/GoalStatusArray", STATUS_QOS)
    maps = node.serve("/fromLL", "robot_localization/srv/FromLL")
    if without != "/co2_sensor/read":
        node.serve("/co2_sensor/read", "fieldhand_husky/srv/ReadCo2")
    if without != "/speed_limit":
        node.subscribe("/speed_limit", "nav2_msgs/msg/SpeedLimit")
    topics = [(node.publish(n, of, SENSOR_QOS), message) for n, (of, message) in says.items() if n != without]

    def speak() -> None:
        for topic, message in topics:
            topic.send(message)
        for asked, request in maps.requests():
            assert request == {"ll_point": {"latitude": 52.1, "longitude": 5.6, "altitude": 0.0}}
            maps.reply(asked, {"map_point": {"x": 1.0}})

    return speak


class Clock:
    """Time that passes while somebody waits, and lets the robot speak."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self.meanwhile: list[Callable[[], None]] = []

    def now(self) -> float:
        return self.now_s

    def sleep(self, seconds: float) -> None:
        self.now_s += seconds
        for does in self.meanwhile:
            does()


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def graph(clock: Clock) -> Graph:
    def whole(message: str, given: RosMessage) -> RosMessage:
        return INTERFACES.complete(message, given)

    return Graph(clock.now, complete=whole)


def checked(graph: Graph, clock: Clock, *speak: Callable[[], None], profile: RobotProfile = HUSKY) -> ProfileReport:
    clock.meanwhile = list(speak)
    return check_live(profile, graph.node(), INTERFACES, within_s=1.5, steady=clock.now, sleep=clock.sleep)


def test_a_robot_that_is_what_its_profile_says(graph: Graph, clock: Clock) -> None:
    report = checked(graph, clock, robot(graph.node()))
    assert report.missing == ()
    assert report.rmw == ("cyclonedds",)
    assert {f.binding.part: f.what for f in report.endpoints} == {
        "navigation": "there",
        "navigation: from_ll": "answers",
        "navigation: speed_limit": "heard",
        "position": "52.100000, 5.600000",
        "battery": "83 %",
        "odometry": "0.00, 0.00 m",
        "stop": "not stopped",
        "actions: take_thermal_picture": "there",
        "actions: read_ambient_temperature: ambient_temperature": "19.5 degC",
        "actions: read_co2": "there",
    }
    assert clock.now_s < 1.5  # it waits only for what is not there


@pytest.mark.parametrize("name", [*SAYS, *ACTIONS, "/co2_sensor/read", "/speed_limit"])
def test_what_is_missing_is_named_and_nothing_else(graph: Graph, clock: Clock, name: str) -> None:
    report = checked(graph, clock, robot(graph.node(), without=name))
    missing = [f for f in report.missing if f.binding.name != "/fromLL"]
    assert [f.binding.name for f in missing] == [name]
    assert missing[0].what.startswith("there is no ")
    assert ("check whether its node is active" if name == "/speed_limit" else "ROS_DOMAIN_ID") in missing[0].advice


@pytest.mark.parametrize(
    ("name", "message", "what", "advice"),
    [
        ("/gps/fix", {"status": {"status": -1}}, "no satellite fix", "better fix"),
        ("/gps/fix", {"latitude": 91.0}, "no satellite fix", "better fix"),
        ("/gps/fix", {"position_covariance": [9.0] * 9, "position_covariance_type": 2}, "3.0 m", "most_sigma_m"),
        ("/battery_state", {"percentage": float("nan")}, "percentage is nan", "another field"),
        ("/battery_state", {"percentage": 83.0}, "8300 % is not a valid charge", "scale"),
        ("/odometry/filtered", {"pose": {"pose": {"position": {"x": float("inf")}}}}, "position.x is inf", "another"),
        ("/platform/emergency_stop", {"data": True}, "the robot is stopped", "release"),
        ("/air_temperature", {"temperature": 292.0}, "292 degC is outside", "unit, scale"),
    ],
)
def test_what_cannot_be_meant_is_said(
    graph: Graph, clock: Clock, name: str, message: RosMessage, what: str, advice: str
) -> None:
    report = checked(graph, clock, robot(graph.node(), {**SAYS, name: (SAYS[name][0], message)}))
    found = {f.binding.name: f for f in report.missing}[name]
    assert what in found.what
    assert advice in found.advice


def test_a_part_of_one_where_percent_are_meant(graph: Graph, clock: Clock) -> None:
    ros2 = bindings_of(HUSKY)
    unscaled = replace(ros2, battery=replace(ros2.battery, value=FieldBinding(path="percentage")))
    report = checked(graph, clock, robot(graph.node()), profile=replace(HUSKY, ros2=unscaled))
    assert [(f.binding.part, f.what) for f in report.missing] == [("battery", "0.83 % is nearly empty")]


def test_who_is_there_and_silent(graph: Graph, clock: Clock) -> None:
    robot(graph.node())
    report = checked(graph, clock)
    assert {f.what for f in report.missing if f.binding.kind == "topic"} == {"it is there, but sent no message"}
    assert len(report.missing) == len(SAYS)  # the map service is not asked where nobody knows


def test_a_middleware_that_cannot_be_called_and_two_robots(graph: Graph, clock: Clock) -> None:
    first = robot(graph.node(rmw="fastrtps"))
    report = checked(graph, clock, first)
    assert report.rmw == ("fastrtps",)
    assert {f.binding.kind for f in report.missing} == {"action", "service"}
    assert all("rmw_cyclonedds_cpp on the robot" in f.advice for f in report.missing)
    again = Graph(clock.now, complete=graph.complete)
    one, two = robot(again.node()), robot(again.node())
    doubled = checked(again, clock, one, two)
    assert all("2 servers answer it" in f.what for f in doubled.missing)
    assert len(doubled.missing) == 4


def test_over_dds_it_finds_the_same(domain: int) -> None:
    """With namespace, so that no other test's robot is met."""
    profile = replace(HUSKY, ros2=replace(bindings_of(HUSKY), namespace="/ns"))
    robot_node, node = open_dds(INTERFACES), open_dds(INTERFACES)

    class Below:
        """The robot's names, below the namespace."""

        def __getattr__(self, name: str) -> Callable[..., object]:
            return lambda topic, *rest: getattr(robot_node, name)(f"/ns{topic}", *rest)

    speak = robot(Below())  # type: ignore[arg-type]

    def sleep(seconds: float) -> None:
        speak()
        time.sleep(seconds)

    report = check_live(profile, node, INTERFACES, within_s=LONG_S, steady=time.monotonic, sleep=sleep)
    node.close()
    robot_node.close()
    assert [(f.binding.part, f.what, f.advice) for f in report.missing] == []
    assert report.rmw == ("cyclonedds",)


def test_types_are_checked_without_a_robot() -> None:
    assert check_types(HUSKY, INTERFACES).missing == ()
    ros2 = bindings_of(HUSKY)
    picture = ros2.actions["take_thermal_picture"]
    assert picture.call is not None
    wrong = replace(
        picture.call,
        request={"tree": "$place", "kind": 3.0},
        readings={"canopy_temperature": FieldBinding(path="message")},
        success="done",
    )
    profile = replace(HUSKY, ros2=replace(ros2, actions={"take_thermal_picture": replace(picture, call=wrong)}))
    (found,) = check_types(profile, INTERFACES).missing
    assert "has no field 'tree'" in found.what
    assert "message of fieldhand_husky/action/TakeThermalPicture is string, not a number" in found.what
    assert "has no 'done'" in found.what
    (unknown,) = check_types(profile, Interfaces.of("humble")).missing
    assert unknown.what == "the type fieldhand_husky/action/TakeThermalPicture is not known here"
    with pytest.raises(ProfileError, match="does not define how the robot is reached over ROS 2"):
        check_types(replace(HUSKY, ros2=None), INTERFACES)


def test_the_command_says_it_line_by_line() -> None:
    fits = fieldhand("robot", "check", "husky")
    assert (fits.status, fits.err) == (0, "")
    assert fits.out.splitlines()[-1] == "All 10 bindings of husky fit their types; --live tries them."
    alone = fieldhand("robot", "check", "husky", "--live", "--within", "1", "--json")
    assert alone.status == 1
    record = json.loads(alone.out)
    assert (record["usable"], record["live"], record["rmw"], len(record["bindings"])) == (False, True, [], 10)
    missing = {f"there is no {endpoint}" for endpoint in ("publisher", "server", "subscriber")}
    assert {b["what"] for b in record["bindings"]} == missing
    below = fieldhand("robot", "check", "husky", "--namespace", "robot7", "--json")
    assert "/robot7/navigate_to_pose" in {b["name"] for b in json.loads(below.out)["bindings"]}
    refused = fieldhand("robot", "check", "husky", "--live", "--on", "tcp")
    assert (refused.status, refused.out) == (2, "")
    assert "no transport 'tcp'" in refused.err
