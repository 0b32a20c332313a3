"""The DDS transport, against another process over real DDS on the loopback interface."""

from __future__ import annotations

import os
import runpy
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from cyclonedds.core import DDSException

from fieldhand.errors import InputError, Ros2Error
from fieldhand.execution.drivers.ros2.dds import names, open_dds, services
from fieldhand.execution.drivers.ros2.dds.transport import DdsTransport
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.transport import SENSOR_QOS, STATUS_QOS, QosProfile
from ros2.other_process import SUM
from support.processes.patience import until

RELIABLE, MANY = QosProfile(), QosProfile(depth=1000)


@pytest.fixture(scope="module")
def other(domain: int) -> Iterator[subprocess.Popen[str]]:
    program = Path(__file__).with_name("other_process.py")
    search = os.pathsep.join(p for p in sys.path if p)
    with subprocess.Popen(
        [sys.executable, program],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": search},
    ) as process:
        assert process.stdout is not None
        assert process.stdin is not None
        assert process.stdout.readline() == "ready\n"
        yield process
        process.stdin.close()


@pytest.fixture(scope="module")
def node(other: subprocess.Popen[str]) -> Iterator[DdsTransport]:
    node = open_dds(Interfaces.of("jazzy", SUM))
    yield node
    node.close()
    node.close()


def test_a_service_answers_each_request_with_its_number(node: DdsTransport) -> None:
    one, two = (node.client("/sum", "test_msgs/srv/Sum") for _ in range(2))
    until(lambda: one.servers() == two.servers() == 1)
    for n in range(20):
        numbers = one.ask({"terms": (n, 0.5), "mark": b"one!"}), two.ask({"terms": (n,), "mark": b"two!"})
        (first,), (second,) = until(one.replies), until(two.replies)
        assert first == (numbers[0], {"sum": n + 0.5, "mark": b"one!"})
        assert second == (numbers[1], {"sum": n, "mark": b"two!"})
    assert one.replies() == two.replies() == ()
    one.close()
    one.close()
    assert one.servers() == 0
    assert one.replies() == ()
    two.close()


def test_a_service_without_any_field(node: DdsTransport) -> None:
    client = node.client("/nothing", "std_srvs/srv/Empty")
    until(client.servers)
    number = client.ask({})
    assert until(client.replies) == ((number, {}),)


def test_who_comes_late_gets_what_was_sent_before_where_it_is_kept(node: DdsTransport) -> None:
    late = node.subscribe("/status", "action_msgs/msg/GoalStatusArray", STATUS_QOS)
    (status,) = until(late.take)
    assert [s["status"] for s in status["status_list"]] == [4]  # type: ignore[attr-defined]
    assert late.take() == ()


def test_messages_arrive_in_their_order_and_of_many_the_newest_are_kept(node: DdsTransport) -> None:
    say = node.publish("/say", "std_msgs/msg/String", MANY)
    echo = node.subscribe("/echo", "std_msgs/msg/String", MANY)
    newest = node.subscribe("/echo", "std_msgs/msg/String", QosProfile(depth=3))

    def hello() -> bool:
        """We may have found the other side before it has found us."""
        say.send({"data": "hello"})
        return echo.take() != () and newest.take() != ()

    until(hello)
    said = [f"{n} ü" for n in range(30)]
    for text in said:
        say.send({"data": text})
    heard: list[object] = []
    until(lambda: heard.extend(m["data"] for m in echo.take() if m["data"] != "hello") or len(heard) >= 30)
    assert heard == said
    assert [m["data"] for m in until(newest.take)] == said[-3:]
    with pytest.raises(Ros2Error, match=r"^data: '3' \(int\) is not a string"):
        say.send({"data": 3})
    say.close()
    say.send({"data": "after its end"})
    assert say.subscribers() == 0


def test_a_quality_that_does_not_match_is_no_match_and_is_seen(node: DdsTransport) -> None:
    reader = node.subscribe("/best_effort", "std_msgs/msg/String", RELIABLE)
    (peer,) = until(lambda: node.writers_of("/best_effort"))
    assert (peer.qos.reliable, peer.qos.transient, peer.rmw) == (False, False, "cyclonedds")
    assert reader.publishers() == 0
    fits = node.subscribe("/best_effort", "std_msgs/msg/String", SENSOR_QOS)
    until(lambda: fits.publishers() == 1)
    assert reader.publishers() == 0


def test_another_type_is_no_match_and_is_seen_with_its_hash(node: DdsTransport) -> None:
    reader = node.subscribe("/number", "std_msgs/msg/String", RELIABLE)
    (peer,) = until(lambda: node.writers_of("/number"))
    assert peer.type == "std_msgs/msg/Int32"
    assert peer.type_hash == node.interfaces.type_hash("std_msgs/msg/Int32")
    fits = node.subscribe("/best_effort", "std_msgs/msg/String", SENSOR_QOS)
    until(lambda: fits.publishers() == 1)
    assert reader.publishers() == 0


def test_servers_are_seen_and_what_nobody_offers_is_not(node: DdsTransport) -> None:
    (peer,) = until(lambda: node.servers_of("/sum"))
    assert peer.type == "test_msgs/srv/Sum"
    assert node.servers_of("/product") == node.writers_of("/sum") == ()
    assert node.client("/product", "test_msgs/srv/Sum").servers() == 0


def test_a_server_of_another_type_does_not_count(node: DdsTransport) -> None:
    wrong = node.client("/sum", "std_srvs/srv/Trigger")
    right = node.client("/sum", "test_msgs/srv/Sum")
    until(right.servers)
    assert wrong.servers() == 0


def test_a_server_whose_middleware_does_not_understand_requests_does_not_count(
    node: DdsTransport, monkeypatch: pytest.MonkeyPatch
) -> None:
    until(node.client("/sum", "test_msgs/srv/Sum").servers)
    monkeypatch.setattr(services, "rmw_of", lambda _: "fastrtps")
    assert node.client("/sum", "test_msgs/srv/Sum").servers() == 0


def test_half_a_server_does_not_count(node: DdsTransport, domain: int) -> None:
    """A server that hears requests and cannot be heard: replies would get lost."""
    client = node.client("/half", "std_srvs/srv/Empty")
    server = open_dds(node.interfaces, domain)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(names, "reply_name", lambda _: "rr/elsewhereReply")
        server.serve("/half", "std_srvs/srv/Empty")
    until(lambda: node.servers_of("/half"))
    whole = server.serve("/other_half", "std_srvs/srv/Empty")
    other = node.client("/other_half", "std_srvs/srv/Empty")
    until(lambda: other.servers() == 1)
    assert client.servers() == 0
    whole.close()
    until(lambda: other.servers() == 0)
    server.close()


def test_a_reply_waits_until_its_client_can_hear_it(node: DdsTransport, monkeypatch: pytest.MonkeyPatch) -> None:
    robot = open_dds(node.interfaces)
    server, client = robot.serve("/late", "std_srvs/srv/Trigger"), node.client("/late", "std_srvs/srv/Trigger")
    until(client.servers)
    number = client.ask({})
    ((asked, _),) = until(server.requests)
    with monkeypatch.context() as patch:
        patch.setattr(server._clients, "ids", set)  # its reader is not found yet
        server.reply(asked, {"message": "at last"})
        assert server.requests() == ()
    assert server.requests() == ()
    assert until(client.replies) == ((number, {"success": False, "message": "at last"}),)
    robot.close()


def test_a_network_that_cannot_be_used_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CYCLONEDDS_URI", os.environ["CYCLONEDDS_URI"].replace('"lo"', '"no-such-one"'))
    with pytest.raises(Ros2Error, match="no node can be created on DDS domain 99; check the network interfaces"):
        open_dds(Interfaces.of("humble"), 99)


def test_a_message_that_finds_no_room_is_lost_and_one_that_is_not_taken_is_said(
    node: DdsTransport, monkeypatch: pytest.MonkeyPatch
) -> None:
    say = node.publish("/say", "std_msgs/msg/String")

    def refused(code: int) -> Callable[[object], None]:
        def write(_: object) -> None:
            raise DDSException(code, "while writing")

        return write

    monkeypatch.setattr(say._writer, "write", refused(DDSException.DDS_RETCODE_TIMEOUT))
    say.send({"data": "lost"})
    monkeypatch.setattr(say._writer, "write", refused(DDSException.DDS_RETCODE_ERROR))
    with pytest.raises(Ros2Error, match="DDS does not send this message"):
        say.send({"data": "refused"})


def test_unknown_types_and_names_are_refused_in_words(node: DdsTransport) -> None:
    for make in (node.subscribe, node.publish):
        with pytest.raises(Ros2Error, match="the type no_msgs/msg/Such is not known here"):
            make("/x", "no_msgs/msg/Such")
    for make in (node.client, node.serve):
        with pytest.raises(Ros2Error, match="the type no_msgs/srv/Such is not known here"):
            make("/x", "no_msgs/srv/Such")
        with pytest.raises(Ros2Error, match="'x y' is not a valid topic or service name"):
            make("x y", "std_srvs/srv/Empty")


@pytest.mark.parametrize("text", ["-1", "233", "two", "1.5", "²"])
def test_a_domain_that_is_none_is_refused(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", text)
    with pytest.raises(InputError, match=r"ROS_DOMAIN_ID: .* is not a DDS domain; give a number from 0 to 232"):
        open_dds(Interfaces.of("humble"))


def test_without_the_extra_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    interfaces = Interfaces.of("humble")
    monkeypatch.setitem(sys.modules, "rosbags.typesys", None)
    monkeypatch.delitem(sys.modules, "fieldhand.execution.drivers.ros2.dds.transport", raising=False)
    monkeypatch.setitem(sys.modules, "cyclonedds.domain", None)
    with pytest.raises(InputError, match=r'pip install "fieldhand\[ros2-dds\]"'):
        Interfaces.of("humble")
    with pytest.raises(InputError, match=r'pip install "fieldhand\[ros2-dds\]"'):
        open_dds(interfaces)


def test_no_call_and_no_goal_is_lost(domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Some of those that the script makes; it makes a thousand and two hundred where it is run by itself."""
    script = runpy.run_path(str(Path(__file__).parents[2] / "scripts/ros2_latency.py"))
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(p for p in sys.path if p))
    calls, goals = script["measured"](100, 20, 5)
    assert (len(calls), len(goals)) == (100, 20)
    assert None not in calls + goals
