"""A node of a ROS 2 graph through rclpy."""

from __future__ import annotations

import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

from rclpy.context import Context
from rclpy.exceptions import NameValidationException
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.dds.names import request_name, topic_name
from fieldhand.execution.drivers.ros2.domain import domain_of
from fieldhand.execution.drivers.ros2.rclpy import message_types
from fieldhand.execution.drivers.ros2.rclpy.discovery import RclpyDiscovery
from fieldhand.execution.drivers.ros2.rclpy.qos import to_rclpy_qos
from fieldhand.execution.drivers.ros2.rclpy.services import SERVICE_QOS, RclpyClient, RclpyServer
from fieldhand.execution.drivers.ros2.rclpy.topics import RclpyPublisher, RclpySubscription
from fieldhand.execution.drivers.ros2.transport import SENSOR_QOS, Peer, QosProfile, Rmw

RCLError = rclpy_implementation.RCLError

_End = TypeVar("_End", RclpySubscription, RclpyPublisher, RclpyClient, RclpyServer)


class RclpyTransport:
    """A :class:`~fieldhand.execution.drivers.ros2.transport.Transport` of the sourced ROS.

    Its context is separate and ignores the arguments of the process: another node in the same process keeps its name,
    remappings and signal handlers.

    Args:
        domain: ROS domain id; None for ``ROS_DOMAIN_ID`` of the environment, else 0.

    Raises:
        InputError: The domain id is invalid.
        Ros2Error: No node can be created.
    """

    def __init__(self, domain: int | None = None) -> None:
        self.domain = domain_of(domain)
        self._ends: list[Any] = []
        self._open = True
        self._context = Context()
        try:
            self._context.init([], initialize_logging=False, domain_id=self.domain)
            # Own endpoints are recognized by the node's name, so it must be unique.
            self._node = Node(
                f"fieldhand_{secrets.token_hex(4)}",
                context=self._context,
                use_global_arguments=False,
                enable_rosout=False,
                start_parameter_services=False,
            )
        except (RCLError, RuntimeError) as error:
            self._context.try_shutdown()
            raise Ros2Error(
                f"rclpy cannot create a node on domain {self.domain} ({error})",
                advice="check RMW_IMPLEMENTATION, the network interfaces and the middleware's configuration",
            ) from error
        self._discovery = RclpyDiscovery(self._node)

    @property
    def name(self) -> str:
        return "rclpy"

    @property
    def rmw(self) -> Rmw:
        return self._discovery.rmw

    def subscribe(self, topic: str, type_name: str, qos: QosProfile = SENSOR_QOS) -> RclpySubscription:
        topic_name(topic)
        with _in_words(topic, type_name):
            made = self._node.create_subscription(
                message_types.class_of(type_name), topic, _never, to_rclpy_qos(qos), raw=True
            )
        return self._track(RclpySubscription(self._node, self._discovery, type_name, made))

    def publish(self, topic: str, type_name: str, qos: QosProfile = QosProfile()) -> RclpyPublisher:  # noqa: B008 - frozen
        topic_name(topic)
        with _in_words(topic, type_name):
            made = self._node.create_publisher(message_types.class_of(type_name), topic, to_rclpy_qos(qos))
        return self._track(RclpyPublisher(self._node, type_name, made))

    def client(self, service: str, type_name: str) -> RclpyClient:
        request_name(service)
        with _in_words(service, type_name):
            made = self._node.create_client(
                message_types.class_of(type_name), service, qos_profile=to_rclpy_qos(SERVICE_QOS)
            )
        return self._track(RclpyClient(self._node, self._discovery, service, type_name, made))

    def serve(self, service: str, type_name: str) -> RclpyServer:
        request_name(service)
        with _in_words(service, type_name):
            made = self._node.create_service(
                message_types.class_of(type_name), service, _never, qos_profile=to_rclpy_qos(SERVICE_QOS)
            )
        return self._track(RclpyServer(self._node, type_name, made))

    def writers_of(self, topic: str) -> tuple[Peer, ...]:
        return self._discovery.writers_of(topic) if self._open else ()

    def servers_of(self, service: str) -> tuple[Peer, ...]:
        return self._discovery.servers_of(service) if self._open else ()

    def close(self) -> None:
        for end in self._ends:
            end.close()
        self._ends.clear()
        if self._open:
            self._open = False
            self._node.destroy_node()
            self._context.try_shutdown()

    def _track(self, end: _End) -> _End:
        self._ends = [*(e for e in self._ends if e.open), end]
        return end


@contextmanager
def _in_words(name: str, type_name: str) -> Iterator[None]:
    """Convert rclpy's errors to those of the DDS transport."""
    try:
        yield
    except (RCLError, NameValidationException, ValueError) as error:
        why = str(error).partition(", at ")[0]  # the rest is line numbers of ROS's source
        raise Ros2Error(f"{name} cannot be used as {type_name} ({why})") from error


def _never(*_: object) -> None:
    """Callback that is never called: there is no executor."""
