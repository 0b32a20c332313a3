"""Readings written into message fields: the inverse of what the driver reads by a profile's bindings."""

from __future__ import annotations

import math
from collections.abc import Mapping

from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.transport import RosMessage
from fieldhand.robot.bindings import FieldBinding

#: Larger magnitudes than any integer type of ROS are no reading.
_MOST = 2.0**63


def field_value(
    interfaces: Interfaces, type_name: str, binding: FieldBinding, reading: float | None
) -> bool | float | None:
    """Return a reading as the value of a bound field.

    Args:
        reading: Value in the unit of its quantity; None if the sensor failed, sent as NaN.

    Returns:
        None if the field cannot represent it: integers have no NaN.

    Raises:
        Ros2Error: The path does not lead to a field of this type.
    """
    kind = interfaces.field_at(type_name, binding.path).base
    value = math.nan if reading is None else (reading - binding.offset) / binding.scale
    if kind in ("float32", "float64"):
        return value
    if not math.isfinite(value) or abs(value) > _MOST:
        return None
    return bool(round(value)) if kind == "bool" else round(value)


def with_header(interfaces: Interfaces, type_name: str, message: RosMessage, header: RosMessage) -> RosMessage:
    """Add a header to a message whose type has one."""
    head = interfaces.fields(type_name).get("header")
    return message if head is None or head.base != "std_msgs/msg/Header" else {**message, "header": header}


def submessage(message: RosMessage, name: str) -> RosMessage:
    """Return a nested message; empty if there is none."""
    part = message.get(name)
    return part if isinstance(part, Mapping) else {}
