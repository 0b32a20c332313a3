"""Transport protocol between the driver and DDS or rclpy.

No call blocks: received messages are taken, outgoing ones are sent, and the caller decides how long to wait. The state
machines of goals are built on top (:mod:`fieldhand.execution.drivers.ros2.action_client`); an action is three services
and two topics here, as in ROS 2.

A message is a mapping from field names to values: bool, int, float, str, bytes (of ``uint8[]``, ``byte[]`` and
``char[]``), a tuple (of any other array), or another mapping. A message that is sent may omit fields: they keep the
default of their type.

Names are fully qualified (they begin with ``/``); types are ``package/msg/Name`` for topics and ``package/srv/Name``
for services. The services of an action are ``package/action/Name_SendGoal`` and ``package/action/Name_GetResult``, its
feedback is ``package/action/Name_FeedbackMessage``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, Protocol

RosMessage = Mapping[str, object]

#: Size limit in bytes of a received message. No mission needs larger ones, and decoded they grow a hundredfold.
MOST_BYTES = 4 * 1024 * 1024

#: Types of images, and size limit of a message of them: decoded, it takes eight times as much for a moment.
IMAGE_TYPES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")
MOST_IMAGE_BYTES = 16 * 1024 * 1024


def most_bytes(type_name: str) -> int:
    """Return the size limit in bytes of a received message of a type."""
    return MOST_IMAGE_BYTES if type_name in IMAGE_TYPES else MOST_BYTES


#: Middleware at the other end, if it can be identified.
Rmw = Literal["cyclonedds", "fastrtps", "connext", "zenoh", "unknown"]


def services_interoperate(one: Rmw, other: Rmw) -> bool:
    """Return True if services work between two middlewares: Cyclone DDS identifies requests differently from the
    others.
    """
    return "unknown" in (one, other) or one == other or "cyclonedds" not in (one, other)


@dataclass(frozen=True, kw_only=True)
class QosProfile:
    """Quality of service. A reader and a writer match only if the writer offers what the reader requests.

    Attributes:
        transient: Transient local durability: late subscribers receive earlier messages.
        depth: Number of messages kept.
    """

    reliable: bool = True
    transient: bool = False
    depth: int = 10


#: For sensors: the newest values.
SENSOR_QOS = QosProfile(reliable=False, depth=5)
#: For the status topic of an action.
STATUS_QOS = QosProfile(reliable=True, transient=True, depth=1)


@dataclass(frozen=True, kw_only=True)
class Peer:
    """An endpoint of another process, found by discovery.

    Attributes:
        participant: Identifies its process.
        type: Type in ROS form if it can be converted, otherwise as on the wire.
        qos: Quality of service offered or requested.
        type_hash: Hash of its type definition (``RIHS01_...``), from Iron on; empty if it gives none.
        reply_hash: Hash of the reply type of a server, whose ``type_hash`` is that of its requests.
    """

    participant: str
    rmw: Rmw
    type: str
    qos: QosProfile
    type_hash: str = ""
    reply_hash: str = ""


class Subscription(Protocol):
    """Reader of a topic."""

    def take(self) -> tuple[RosMessage, ...]:
        """Return the messages received since the last call, oldest first; at most as many as the depth of its QoS."""
        ...

    def publishers(self) -> int:
        """Return the number of matched publishers."""
        ...

    def close(self) -> None:
        """Close the endpoint. Repeated calls have no effect."""
        ...


class Publisher(Protocol):
    """Writer of a topic."""

    def send(self, message: RosMessage) -> None:
        """Send one message.

        Raises:
            Ros2Error: The message does not fit the type; the field is named.
        """
        ...

    def subscribers(self) -> int:
        """Return the number of matched subscribers."""
        ...

    def close(self) -> None:
        """Close the endpoint."""
        ...


class Client(Protocol):
    """Client of a service."""

    def servers(self) -> int:
        """Return the number of servers matched in **both** directions; otherwise replies would be lost."""
        ...

    def ask(self, request: RosMessage) -> int:
        """Send a request.

        Returns:
            Number of the request, as given by :meth:`replies`.

        Raises:
            Ros2Error: The request does not fit the type; the field is named.
        """
        ...

    def replies(self) -> tuple[tuple[int, RosMessage], ...]:
        """Return the replies received since the last call, each with the number of its request."""
        ...

    def close(self) -> None:
        """Close the endpoint."""
        ...


class Server(Protocol):
    """Server of a service."""

    def requests(self) -> tuple[tuple[object, RosMessage], ...]:
        """Return the requests received since the last call, each with the handle that :meth:`reply` needs."""
        ...

    def reply(self, to: object, response: RosMessage) -> None:
        """Reply to a request."""
        ...

    def close(self) -> None:
        """Close the endpoint."""
        ...


class Transport(Protocol):
    """A node of a ROS 2 graph."""

    @property
    def name(self) -> str:
        """``dds`` or ``rclpy``."""
        ...

    @property
    def rmw(self) -> Rmw:
        """Middleware with which its services are compatible."""
        ...

    def subscribe(self, topic: str, type_name: str, qos: QosProfile = SENSOR_QOS) -> Subscription:
        """Subscribe to a topic.

        Raises:
            Ros2Error: The type is unknown.
        """
        ...

    def publish(self, topic: str, type_name: str, qos: QosProfile = QosProfile()) -> Publisher:
        """Create a publisher of a topic.

        Raises:
            Ros2Error: The type is unknown.
        """
        ...

    def client(self, service: str, type_name: str) -> Client:
        """Create a client of a service.

        Raises:
            Ros2Error: The type is unknown.
        """
        ...

    def serve(self, service: str, type_name: str) -> Server:
        """Create a server of a service.

        Raises:
            Ros2Error: The type is unknown.
        """
        ...

    def writers_of(self, topic: str) -> tuple[Peer, ...]:
        """Return all discovered writers of a topic, matched or not, for diagnosis."""
        ...

    def servers_of(self, service: str) -> tuple[Peer, ...]:
        """Return all discovered servers of a service, matched or not."""
        ...

    def close(self) -> None:
        """Close all endpoints and leave the ROS graph."""
        ...
