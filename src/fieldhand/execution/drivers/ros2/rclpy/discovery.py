"""What other processes have on the graph, whether it fits us or not."""

from __future__ import annotations

from typing import Any

from rclpy.utilities import get_rmw_implementation_identifier

from fieldhand.execution.drivers.ros2.dds.names import request_name, rmw_of, ros_type
from fieldhand.execution.drivers.ros2.rclpy.qos import from_rclpy_qos, meets
from fieldhand.execution.drivers.ros2.transport import Peer, QosProfile, Rmw

#: The bytes of an endpoint's name that are its process (RTPS 9.3.1.2).
_PARTICIPANT = 12

_NAMED: tuple[Rmw, ...] = ("cyclonedds", "fastrtps", "connext", "zenoh")


class RclpyDiscovery:
    """Asks ROS's graph.

    Args:
        node: Ours; its own endpoints are not told.
    """

    def __init__(self, node: Any) -> None:
        self._node = node
        said = get_rmw_implementation_identifier()
        self.rmw: Rmw = next((rmw for rmw in _NAMED if rmw in said), "unknown")
        self._zenoh = self.rmw == "zenoh"

    def writers_of(self, topic: str) -> tuple[Peer, ...]:
        """Everything that writes a topic."""
        return tuple(self._peer(e) for e in self._node.get_publishers_info_by_topic(topic) if self._other(e))

    def matched(self, topic: str, type_name: str, reader: Any) -> int:
        """How many write a topic with a type and a quality that a reader hears."""
        writers = self._node.get_publishers_info_by_topic(topic)
        return sum(ros_type(w.topic_type) == type_name and meets(w.qos_profile, reader) for w in writers)

    def servers_of(self, service: str) -> tuple[Peer, ...]:
        """Everything that answers a service: over DDS, who reads its requests; else, which nodes say so."""
        if self._zenoh:
            return self._nodes_with(service)
        readers = self._node.get_subscriptions_info_by_topic(request_name(service), no_mangle=True)
        return tuple(self._peer(e) for e in readers if self._other(e))

    def _nodes_with(self, service: str) -> tuple[Peer, ...]:
        """Where requests are no topics."""
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
        said = str(getattr(endpoint, "topic_type_hash", ""))
        return Peer(
            participant=key[:_PARTICIPANT].hex(),
            rmw=rmw,
            type=ros_type(endpoint.topic_type),
            qos=from_rclpy_qos(endpoint.qos_profile),
            type_hash=said if said.startswith("RIHS01_") else "",
        )
