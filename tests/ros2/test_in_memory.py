"""The graph in memory has the faults that it is asked for, and no others: what stands on it is tested by them."""

from __future__ import annotations

from fieldhand.clock import SimulatedClock
from fieldhand.execution.drivers.ros2.transport import SENSOR_QOS, STATUS_QOS, QosProfile
from ros2.in_memory import Disturbed, Graph

STRING = "std_msgs/msg/String"
TRIGGER = "std_srvs/srv/Trigger"


def test_a_service_answers_each_request_by_its_number() -> None:
    graph = Graph(SimulatedClock().now)
    server, client = graph.node().serve("/ask", TRIGGER), graph.node().client("/ask", TRIGGER)
    numbers = [client.ask({"n": n}) for n in range(3)]
    for to, request in reversed(server.requests()):
        server.reply(to, {"n": request["n"]})
    assert dict(client.replies()) == {number: {"n": n} for n, number in enumerate(numbers)}
    assert client.replies() == ()


def test_endpoints_match_by_type_and_quality_and_discovery_shows_those_that_do_not() -> None:
    graph = Graph(SimulatedClock().now)
    robot, computer = graph.node(rmw="fastrtps"), graph.node()
    robot.publish("/a", STRING, SENSOR_QOS)
    robot.publish("/a", "std_msgs/msg/Bool")
    robot.serve("/ask", TRIGGER)
    assert computer.subscribe("/a", STRING, SENSOR_QOS).publishers() == 1
    assert computer.subscribe("/a", STRING, QosProfile()).publishers() == 0
    assert [p.type for p in computer.writers_of("/a")] == [STRING, "std_msgs/msg/Bool"]
    client = computer.client("/ask", TRIGGER)
    client.ask({})
    assert client.servers() == 1
    assert [p.rmw for p in computer.servers_of("/ask")] == ["fastrtps"]


def test_what_is_sent_before_two_found_each_other_is_lost_and_what_is_kept_is_not() -> None:
    clock = SimulatedClock()
    graph = Graph(clock.now, found_s=1.0)
    writer = graph.node().publish("/a", STRING, STATUS_QOS)
    reader = graph.node().subscribe("/a", STRING, SENSOR_QOS)
    writer.send({"data": "early"})
    clock.advance(1.0)
    writer.send({"data": "late"})
    assert reader.take() == ({"data": "late"},)
    assert graph.node().subscribe("/a", STRING, STATUS_QOS).take() == ({"data": "late"},)


def test_messages_get_lost_come_twice_and_late_as_asked() -> None:
    clock = SimulatedClock()
    graph = Graph(clock.now, seed=1)
    graph.disturb("/lost", Disturbed(loss=1.0))
    graph.disturb("/twice", Disturbed(twice=1.0))
    graph.disturb("/late", Disturbed(delay_s=(2.0, 2.0)))
    node, other = graph.node(), graph.node()
    readers = {name: other.subscribe(name, STRING) for name in ("/lost", "/twice", "/late")}
    for name in readers:
        node.publish(name, STRING).send({"data": name})
    assert {name: len(r.take()) for name, r in readers.items()} == {"/lost": 0, "/twice": 2, "/late": 0}
    clock.advance(2.0)
    assert len(readers["/late"].take()) == 1


def test_a_node_that_vanished_is_silent_at_once_and_noticed_later() -> None:
    clock = SimulatedClock()
    graph = Graph(clock.now, noticed_s=10.0)
    robot = graph.node()
    server, client = robot.serve("/ask", TRIGGER), graph.node().client("/ask", TRIGGER)
    robot.vanish()
    client.ask({})
    assert server.requests() == ()
    assert client.servers() == 1
    clock.advance(10.0)
    assert client.servers() == 0
