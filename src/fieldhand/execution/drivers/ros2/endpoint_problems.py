"""Diagnosis of endpoints that cannot be used: cause and remedy, from discovery data.

DDS reports no error for a mismatch of type, quality of service or middleware; the endpoints simply do not match. These
functions look up what exists instead. They return None if nothing prevents a match, which may still take a moment.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.transport import (
    SENSOR_QOS,
    STATUS_QOS,
    Peer,
    QosProfile,
    Rmw,
    Transport,
    services_interoperate,
)

_PACKAGES: dict[Rmw, str] = {
    "cyclonedds": "rmw_cyclonedds_cpp",
    "fastrtps": "rmw_fastrtps_cpp",
    "connext": "rmw_connextdds",
    "zenoh": "rmw_zenoh_cpp",
}

FEEDBACK_QOS = QosProfile(reliable=True)


@dataclass(frozen=True, kw_only=True)
class EndpointProblem:
    """Cause why an endpoint cannot be used, without its name, and the remedy."""

    what: str
    advice: str

    def __str__(self) -> str:
        return f"{self.what}; {self.advice}"


def rmw_package(rmw: Rmw) -> str:
    """Return the package name that a robot sets as ``RMW_IMPLEMENTATION``."""
    return _PACKAGES.get(rmw, "an unknown RMW")


def topic_problem(
    transport: Transport, interfaces: Interfaces, topic: str, type_name: str, qos: QosProfile = SENSOR_QOS
) -> EndpointProblem | None:
    """Return why no messages arrive on a topic.

    Args:
        qos: Quality of service of the reader.
    """
    peers = transport.writers_of(topic)
    if not peers:
        return _absent("publisher")
    typed = [p for p in peers if p.type == type_name]
    if not typed:
        return _other_type("sent", peers, type_name)
    if all(_less(p.qos, qos) for p in typed):
        return _less(typed[0].qos, qos)
    return _other_definition([p.type_hash for p in typed], interfaces.type_hash(type_name), type_name)


def service_problem(
    transport: Transport, interfaces: Interfaces, service: str, type_name: str
) -> EndpointProblem | None:
    """Return why a service does not answer."""
    peers = transport.servers_of(service)
    if not peers:
        return _absent("server")
    typed = [p for p in peers if p.type == type_name]
    if not typed:
        return _other_type("answered", peers, type_name)
    deaf = next((p for p in typed if not services_interoperate(transport.rmw, p.rmw)), None)
    if deaf is not None and transport.name == "rclpy":
        return EndpointProblem(
            what=f"the robot runs {rmw_package(deaf.rmw)} and this side {rmw_package(transport.rmw)}: services do not "
            "work between them",
            advice="set the robot's RMW_IMPLEMENTATION here, too",
        )
    if deaf is not None:
        return EndpointProblem(
            what=f"the robot runs {rmw_package(deaf.rmw)}, whose services cannot be called over the dds transport",
            advice="set RMW_IMPLEMENTATION=rmw_cyclonedds_cpp on the robot, or reach it by rclpy from here",
        )
    if len(typed) > 1:
        return EndpointProblem(
            what=f"{len(typed)} servers answer it: which robot is meant?",
            advice="if these are two robots, give each a namespace or a ROS_DOMAIN_ID of its own",
        )
    wrong = _other_definition([p.type_hash for p in typed], interfaces.type_hash(f"{type_name}_Request"), type_name)
    return wrong or _other_definition(
        [p.reply_hash for p in typed], interfaces.type_hash(f"{type_name}_Response"), type_name
    )


def action_problem(transport: Transport, interfaces: Interfaces, action: str, type_name: str) -> EndpointProblem | None:
    """Return why an action accepts no goals: the first of its services and topics that cannot be used."""
    for service, of in (
        ("send_goal", f"{type_name}_SendGoal"),
        ("get_result", f"{type_name}_GetResult"),
        ("cancel_goal", "action_msgs/srv/CancelGoal"),
    ):
        found = service_problem(transport, interfaces, f"{action}/_action/{service}", of)
        if found is not None:
            return found if service == "send_goal" else _part(service, found)
    for topic, of, qos in (
        ("feedback", f"{type_name}_FeedbackMessage", FEEDBACK_QOS),
        ("status", "action_msgs/msg/GoalStatusArray", STATUS_QOS),
    ):
        found = topic_problem(transport, interfaces, f"{action}/_action/{topic}", of, qos)
        if found is not None:
            return _part(topic, found)
    return None


def _absent(endpoint: str) -> EndpointProblem:
    return EndpointProblem(
        what=f"there is no {endpoint}",
        advice="start it; if it runs, compare its name, namespace and ROS_DOMAIN_ID with these",
    )


def _other_type(done: str, peers: Iterable[Peer], wanted: str) -> EndpointProblem:
    types = ", ".join(sorted({p.type for p in peers}))
    return EndpointProblem(
        what=f"it is {done} as {types}, not as {wanted}",
        advice="correct the type, or the name, in the profile's ros2 part",
    )


def _less(offered: QosProfile, wanted: QosProfile) -> EndpointProblem | None:
    """Return the quality of service that a writer fails to offer."""
    if wanted.reliable and not offered.reliable:
        return EndpointProblem(
            what="it is sent best effort and read reliably, which never match",
            advice="leave reliable out in the profile's ros2 part",
        )
    if wanted.transient and not offered.transient:
        return EndpointProblem(
            what="it is sent volatile and read transient local, which never match",
            advice="leave transient out in the profile's ros2 part",
        )
    return None


def _other_definition(theirs: list[str], ours: str, shown: str) -> EndpointProblem | None:
    """Return a mismatch of type definitions. Endpoints would match and misread messages; detectable from Iron on."""
    if all(type_hash and type_hash != ours for type_hash in theirs):
        return EndpointProblem(
            what=f"the robot has another definition of {shown} than is known here",
            advice="leave distro out of the profile or set the robot's, or give its definition under ros2: interfaces",
        )
    return None


def _part(part: str, problem: EndpointProblem) -> EndpointProblem:
    return EndpointProblem(what=f"its {part}: {problem.what}", advice=problem.advice)
