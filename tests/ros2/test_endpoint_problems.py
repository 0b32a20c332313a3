"""Whatever keeps an endpoint from being used is said in words, with what to do; what fits is not complained of."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fieldhand.execution.drivers.ros2.endpoint_problems import (
    EndpointProblem,
    action_problem,
    service_problem,
    topic_problem,
)
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.transport import SENSOR_QOS, STATUS_QOS, Peer, QosProfile, Rmw
from ros2.in_memory import Graph, Node

FIX, TRIGGER, NAVIGATE = "sensor_msgs/msg/NavSatFix", "std_srvs/srv/Trigger", "nav2_msgs/action/NavigateToPose"


@pytest.fixture
def graph() -> Graph:
    return Graph(lambda: 0.0)


@pytest.fixture
def here(graph: Graph) -> Node:
    return graph.node()


@pytest.fixture(scope="module")
def interfaces() -> Interfaces:
    return Interfaces.of("jazzy")


def serve_action(node: Node, *, without: str = "") -> None:
    for service, of in (("send_goal", "_SendGoal"), ("get_result", "_GetResult")):
        if service != without:
            node.serve(f"/go/_action/{service}", f"{NAVIGATE}{of}")
    if without != "cancel_goal":
        node.serve("/go/_action/cancel_goal", "action_msgs/srv/CancelGoal")
    if without != "feedback":
        node.publish("/go/_action/feedback", f"{NAVIGATE}_FeedbackMessage")
    if without != "status":
        node.publish("/go/_action/status", "action_msgs/msg/GoalStatusArray", STATUS_QOS)


def says(found: EndpointProblem | None, what: str, advice: str) -> None:
    assert found is not None
    assert what in found.what
    assert advice in found.advice
    assert str(found) == f"{found.what}; {found.advice}"


def test_nothing_speaks_against_what_fits(graph: Graph, here: Node, interfaces: Interfaces) -> None:
    robot = graph.node()
    robot.publish("/fix", FIX, SENSOR_QOS)
    robot.serve("/trigger", TRIGGER)
    serve_action(robot)
    assert topic_problem(here, interfaces, "/fix", FIX) is None
    assert service_problem(here, interfaces, "/trigger", TRIGGER) is None
    assert action_problem(here, interfaces, "/go", NAVIGATE) is None


def test_what_nobody_offers(here: Node, interfaces: Interfaces) -> None:
    says(topic_problem(here, interfaces, "/fix", FIX), "there is no publisher", "ROS_DOMAIN_ID")
    says(service_problem(here, interfaces, "/trigger", TRIGGER), "there is no server", "ROS_DOMAIN_ID")
    says(action_problem(here, interfaces, "/go", NAVIGATE), "there is no server", "ROS_DOMAIN_ID")


def test_another_type(graph: Graph, here: Node, interfaces: Interfaces) -> None:
    graph.node().publish("/fix", "std_msgs/msg/String")
    graph.node().serve("/trigger", "std_srvs/srv/SetBool")
    says(topic_problem(here, interfaces, "/fix", FIX), f"sent as std_msgs/msg/String, not as {FIX}", "correct the type")
    says(service_problem(here, interfaces, "/trigger", TRIGGER), "answered as std_srvs/srv/SetBool", "correct the type")


@pytest.mark.parametrize(
    ("offered", "wanted", "what"),
    [
        (QosProfile(reliable=False), QosProfile(), "best effort and read reliably"),
        (QosProfile(), QosProfile(transient=True), "volatile and read transient local"),
    ],
)
def test_a_quality_that_never_meets(
    graph: Graph, here: Node, interfaces: Interfaces, offered: QosProfile, wanted: QosProfile, what: str
) -> None:
    graph.node().publish("/fix", FIX, offered)
    says(topic_problem(here, interfaces, "/fix", FIX, wanted), what, "leave")
    graph.node().publish("/fix", FIX, wanted)
    assert topic_problem(here, interfaces, "/fix", FIX, wanted) is None


@pytest.mark.parametrize("rmw", ["fastrtps", "connext"])
def test_a_middleware_whose_services_are_not_heard(
    graph: Graph, here: Node, interfaces: Interfaces, rmw: Rmw, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot = graph.node(rmw=rmw)
    robot.publish("/fix", FIX)
    serve_action(robot)
    assert topic_problem(here, interfaces, "/fix", FIX) is None  # topics are
    found = action_problem(here, interfaces, "/go", NAVIGATE)
    says(found, f"the robot runs rmw_{rmw}", "set RMW_IMPLEMENTATION=rmw_cyclonedds_cpp on the robot")
    says(found, "cannot be called over the dds transport", "or reach it by rclpy from here")
    monkeypatch.setattr(Node, "name", "rclpy")
    found = action_problem(here, interfaces, "/go", NAVIGATE)
    says(found, f"the robot runs rmw_{rmw}", "set the robot's RMW_IMPLEMENTATION here, too")
    here.rmw = rmw
    assert action_problem(here, interfaces, "/go", NAVIGATE) is None


def test_two_robots_on_one_domain(graph: Graph, here: Node, interfaces: Interfaces) -> None:
    serve_action(graph.node())
    serve_action(graph.node())
    says(action_problem(here, interfaces, "/go", NAVIGATE), "2 servers answer it", "give each a namespace")


@pytest.mark.parametrize("part", ["get_result", "cancel_goal", "feedback", "status"])
def test_an_action_of_which_a_part_is_missing(graph: Graph, here: Node, interfaces: Interfaces, part: str) -> None:
    serve_action(graph.node(), without=part)
    says(action_problem(here, interfaces, "/go", NAVIGATE), f"its {part}: there is no", "start it")


def test_another_definition_of_the_same_name(
    graph: Graph, here: Node, interfaces: Interfaces, monkeypatch: pytest.MonkeyPatch
) -> None:
    graph.node().publish("/fix", FIX)
    (peer,) = here.writers_of("/fix")

    def saying(type_hash: str) -> tuple[Peer, ...]:
        return (replace(peer, type_hash=type_hash),)

    monkeypatch.setattr(here, "writers_of", lambda _: saying(interfaces.type_hash(FIX)))
    assert topic_problem(here, interfaces, "/fix", FIX) is None
    monkeypatch.setattr(here, "writers_of", lambda _: saying("RIHS01_0"))
    says(
        topic_problem(here, interfaces, "/fix", FIX),
        f"another definition of {FIX}",
        "set the robot's, or give its definition",
    )
