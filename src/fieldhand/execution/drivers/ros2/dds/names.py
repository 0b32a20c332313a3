"""What topics, services and types are called on the wire, and back."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Literal

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.transport import Rmw

Half = Literal["Request", "Response"]

#: Whose services find ours and do not understand them: they tell otherwise which reply is to which request.
INCOMPATIBLE_SERVICES: tuple[Rmw, ...] = ("fastrtps", "connext")

_NAME = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)+")
_TYPE = re.compile(r"(?P<package>[a-z][a-z0-9_]*)::(?P<kind>msg|srv|action)::dds_::(?P<name>\w+)_")


def topic_name(topic: str) -> str:
    """A topic on the wire."""
    return f"rt{_checked(topic)}"


def request_name(service: str) -> str:
    """The requests of a service on the wire."""
    return f"rq{_checked(service)}Request"


def reply_name(service: str) -> str:
    """The replies of a service on the wire."""
    return f"rr{_checked(service)}Reply"


def wire_type(message: str) -> str:
    """``package/msg/Name`` as ``package::msg::dds_::Name_``."""
    package, kind, name = message.split("/")
    return f"{package}::{kind}::dds_::{name}_"


def ros_type(type_name: str) -> str:
    """A type as ROS writes it; a request is called by its service. What is not ROS's stays as it is."""
    found = _TYPE.fullmatch(type_name)
    if found is None:
        return type_name
    name = found["name"]
    if found["kind"] != "msg":
        name = name.removesuffix("_Request").removesuffix("_Response")
    return f"{found['package']}/{found['kind']}/{name}"


def rmw_of(participant: bytes) -> Rmw:
    """What implements DDS, by the first two bytes of a participant's key: its vendor (RTPS 9.3.1.5)."""
    vendors: dict[bytes, Rmw] = {b"\x01\x10": "cyclonedds", b"\x01\x0f": "fastrtps", b"\x01\x01": "connext"}
    return vendors.get(participant[:2], "unknown")


@dataclass(frozen=True, kw_only=True)
class UserData:
    """What an endpoint says of itself: ``key=value;`` and so on."""

    values: dict[str, str] = field(default_factory=dict)

    @classmethod
    def parse(cls, data: bytes) -> UserData:
        """What is no such list says nothing."""
        parts = (part.partition("=") for part in data[:4096].decode("utf-8", "replace").split(";"))
        return cls(values={key.strip(): value.strip() for key, between, value in parts if between})

    def encoded(self) -> bytes:
        """As it stands on the wire."""
        return "".join(f"{key}={value};" for key, value in self.values.items()).encode()


def _checked(name: str) -> str:
    if not _NAME.fullmatch(name):
        raise Ros2Error(
            f"{name!r} is no name of a topic or service", advice="write /name or /name/name: letters, digits and _"
        )
    return name
