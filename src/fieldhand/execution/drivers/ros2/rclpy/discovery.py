"""Endpoints of other processes on the graph, compatible or not."""

from __future__ import annotations

from typing import Any

from rclpy.utilities import get_rmw_implementation_identifier

from fieldhand.execution.drivers.ros2.dds.names import request_name, rmw_of, ros_type
from fieldhand.execution.drivers.ros2.rclpy.qos import from_rclpy_qos, meets
from fieldhand.execution.drivers.ros2.transport import Peer, QosProfile, Rmw

#: Number of leading bytes of an endpoint's GID that identify its process (RTPS 9.3.1.2).
_PARTICIPANT = 12

_NAMED: tuple[Rmw, ...] = ("cyclonedds", "fastrtps", "connext", "zenoh")


class RclpyDiscovery:
    """Discovered endpoints, from the ROS graph.

    Args:
        node: Own node; its endpoints are excluded.
    """

    def __init__(self, node: Any) -> None:
        self._node = node
        name = get_rmw_implementation_identifier()
        self.rmw: Rmw = next((rmw for rmw in _NAMED if rmw in name), "unknown")
        self._zenoh = self.rmw == "zenoh"

    def writers_of(self, topic: str) -> tuple[Peer, ...]:
        """Return all writers of a topic."""
        return tuple(self._peer(e) for e in self._node.get_publishers_info_by_topic(topic) if self._other(e))

    def matched(self, topic: str, type_name: str, reader: Any) -> int:
        """Return the number of writers that match a reader's type and quality of service."""
        writers = self._node.get_publishers_info_by_topic(topic)
        return sum(ros_type(w.topic_type) == type_name and meets(w.qos_profile, reader) for w in writers)

    def servers_of(self, service: str) -> tuple[Peer, ...]:
        """Return all servers of a service: over DDS the readers of its requests, otherwise the nodes that offer it."""
        if self._zenoh:
            return self._nodes_with(service)
        readers = self._node.get_subscriptions_info_by_topic(request_name(service), no_mangle=True)
        return tuple(self._peer(e) for e in readers if self._other(e))

    def _nodes_with(self, service: str) -> tuple[Peer, ...]:
        """Return the servers by node, for middlewares whose requests are not topics."""
        own = self._node.get_name()
        return tuple(
            Peer(participant=f"{space.rstrip('/')}/{node}", rmw="zenoh", type=kind, qos=QosProfile())
            for node, space in self._node.get_node_names_and_namespaces()
            if node != own
            for name, kinds in self._node.get_service_names_and_types_by_node(node, space)
            if name == service
            for kind in kinds
        )

    def _other(self, endpoint: Any) -> bool:
        return bool(endpoint.node_name != self._node.get_name())

    def _peer(self, endpoint: Any) -> Peer:
        key = bytes(endpoint.endpoint_gid)
        rmw: Rmw = "zenoh" if self._zenoh else rmw_of(key)
        type_hash = str(getattr(endpoint, "topic_type_hash", ""))
        return Peer(
            participant=key[:_PARTICIPANT].hex(),
            rmw=rmw,
            type=ros_type(endpoint.topic_type),
            qos=from_rclpy_qos(endpoint.qos_profile),
            type_hash=type_hash if type_hash.startswith("RIHS01_") else "",
        )
