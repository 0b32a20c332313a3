"""A robot of another vendor's DDS, as far as discovery goes: what its process says of its endpoints (RTPS 2.3).

It sends what any RTPS implementation sends to be found, under the vendor's number, and answers nothing, as services of
that vendor answer none of ours.
"""

from __future__ import annotations

import socket
import struct
from collections.abc import Iterable

#: Of ``rmw_fastrtps`` (eProsima).
EPROSIMA = b"\x01\x0f"

_PARTICIPANT, _READER, _WRITER = b"\0\0\1\xc1", 0xC7, 0xC2
_GROUP = "239.255.0.1"
_RELIABLE, _BEST_EFFORT = 2, 1


class OtherVendor:
    """Announces itself to every process on this machine within a domain.

    Args:
        reads, writes: Endpoints: names and types on the wire.
    """

    def __init__(
        self,
        domain: int,
        *,
        reads: Iterable[tuple[str, str]],
        writes: Iterable[tuple[str, str]],
        vendor: bytes = EPROSIMA,
    ) -> None:
        self._vendor, self._prefix = vendor, vendor + b"\x0a\x0b\x0c\x0d\1\0\0\0\0\0"
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1", 0))
        self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
        self._to = (_GROUP, 7400 + 250 * domain)
        self._count = 0
        self._endpoints = {0x04: list(reads), 0x03: list(writes)}

    def say(self) -> None:
        """Once more; it is heard in order, and twice does no harm."""
        self._count += 1
        self._send(_data(b"\0\1\0", 1, self._participant()))
        for kind, endpoints in self._endpoints.items():
            entity = bytes((0, 0, kind))
            self._send(_heartbeat(entity, len(endpoints), self._count))
            for number, (topic, type_name) in enumerate(endpoints, 1):
                self._send(_data(entity, number, self._endpoint(kind, number, topic, type_name)))

    def close(self) -> None:
        """Say that it has gone: participant disposed and unregistered."""
        self._send(_gone(_parameters((0x50, self._prefix + _PARTICIPANT))))
        self._socket.close()

    def _send(self, submessage: bytes) -> None:
        self._socket.sendto(b"RTPS\2\3" + self._vendor + self._prefix + submessage, self._to)

    def _participant(self) -> bytes:
        where = struct.pack("<iI12x4B", 1, self._socket.getsockname()[1], 127, 0, 0, 1)
        return _parameters(
            (0x15, b"\2\3\0\0"), (0x16, self._vendor + b"\0\0"), (0x50, self._prefix + _PARTICIPANT),
            (0x02, struct.pack("<iI", 100, 0)), (0x58, struct.pack("<I", 0xC3F)), (0x31, where), (0x32, where),
        )  # fmt: skip

    def _endpoint(self, kind: int, number: int, topic: str, type_name: str) -> bytes:
        guid = self._prefix + bytes((0, 0, number, 0x04 if kind == 0x04 else 0x03))
        return _parameters(
            (0x5A, guid), (0x70, guid), (0x50, self._prefix + _PARTICIPANT), (0x05, _text(topic)),
            (0x07, _text(type_name)), (0x1A, struct.pack("<IiI", _RELIABLE, 0, 100 << 22)), (0x1D, bytes(4)),
            (0x73, struct.pack("<Ihxx", 1, 0)),
        )  # fmt: skip


def _text(text: str) -> bytes:
    data = text.encode() + b"\0"
    return struct.pack("<I", len(data)) + data


def _parameters(*given: tuple[int, bytes]) -> bytes:
    whole = [(key, value + bytes(-len(value) % 4)) for key, value in given]
    return b"\0\3\0\0" + b"".join(struct.pack("<HH", k, len(v)) + v for k, v in whole) + b"\1\0\0\0"


def _data(entity: bytes, number: int, payload: bytes) -> bytes:
    ends = entity + bytes((_READER,)) + entity + bytes((_WRITER,))
    body = struct.pack("<HH", 0, 16) + ends + struct.pack("<iI", 0, number) + payload
    return struct.pack("<BBH", 0x15, 0x05, len(body)) + body


def _gone(key: bytes) -> bytes:
    ends = b"\0\1\0" + bytes((_READER,)) + b"\0\1\0" + bytes((_WRITER,))
    inline = struct.pack("<HH", 0x71, 4) + b"\0\0\0\3" + b"\1\0\0\0"
    body = struct.pack("<HH", 0, 16) + ends + struct.pack("<iI", 0, 2) + inline + key
    return struct.pack("<BBH", 0x15, 0x0B, len(body)) + body


def _heartbeat(entity: bytes, last: int, count: int) -> bytes:
    body = entity + bytes((_READER,)) + entity + bytes((_WRITER,)) + struct.pack("<iIiII", 0, 1, 0, last, count)
    return struct.pack("<BBH", 0x07, 0x01, len(body)) + body
