"""Parts of the poses in goals that a client sends, which may be malformed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.transport import RosMessage


def yaw_of_quaternion(orientation: RosMessage) -> float:
    """Return the yaw of a quaternion in radians."""
    x, y, z, w = numbers(orientation, "x", "y", "z", "w")
    return math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)


def numbers(message: RosMessage, *names: str) -> tuple[float, ...]:
    """Return some numbers of a message.

    Raises:
        Ros2Error: Not all of them are finite numbers.
    """
    values = tuple(message.get(name) for name in names)
    if not all(isinstance(value, (int, float)) and math.isfinite(value) for value in values):
        raise Ros2Error(f"{', '.join(names)} are not all numbers")
    return tuple(float(value) for value in values if isinstance(value, (int, float)))


def part(message: object, name: str) -> RosMessage:
    """Return a message within a message; an empty one if there is none."""
    part = message.get(name) if isinstance(message, Mapping) else None
    return part if isinstance(part, Mapping) else {}


def listed(value: object) -> Sequence[object]:
    """Return a sequence; an empty one for anything else."""
    return value if isinstance(value, (tuple, list)) else ()
