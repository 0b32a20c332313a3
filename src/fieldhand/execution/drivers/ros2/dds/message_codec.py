"""DDS types and samples, generated from interface definitions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from cyclonedds.idl import make_idl_struct, types

from fieldhand.execution.drivers.ros2.dds.names import wire_type
from fieldhand.execution.drivers.ros2.interfaces import FieldType, Interfaces
from fieldhand.execution.drivers.ros2.transport import RosMessage, most_bytes

#: Suffix that no ROS field name has; avoids Python keywords and attributes such as ``from`` and ``serialize``.
_END = "_"
_FILLER = "structure_needs_at_least_one_member_"
_MANY: Any = types  # the library declares array and sequence as plain classes, but they are generic
_PRIMITIVES: dict[str, Any] = {
    "bool": bool,
    "byte": types.uint8,
    "char": types.uint8,
    "string": str,
    **{f"{u}int{bits}": getattr(types, f"{u}int{bits}") for u in ("", "u") for bits in (8, 16, 32, 64)},
    "float32": types.float32,
    "float64": types.float64,
}


class Unreadable:
    """Placeholder for a received message that cannot be decoded."""

    sample_info: Any = None

    def __init__(self, why: str) -> None:
        self.why = why


@dataclass(frozen=True)
class Header:
    """Header of a request and its reply: id of the client and number of the request."""

    client: int
    number: int


class MessageCodec:
    """Creates DDS types, and encodes and decodes messages.

    Args:
        interfaces: Known interface definitions.
    """

    def __init__(self, interfaces: Interfaces) -> None:
        self.interfaces = interfaces
        self._inner: dict[str, Any] = {}
        self._outer: dict[tuple[str, bool], Any] = {}

    def type_of(self, message: str, *, with_header: bool = False) -> Any:
        """Return the DDS type of a topic.

        Args:
            with_header: True for requests and replies.

        Raises:
            Ros2Error: The type is unknown.
        """
        if (message, with_header) not in self._outer:
            made = self._idl_type(message, with_header=with_header)
            # One malformed message must not hide the valid ones taken with it.
            made.deserialize = classmethod(partial(_deserialize, message=message))
            self._outer[message, with_header] = made
        return self._outer[message, with_header]

    def encode(self, message: str, given: RosMessage, header: Header | None = None) -> Any:
        """Encode a message as a DDS sample.

        Raises:
            Ros2Error: The message does not fit its type; the field is named.
        """
        whole = self.interfaces.complete(message, given)
        made = self.type_of(message, with_header=header is not None)
        values = self._encode_fields(message, whole)
        return made(**values) if header is None else made(guid=header.client, seq=header.number, **values)

    def decode(self, message: str, sample: Any) -> dict[str, object]:
        """Decode a received sample."""
        return {n: self._decode(k, getattr(sample, n + _END)) for n, k in self.interfaces.fields(message).items()}

    def _idl_type(self, message: str, *, with_header: bool = False) -> Any:
        kinds: dict[str, Any] = {"guid": types.uint64, "seq": types.int64} if with_header else {}
        fields = self.interfaces.fields(message)
        kinds |= {name + _END: self._kind(kind) for name, kind in fields.items()}
        if not fields:
            kinds[_FILLER] = types.uint8
        name = wire_type(message).replace("::", ".")
        return make_idl_struct(name.rpartition(".")[2], name, kinds)

    def _kind(self, kind: FieldType) -> Any:
        if kind.primitive:
            one = _PRIMITIVES[kind.base]
        else:
            if kind.base not in self._inner:
                self._inner[kind.base] = self._idl_type(kind.base)
            one = self._inner[kind.base]
        if kind.many == "array":
            return _MANY.array[one, kind.count]
        return _MANY.sequence[one] if kind.many == "sequence" else one

    def _encode_fields(self, message: str, whole: Mapping[str, Any]) -> dict[str, Any]:
        fields = self.interfaces.fields(message)
        if not fields:
            return {_FILLER: 0}
        return {name + _END: self._encode(kind, whole[name]) for name, kind in fields.items()}

    def _encode(self, kind: FieldType, value: Any) -> Any:
        if kind.primitive:
            return value
        if kind.many == "one":
            return self._inner[kind.base](**self._encode_fields(kind.base, value))
        return [self._inner[kind.base](**self._encode_fields(kind.base, v)) for v in value]

    def _decode(self, kind: FieldType, value: Any) -> object:
        if kind.octets:
            return bytes(value)
        if kind.many == "one":
            return value if kind.primitive else self.decode(kind.base, value)
        return tuple(value if kind.primitive else (self.decode(kind.base, v) for v in value))


def _deserialize(
    cls: Any, data: bytes, has_header: bool = True, use_version_2: bool | None = None, *, message: str
) -> Any:
    if len(data) > (most := most_bytes(message)):
        return Unreadable(f"it has {len(data)} bytes, more than {most}")
    try:
        return cls.__idl__.deserialize(data, has_header=has_header, use_version_2=use_version_2)
    except Exception as error:  # noqa: BLE001 - the bytes come from anyone, and the library raises whatever it meets
        return Unreadable(f"its bytes do not fit its type ({error})")
