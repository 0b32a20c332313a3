"""Service endpoints through rclpy."""

from __future__ import annotations

from typing import Any

from rclpy.impl.implementation_singleton import rclpy_implementation

from fieldhand.execution.drivers.ros2.rclpy import message_types
from fieldhand.execution.drivers.ros2.rclpy.discovery import RclpyDiscovery
from fieldhand.execution.drivers.ros2.transport import QosProfile, RosMessage, services_interoperate

RCLError = rclpy_implementation.RCLError

#: Reliable, volatile, depth 10, as in ROS.
SERVICE_QOS = QosProfile()


class RclpyClient:
    """A :class:`~fieldhand.execution.drivers.ros2.transport.Client` through rclpy.

    Requests bypass rclpy's futures, which would need an executor: the middleware numbers them, and replies carry the
    number.
    """

    def __init__(self, node: Any, discovery: RclpyDiscovery, service: str, service_type: str, client: Any) -> None:
        self._node, self._discovery, self._service = node, discovery, service
        self._type, self._client = service_type, client
        self._last = 0
        self.open = True

    def servers(self) -> int:
        # Ready should mean matched in both directions; some middlewares compare only the name.
        if not self.open or not self._client.service_is_ready():
            return 0
        own = self._discovery.rmw
        return sum(
            p.type == self._type and services_interoperate(own, p.rmw)
            for p in self._discovery.servers_of(self._service)
        )

    def ask(self, request: RosMessage) -> int:
        sample = message_types.to_ros(f"{self._type}_Request", request)
        if self.open:
            with self._client.handle:
                self._last = int(self._client.handle.send_request(sample))
        return self._last

    def replies(self) -> tuple[tuple[int, RosMessage], ...]:
        taken: list[tuple[int, RosMessage]] = []
        for _ in range(SERVICE_QOS.depth if self.open else 0):
            try:
                with self._client.handle:
                    header, response = self._client.handle.take_response(self._client.srv_type.Response)
                if header is None:
                    break
                reply = message_types.from_ros(f"{self._type}_Response", response)
            except (RCLError, ValueError):
                continue  # a message that does not fit its type is dropped
            taken.append((int(header.request_id.sequence_number), reply))
        return tuple(taken)

    def close(self) -> None:
        if self.open:
            self.open = False
            self._node.destroy_client(self._client)


class RclpyServer:
    """A :class:`~fieldhand.execution.drivers.ros2.transport.Server` through rclpy."""

    def __init__(self, node: Any, service_type: str, service: Any) -> None:
        self._node, self._type, self._server = node, service_type, service
        self.open = True

    def requests(self) -> tuple[tuple[object, RosMessage], ...]:
        taken: list[tuple[object, RosMessage]] = []
        for _ in range(SERVICE_QOS.depth if self.open else 0):
            try:
                with self._server.handle:
                    request, header = self._server.handle.service_take_request(self._server.srv_type.Request)
                if header is None or request is None:
                    break
                taken.append((header, message_types.from_ros(f"{self._type}_Request", request)))
            except (RCLError, ValueError):
                continue  # a message that does not fit its type is dropped
        return tuple(taken)

    def reply(self, to: object, response: RosMessage) -> None:
        sample = message_types.to_ros(f"{self._type}_Response", response)
        if self.open:
            self._server.send_response(sample, to)

    def close(self) -> None:
        if self.open:
            self.open = False
            self._node.destroy_service(self._server)
