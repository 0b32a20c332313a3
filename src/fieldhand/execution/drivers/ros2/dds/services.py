"""Service endpoints: a request topic and a reply topic."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader

from fieldhand.execution.drivers.ros2.dds.message_codec import Header, MessageCodec
from fieldhand.execution.drivers.ros2.dds.names import INCOMPATIBLE_SERVICES, rmw_of
from fieldhand.execution.drivers.ros2.dds.qos import user_data_of
from fieldhand.execution.drivers.ros2.dds.topics import close, samples, write
from fieldhand.execution.drivers.ros2.transport import QosProfile, RosMessage

#: For both topics: reliable, volatile, depth 10, as measured.
SERVICE_QOS = QosProfile()

#: Limit of replies that wait for their client to be discovered; the oldest are dropped.
_MOST_WAITING = 100
#: Attempts to send a reply before its client counts as gone.
_TRIES = 2000


class DdsClient:
    """A :class:`~fieldhand.execution.drivers.ros2.transport.Client` over DDS.

    Args:
        writer: Writer of requests.
        reader: Reader of replies; receives those to other clients, too.
    """

    def __init__(
        self, codec: MessageCodec, service_type: str, writer: DataWriter[Any], reader: DataReader[Any]
    ) -> None:
        self._codec, self._type, self._writer, self._reader = codec, service_type, writer, reader
        self._request_readers = _Matched(
            writer.get_matched_subscriptions, writer.get_matched_subscription_data, "serviceid"
        )
        self._reply_writers = _Matched(
            reader.get_matched_publications, reader.get_matched_publication_data, "serviceid"
        )
        self._number = 0
        self._client = writer.get_instance_handle() & 0xFFFF_FFFF_FFFF_FFFF
        self.open = True

    def servers(self) -> int:
        return len(self._request_readers.ids() & self._reply_writers.ids()) if self.open else 0

    def ask(self, request: RosMessage) -> int:
        self._number += 1
        sample = self._codec.encode(f"{self._type}_Request", request, Header(self._client, self._number))
        if self.open:
            write(self._writer, sample)
        return self._number

    def replies(self) -> tuple[tuple[int, RosMessage], ...]:
        if not self.open:
            return ()
        return tuple(
            (sample.seq, self._codec.decode(f"{self._type}_Response", sample))
            for sample in samples(self._reader, SERVICE_QOS.depth)
            if sample.guid == self._client and 0 < sample.seq <= self._number
        )

    def close(self) -> None:
        if self.open:
            self.open = False
            close(self._writer, self._reader)


@dataclass(frozen=True)
class _Request:
    """Origin of a request: its header, and the endpoint that wrote it."""

    header: Header
    writer: int


@dataclass
class _PendingReply:
    request: _Request
    sample: Any
    tries: int = 0


class DdsServer:
    """A :class:`~fieldhand.execution.drivers.ros2.transport.Server` over DDS.

    The requests of a new client may arrive before its reply reader is discovered: the reply is then queued, and sent by
    a later call of :meth:`requests` or :meth:`reply`.
    """

    def __init__(
        self, codec: MessageCodec, service_type: str, reader: DataReader[Any], writer: DataWriter[Any]
    ) -> None:
        self._codec, self._type, self._reader, self._writer = codec, service_type, reader, writer
        self._clients = _Matched(writer.get_matched_subscriptions, writer.get_matched_subscription_data, "clientid")
        self._waiting: deque[_PendingReply] = deque(maxlen=_MOST_WAITING)
        self.open = True

    def requests(self) -> tuple[tuple[object, RosMessage], ...]:
        if not self.open:
            return ()
        self._send_waiting()
        return tuple(
            (
                _Request(Header(sample.guid, sample.seq), sample.sample_info.publication_handle),
                self._codec.decode(f"{self._type}_Request", sample),
            )
            for sample in samples(self._reader, SERVICE_QOS.depth)
        )

    def reply(self, to: object, response: RosMessage) -> None:
        if not isinstance(to, _Request):
            raise TypeError("answer what requests() gave")
        sample = self._codec.encode(f"{self._type}_Response", response, to.header)
        if self.open:
            self._waiting.append(_PendingReply(to, sample))
            self._send_waiting()

    def close(self) -> None:
        if self.open:
            self.open = False
            close(self._reader, self._writer)

    def _send_waiting(self) -> None:
        for _ in range(len(self._waiting)):
            reply = self._waiting.popleft()
            reply.tries += 1
            if self._has_reader(reply.request.writer):
                write(self._writer, reply.sample)
            elif reply.tries < _TRIES:
                self._waiting.append(reply)

    def _has_reader(self, asker: int) -> bool:
        """Return True if the client's reader is matched, or cannot be identified."""
        client = _id_of(self._reader.get_matched_publication_data(asker), "clientid")
        return client is None or client in self._clients.ids()


class _Matched:
    """Identities of the matched endpoints: the id in their user data, otherwise their process.

    User data do not change while an endpoint exists and are slow to query, so each is queried once.

    Args:
        handles: Returns the handles of the matched endpoints.
        data_of: Returns the discovery data of one of them.
        key: Key of the id in the user data.
    """

    def __init__(self, handles: Callable[[], list[int]], data_of: Callable[[int], Any], key: str) -> None:
        self._handles, self._data_of, self._key = handles, data_of, key
        self._known: dict[int, str | None] = {}

    def ids(self) -> set[str]:
        """Return the ids of the matched endpoints that are compatible."""
        for handle in (there := set(self._handles())) - self._known.keys():
            endpoint = self._data_of(handle)
            if endpoint is not None and endpoint.qos is not None:
                deaf = rmw_of(endpoint.participant_key.bytes) in INCOMPATIBLE_SERVICES
                self._known[handle] = None if deaf else _id_of(endpoint, self._key) or endpoint.participant_key.hex
        self._known = {handle: known for handle, known in self._known.items() if handle in there}
        return {known for known in self._known.values() if known is not None}


def _id_of(endpoint: Any, key: str) -> str | None:
    return user_data_of(endpoint.qos).values.get(key) if endpoint is not None and endpoint.qos is not None else None
