"""Names of topics, services and types on the wire, and back."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Literal

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.transport import Rmw

ServiceHalf = Literal["Request", "Response"]

#: Middlewares whose services match ours but do not interoperate: they identify the request of a reply differently.
INCOMPATIBLE_SERVICES: tuple[Rmw, ...] = ("fastrtps", "connext")

_NAME = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)+")
_TYPE = re.compile(r"(?P<package>[a-z][a-z0-9_]*)::(?P<kind>msg|srv|action)::dds_::(?P<name>\w+)_")


def topic_name(topic: str) -> str:
    """Return the DDS name of a topic."""
    return f"rt{_checked(topic)}"


def request_name(service: str) -> str:
    """Return the DDS name of a service's request topic."""
    return f"rq{_checked(service)}Request"


def reply_name(service: str) -> str:
    """Return the DDS name of a service's reply topic."""
    return f"rr{_checked(service)}Reply"


def wire_type(message: str) -> str:
    """Convert ``package/msg/Name`` to ``package::msg::dds_::Name_``."""
    package, kind, name = message.split("/")
    return f"{package}::{kind}::dds_::{name}_"


def ros_type(type_name: str) -> str:
    """Convert a DDS type name to ROS form, a request's to its service; return other names unchanged."""
    found = _TYPE.fullmatch(type_name)
    if found is None:
        return type_name
    name = found["name"]
    if found["kind"] != "msg":
        name = name.removesuffix("_Request").removesuffix("_Response")
    return f"{found['package']}/{found['kind']}/{name}"


def rmw_of(participant: bytes) -> Rmw:
    """Return the middleware of a participant from its vendor id, the first two bytes of its key (RTPS 9.3.1.5)."""
    vendors: dict[bytes, Rmw] = {b"\x01\x10": "cyclonedds", b"\x01\x0f": "fastrtps", b"\x01\x01": "connext"}
    return vendors.get(participant[:2], "unknown")


@dataclass(frozen=True, kw_only=True)
class UserData:
    """User data of an endpoint: pairs ``key=value;``."""

    values: dict[str, str] = field(default_factory=dict)

    @classmethod
    def parse(cls, data: bytes) -> UserData:
        """Parse user data; other formats give no values."""
        parts = (part.partition("=") for part in data[:4096].decode("utf-8", "replace").split(";"))
        return cls(values={key.strip(): value.strip() for key, between, value in parts if between})

    def encoded(self) -> bytes:
        """Encode the pairs as bytes."""
        return "".join(f"{key}={value};" for key, value in self.values.items()).encode()


def _checked(name: str) -> str:
    if not _NAME.fullmatch(name):
        raise Ros2Error(
            f"{name!r} is not a valid topic or service name", advice="write /name or /name/name: letters, digits and _"
        )
    return name
