"""The rclpy transport, against another process on the other end of a real graph: rclpy's, or plain DDS; and the DDS
transport against rclpy. Skipped where no ROS 2 is sourced.

    . /opt/ros/jazzy/setup.bash && pytest tests/ros2/test_rclpy.py
"""

from __future__ import annotations

import math
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from fieldhand.errors import InputError, Ros2Error
from fieldhand.execution.drivers.ros2.rclpy import open_rclpy
from fieldhand.execution.drivers.ros2.transport import MOST_BYTES, SENSOR_QOS, STATUS_QOS, QosProfile, Transport
from ros2.other_end import SEND, TO_MAP, opened
from ros2.sourced import NOT_CYCLONE, graph, sourced
from support.processes.patience import until

RELIABLE = QosProfile()


@pytest.fixture(scope="module", autouse=True)
def domain() -> Iterator[int]:
    """A domain of its own, where those find each other that speak with everybody and those that ask one by one."""
    with graph(201 + os.getpid() % 30) as number:
        yield number


def _pair(here: str, there: str) -> object:
    other = pytest.mark.skipif("dds" in (here, there) and NOT_CYCLONE, reason="the middleware is not Cyclone DDS")
    return pytest.param((here, there), id=f"{here}-{there}", marks=[sourced, other])


@pytest.fixture(scope="module", params=[_pair("rclpy", "rclpy"), _pair("rclpy", "dds"), _pair("dds", "rclpy")])
def node(request: pytest.FixtureRequest, domain: int) -> Iterator[Transport]:
    here, there = request.param
    program = Path(__file__).with_name("other_end.py")
    search = os.pathsep.join(p for p in sys.path if p)
    with subprocess.Popen(
        [sys.executable, program, there],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": search},
    ) as process:
        assert process.stdout is not None
        assert process.stdin is not None
        assert process.stdout.readline() == "ready\n"
        node = opened(here)
        yield node
        node.close()
        node.close()
        process.stdin.close()


def test_a_service_answers_each_request_with_its_number(node: Transport) -> None:
    one, two = (node.client("/to_map", TO_MAP) for _ in range(2))
    until(lambda: one.servers() == two.servers() == 1)
    for n in range(20):
        numbers = (
            one.ask({"ll_point": {"latitude": n, "longitude": 0.5, "altitude": 1}}),
            two.ask({"ll_point": {"latitude": n}}),
        )
        (first,), (second,) = until(one.replies), until(two.replies)
        assert first == (numbers[0], {"map_point": {"x": n + 0.5, "y": 0.0, "z": 1.0}})
        assert second == (numbers[1], {"map_point": {"x": float(n), "y": 0.0, "z": 0.0}})
    assert one.replies() == two.replies() == ()
    one.close()
    one.close()
    assert one.servers() == 0
    assert one.replies() == ()
    two.close()


def test_a_goal_of_an_action_is_a_service_whose_fields_arrive_as_they_were(node: Transport) -> None:
    client = node.client("/send", SEND)
    until(client.servers)
    goal_id = bytes(range(240, 256))
    number = client.ask({"goal_id": {"uuid": goal_id}, "goal": {"behavior_tree": "ü"}})
    assert until(client.replies) == ((number, {"accepted": True, "stamp": {"sec": sum(goal_id), "nanosec": 0}}),)
    with pytest.raises(Ros2Error, match=r"^goal_id\.uuid: 3 values: uint8\[16\] has 16"):
        client.ask({"goal_id": {"uuid": b"abc"}})
    with pytest.raises(Ros2Error, match=r"^goal: nav2_msgs/action/\w+ has no field 'poses'; it has pose"):
        client.ask({"goal": {"poses": ()}})


def test_a_service_without_any_field(node: Transport) -> None:
    client = node.client("/nothing", "std_srvs/srv/Empty")
    until(client.servers)
    number = client.ask({})
    assert until(client.replies) == ((number, {}),)


def test_who_comes_late_gets_what_was_sent_before_where_it_is_kept(node: Transport) -> None:
    late = node.subscribe("/status", "action_msgs/msg/GoalStatusArray", STATUS_QOS)
    (status,) = until(late.take)
    assert [s["status"] for s in status["status_list"]] == [4]  # type: ignore[attr-defined]
    assert late.take() == ()


def test_messages_arrive_in_their_order_and_not_more_than_the_depth_at_once(node: Transport) -> None:
    kind = "std_msgs/msg/String"
    say, echo = node.publish("/say_text", kind), node.subscribe("/echo_text", kind, RELIABLE)
    until(lambda: say.subscribers() and echo.publishers())
    said = [f"{n} ü" for n in range(30)]
    heard: list[object] = []
    for at in range(0, 30, 5):
        for text in said[at : at + 5]:
            say.send({"data": text})
        until(lambda at=at: heard.extend(m["data"] for m in echo.take()) or len(heard) >= at + 5)
    assert heard == said
    with pytest.raises(Ros2Error, match=r"^data: '3' \(int\) is no string"):
        say.send({"data": 3})
    say.close()
    say.send({"data": "after its end"})
    assert say.subscribers() == 0


def test_every_kind_of_field_comes_back_as_it_was_sent(node: Transport) -> None:
    kind = "sensor_msgs/msg/NavSatFix"
    say, echo = node.publish("/say_fix", kind), node.subscribe("/echo_fix", kind, RELIABLE)
    until(lambda: say.subscribers() and echo.publishers())
    fix = {
        "header": {"stamp": {"sec": -5, "nanosec": 7}, "frame_id": "gps"},
        "status": {"status": -1, "service": 65535},
        "latitude": 36.5,
        "longitude": -math.inf,
        "altitude": 1e-300,
        "position_covariance": tuple(n / 3 for n in range(9)),
        "position_covariance_type": 2,
    }
    say.send(fix)
    assert until(echo.take) == (fix,)


def test_a_quality_that_does_not_match_is_no_match_and_is_seen(node: Transport) -> None:
    reader = node.subscribe("/best_effort", "std_msgs/msg/String", RELIABLE)
    (peer,) = until(lambda: node.writers_of("/best_effort"))
    assert (peer.qos.reliable, peer.qos.transient) == (False, False)
    assert peer.rmw == ("fastrtps" if NOT_CYCLONE else "cyclonedds")
    assert reader.publishers() == 0
    fits = node.subscribe("/best_effort", "std_msgs/msg/String", SENSOR_QOS)
    until(lambda: fits.publishers() == 1)
    assert reader.publishers() == 0


def test_another_type_is_no_match_and_is_seen(node: Transport) -> None:
    reader = node.subscribe("/number", "std_msgs/msg/String", RELIABLE)
    (peer,) = until(lambda: node.writers_of("/number"))
    assert peer.type == "std_msgs/msg/Int32"
    fits = node.subscribe("/best_effort", "std_msgs/msg/String", SENSOR_QOS)
    until(lambda: fits.publishers() == 1)
    assert reader.publishers() == 0


def test_servers_are_seen_and_what_nobody_offers_is_not(node: Transport) -> None:
    (peer,) = until(lambda: node.servers_of("/to_map"))
    assert peer.type == TO_MAP
    (peer,) = until(lambda: node.servers_of("/send"))
    assert peer.type == SEND
    assert node.servers_of("/product") == node.writers_of("/to_map") == ()
    right = node.client("/to_map", TO_MAP)
    until(right.servers)
    assert node.client("/product", TO_MAP).servers() == 0
    third = opened(node.name)
    wrong = third.client("/to_map", "std_srvs/srv/Trigger")
    until(lambda: third.servers_of("/to_map"))
    assert wrong.servers() == 0
    third.close()


def test_names_that_are_none_are_refused(node: Transport) -> None:
    for make in (node.client, node.serve):
        with pytest.raises(Ros2Error, match="'x y' is no name"):
            make("x y", "std_srvs/srv/Empty")
    with pytest.raises(Ros2Error, match="'x y' is no name"):
        node.subscribe("x y", "std_msgs/msg/String")


# --- what is rclpy's own ---------------------------------------------------------------------------------------------


@sourced
def test_what_is_not_sourced_is_refused_with_the_package_that_is_missing(domain: int) -> None:
    node = open_rclpy()
    with pytest.raises(Ros2Error, match="the package farm_msgs is not in the ROS that is sourced; install farm_msgs"):
        node.client("/sample", "farm_msgs/srv/Sample")
    with pytest.raises(Ros2Error, match="the package std_srvs that is sourced has no srv/Such"):
        node.serve("/x", "std_srvs/srv/Such")
    with pytest.raises(Ros2Error, match="'os' is not a ROS type"):
        node.subscribe("/x", "os")
    node.close()
    assert node.writers_of("/status") == node.servers_of("/x") == ()


@sourced
def test_what_is_too_large_or_no_message_hides_nothing(domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    node, robot = open_rclpy(), open_rclpy()
    heard = node.subscribe("/x", "sensor_msgs/msg/Image", RELIABLE)
    sent = robot.publish("/x", "sensor_msgs/msg/Image")
    until(sent.subscribers)
    sent.send({"data": bytes(MOST_BYTES)})
    sent.send({"data": b"\x00\xff"})
    (picture,) = until(heard.take)
    assert picture["data"] == b"\x00\xff"
    assert heard.unread == 1
    assert "bytes, more than" in heard.unreadable
    node.close()
    robot.close()


@sourced
def test_bytes_and_defaults_of_generated_classes(domain: int) -> None:
    from fieldhand.execution.drivers.ros2.rclpy import message_types

    status = "diagnostic_msgs/msg/DiagnosticStatus"
    made = message_types.to_ros(status, {"level": 2, "values": ({"key": "a"},)})
    assert (made.level, made.values[0].key) == (b"\x02", "a")
    assert message_types.from_ros(status, made)["level"] == 2
    goal = message_types.to_ros("geometry_msgs/msg/Pose", {})
    assert goal.orientation.w == 1.0, "what a message leaves out keeps the default of its type"


@sourced
def test_another_node_of_the_process_keeps_its_own_context(domain: int) -> None:
    import rclpy

    rclpy.init(args=["--ros-args", "-r", "__node:=theirs"])
    theirs = rclpy.create_node("ours")
    node = open_rclpy()
    until(lambda: {"theirs"} < set(theirs.get_node_names()))
    node.close()
    assert rclpy.ok()
    assert theirs.get_name() == "theirs"
    theirs.destroy_node()
    rclpy.shutdown()


def test_without_ros_it_says_what_to_do(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "fieldhand.execution.drivers.ros2.rclpy.transport", raising=False)
    monkeypatch.setitem(sys.modules, "rclpy.context", None)
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    with pytest.raises(InputError, match=r"no ROS 2 is sourced here.*without ROS, reach the robot by dds"):
        open_rclpy()
    monkeypatch.setenv("ROS_DISTRO", "humble")
    with pytest.raises(InputError, match=r"ROS 2 humble is sourced, but its rclpy cannot be loaded by Python 3"):
        open_rclpy()
