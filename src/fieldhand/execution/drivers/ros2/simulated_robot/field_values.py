"""Numbers put into messages: what the driver takes out by a profile's bindings, the other way round."""

from __future__ import annotations

import math
from collections.abc import Mapping

from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.transport import Message
from fieldhand.robot.bindings import FieldBinding

#: Larger than any whole number that a type of ROS holds is no reading.
_MOST = 2.0**63


def field_value(
    interfaces: Interfaces, type_name: str, binding: FieldBinding, reading: float | None
) -> bool | float | None:
    """A reading as the field has it that a binding names.

    Args:
        reading: In the unit of its quantity; None of a sensor that gave nothing, which is NaN.

    Returns:
        None where the field cannot say it: there is no whole number that means nothing.

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


def with_header(interfaces: Interfaces, type_name: str, message: Message, header: Message) -> Message:
    """A message with its header, if its type has one."""
    head = interfaces.fields(type_name).get("header")
    return message if head is None or head.base != "std_msgs/msg/Header" else {**message, "header": header}


def submessage(message: Message, name: str) -> Message:
    """A message within a message; an empty one where there is none."""
    part = message.get(name)
    return part if isinstance(part, Mapping) else {}
