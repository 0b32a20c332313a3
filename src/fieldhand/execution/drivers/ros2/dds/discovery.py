"""Endpoints of other processes on the graph, compatible or not."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsPublication, BuiltinTopicDcpsSubscription
from cyclonedds.core import InstanceState
from cyclonedds.domain import DomainParticipant

from fieldhand.execution.drivers.ros2.dds.names import reply_name, request_name, rmw_of, ros_type, topic_name
from fieldhand.execution.drivers.ros2.dds.qos import from_dds_qos, user_data_of
from fieldhand.execution.drivers.ros2.transport import Peer

_AT_ONCE = 256
#: Limit of remembered endpoints; a large robot has several hundred.
_MOST = 20_000


class DdsDiscovery:
    """Discovered endpoints, from the built-in topics of DDS.

    Args:
        participant: Own participant; its endpoints are excluded.
    """

    def __init__(self, participant: DomainParticipant) -> None:
        self._own = participant.get_guid().bytes
        self._writers = _EndpointList(BuiltinDataReader(participant, BuiltinTopicDcpsPublication))
        self._readers = _EndpointList(BuiltinDataReader(participant, BuiltinTopicDcpsSubscription))

    def writers_of(self, topic: str) -> tuple[Peer, ...]:
        """Return all writers of a topic."""
        return self._matching(self._writers, topic_name(topic))

    def servers_of(self, service: str) -> tuple[Peer, ...]:
        """Return all readers of a service's requests."""
        # Replies of several servers in one process cannot be told apart.
        replies = {p.participant: p.type_hash for p in self._matching(self._writers, reply_name(service))}
        found = self._matching(self._readers, request_name(service))
        return tuple(replace(p, reply_hash=replies.get(p.participant, "")) for p in found)

    def _matching(self, endpoints: _EndpointList, wire_name: str) -> tuple[Peer, ...]:
        there = endpoints.now(wire_name)
        return tuple(_peer(e) for e in there if e.participant_key.bytes != self._own)


class _EndpointList:
    """Discovered endpoints of one direction."""

    def __init__(self, reader: BuiltinDataReader) -> None:
        self._reader = reader
        self._endpoints: dict[str, Any] = {}

    def now(self, wire_name: str) -> list[Any]:
        while True:
            news = self._reader.take(N=_AT_ONCE)
            for each in news:
                there = each.sample_info.instance_state == InstanceState.Alive and each.qos is not None
                if not there:
                    self._endpoints.pop(each.key.hex, None)
                elif each.key.hex in self._endpoints or len(self._endpoints) < _MOST:
                    self._endpoints[each.key.hex] = each
            if len(news) < _AT_ONCE:
                return [e for e in self._endpoints.values() if e.topic_name == wire_name]


def _peer(endpoint: Any) -> Peer:
    return Peer(
        participant=endpoint.participant_key.hex,
        rmw=rmw_of(endpoint.participant_key.bytes),
        type=ros_type(endpoint.type_name),
        qos=from_dds_qos(endpoint.qos),
        type_hash=user_data_of(endpoint.qos).values.get("typehash", ""),
    )
