"""Access to message fields by path: ``pose.pose.position.x``, ``cells[0].value``.

A missing field reads as None and is created when written.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.transport import RosMessage
from fieldhand.robot.bindings import FieldBinding

PathStep = str | int

_STEP = re.compile(r"([A-Za-z]\w*)((?:\[\d{1,6}\])*)")


@lru_cache(maxsize=1024)
def steps_of(path: str) -> tuple[PathStep, ...]:
    """Parse a path into its field names and array indices.

    Raises:
        Ros2Error: The text is not a path.
    """
    steps: list[PathStep] = []
    for part in path.split("."):
        match = _STEP.fullmatch(part)
        if match is None:
            raise Ros2Error(
                f"{path!r} is not a path into a message",
                advice="write names with dots between, such as pose.position.x or cells[0].value",
            )
        steps.append(match[1])
        steps.extend(int(position) for position in re.findall(r"\d+", match[2]))
    return tuple(steps)


def value_at(message: RosMessage, path: str) -> object:
    """Return the value at a path; None if there is none."""
    value: object = message
    for step in steps_of(path):
        if isinstance(step, str):
            value = value.get(step) if isinstance(value, Mapping) else None
        else:
            value = value[step] if isinstance(value, (tuple, list, bytes)) and step < len(value) else None
    return value


def number_at(message: RosMessage, binding: FieldBinding) -> float | None:
    """Return the number at a binding's path, scaled to its unit; None if it is missing or not finite."""
    value = value_at(message, binding.path)
    if not isinstance(value, (bool, int, float)):
        return None
    number = float(value) * binding.scale + binding.offset
    return number if math.isfinite(number) else None


def seconds_at(message: RosMessage, path: str) -> float | None:
    """Return the seconds of the ``builtin_interfaces/msg/Time`` at a path; None if it is missing or 0."""
    stamp = value_at(message, path)
    if not isinstance(stamp, Mapping):
        return None
    seconds, nanoseconds = stamp.get("sec"), stamp.get("nanosec")
    if not isinstance(seconds, int) or not isinstance(nanoseconds, int):
        return None
    return seconds + 1e-9 * nanoseconds or None


def message_of(values: Mapping[str, object]) -> RosMessage:
    """Build a message from values by path. Of an array, all elements up to the last one named must be given.

    Raises:
        Ros2Error: Paths contradict each other, or leave out array elements.
    """
    root: dict[PathStep, Any] = {}
    for path, value in values.items():
        here, steps = root, steps_of(path)
        for step in steps[:-1]:
            here = here.setdefault(step, {})
            if not isinstance(here, dict):
                raise Ros2Error(f"{path!r} conflicts with a path that contains it")
        if steps[-1] in here:
            raise Ros2Error(f"{path!r} conflicts with a path that contains it")
        here[steps[-1]] = value
    return {str(name): _whole(value, str(name)) for name, value in root.items()}


def _whole(node: object, path: str) -> object:
    """Convert a node: to a tuple if its keys are indices, otherwise to a mapping."""
    if not isinstance(node, dict):
        return node
    positions = sorted(k for k in node if isinstance(k, int))
    if not positions:
        return {name: _whole(value, f"{path}.{name}") for name, value in node.items()}
    if len(positions) != len(node) or positions != list(range(len(positions))):
        raise Ros2Error(f"the elements of {path!r} are not numbered consecutively from [0]")
    return tuple(_whole(node[p], f"{path}[{p}]") for p in positions)
