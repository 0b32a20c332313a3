"""What carries messages to a robot and back: the seam between the driver and DDS or rclpy.

Nothing blocks: what has arrived is taken, what is to go is sent. Whoever asks decides how long to wait. The state
machines of goals stand above it (:mod:`fieldhand.execution.drivers.ros2.action_client`); an action is three services and
two topics here, as ROS 2 makes one.

A message is a mapping from field names to values: bool, int, float, str, bytes (of ``uint8[]``, ``byte[]`` and
``char[]``), a tuple (of any other array), or another mapping. A message that is sent may leave fields out: they keep
the default of their type.

Names here are whole (they begin with ``/``); types are ``package/msg/Name`` for topics and ``package/srv/Name`` for
services. Those of an action are ``package/action/Name_SendGoal`` and ``package/action/Name_GetResult``, its feedback
``package/action/Name_FeedbackMessage``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, Protocol

Message = Mapping[str, object]

#: Bytes of a message that is read. Nothing that a mission needs is larger, and in memory it grows a hundredfold.
MOST_BYTES = 4 * 1024 * 1024

#: What implements ROS's middleware at the other end, where it can be told.
Rmw = Literal["cyclonedds", "fastrtps", "connext", "zenoh", "unknown"]


def services_interoperate(one: Rmw, other: Rmw) -> bool:
    """Whether services go between two middlewares: Cyclone's say otherwise than the rest whose a request is."""
    return "unknown" in (one, other) or one == other or "cyclonedds" not in (one, other)


@dataclass(frozen=True, kw_only=True)
class QosProfile:
    """Quality of service. A reader and a writer find each other only if the writer offers what the reader asks for.

    Attributes:
        transient: Transient local: who comes late gets what was sent before.
        depth: How many messages are kept.
    """

    reliable: bool = True
    transient: bool = False
    depth: int = 10


#: Of sensors: the newest values, and none twice.
SENSOR_QOS = QosProfile(reliable=False, depth=5)
#: Of an action's status topic.
STATUS_QOS = QosProfile(reliable=True, transient=True, depth=1)


@dataclass(frozen=True, kw_only=True)
class Peer:
    """An endpoint of another process that discovery has found.

    Attributes:
        participant: Tells processes apart, not more.
        type: Its type, in ROS's form where it can be told, else as the wire has it.
        quality: What it offers, or asks for.
        type_hash: Of its type's definition (``RIHS01_...``), from Iron on; empty where it gives none.
        reply_hash: The same of the replies of a server, whose type is that of its requests.
    """

    participant: str
    rmw: Rmw
    type: str
    qos: QosProfile
    type_hash: str = ""
    reply_hash: str = ""


class Subscription(Protocol):
    """Reads a topic."""

    def take(self) -> tuple[Message, ...]:
        """What has arrived since the last call, the oldest first; at most as many as the depth of its quality."""
        ...

    def publishers(self) -> int:
        """How many send to it: those whose type and quality match."""
        ...

    def close(self) -> None:
        """End it. Does nothing the second time."""
        ...


class Publisher(Protocol):
    """Writes a topic."""

    def send(self, message: Message) -> None:
        """Send one message.

        Raises:
            Ros2Error: It does not fit the type; the field is named.
        """
        ...

    def subscribers(self) -> int:
        """How many hear it."""
        ...

    def close(self) -> None:
        """End it."""
        ...


class Client(Protocol):
    """Asks a service."""

    def servers(self) -> int:
        """How many servers can hear a request **and** be heard: of less than that, replies get lost."""
        ...

    def ask(self, request: Message) -> int:
        """Send a request.

        Returns:
            Its number, by which :meth:`replies` names its reply.

        Raises:
            Ros2Error: It does not fit the type; the field is named.
        """
        ...

    def replies(self) -> tuple[tuple[int, Message], ...]:
        """The replies to requests of this client that have arrived since the last call, each with its number."""
        ...

    def close(self) -> None:
        """End it."""
        ...


class Server(Protocol):
    """Answers a service."""

    def requests(self) -> tuple[tuple[object, Message], ...]:
        """Requests that have arrived since the last call, each with what :meth:`reply` needs to answer it."""
        ...

    def reply(self, to: object, response: Message) -> None:
        """Answer a request."""
        ...

    def close(self) -> None:
        """End it."""
        ...


class Transport(Protocol):
    """A node of a ROS 2 graph."""

    @property
    def name(self) -> str:
        """``dds`` or ``rclpy``."""
        ...

    @property
    def rmw(self) -> Rmw:
        """The middleware whose services it understands."""
        ...

    def subscribe(self, topic: str, type_name: str, qos: QosProfile = SENSOR_QOS) -> Subscription:
        """Read a topic.

        Raises:
            Ros2Error: The type is not known.
        """
        ...

    def publish(self, topic: str, type_name: str, qos: QosProfile = QosProfile()) -> Publisher:
        """Write a topic.

        Raises:
            Ros2Error: The type is not known.
        """
        ...

    def client(self, service: str, type_name: str) -> Client:
        """Ask a service.

        Raises:
            Ros2Error: The type is not known.
        """
        ...

    def serve(self, service: str, type_name: str) -> Server:
        """Answer a service.

        Raises:
            Ros2Error: The type is not known.
        """
        ...

    def writers_of(self, topic: str) -> tuple[Peer, ...]:
        """Everything that discovery has found to write a topic, whether it matches or not: to say what is wrong."""
        ...

    def servers_of(self, service: str) -> tuple[Peer, ...]:
        """Everything that discovery has found to answer a service, whether it matches or not."""
        ...

    def close(self) -> None:
        """Leave the graph, with all that was made here."""
        ...
