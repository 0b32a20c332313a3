"""Paths into messages: ``pose.pose.position.x``, ``cells[0].value``.

What is not there is None when it is read, and is made when it is written.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.transport import Message
from fieldhand.robot.bindings import FieldBinding

Step = str | int

_STEP = re.compile(r"([A-Za-z]\w*)((?:\[\d{1,6}\])*)")


@lru_cache(maxsize=1024)
def steps_of(path: str) -> tuple[Step, ...]:
    """The names and positions that a path goes through.

    Raises:
        Ros2Error: It is none.
    """
    steps: list[Step] = []
    for part in path.split("."):
        match = _STEP.fullmatch(part)
        if match is None:
            raise Ros2Error(
                f"{path!r} is no path into a message",
                advice="write names with dots between, such as pose.position.x or cells[0].value",
            )
        steps.append(match[1])
        steps.extend(int(position) for position in re.findall(r"\d+", match[2]))
    return tuple(steps)


def value_at(message: Message, path: str) -> object:
    """What stands at a path; None where nothing does."""
    value: object = message
    for step in steps_of(path):
        if isinstance(step, str):
            value = value.get(step) if isinstance(value, Mapping) else None
        else:
            value = value[step] if isinstance(value, (tuple, list, bytes)) and step < len(value) else None
    return value


def number_at(message: Message, binding: FieldBinding) -> float | None:
    """The number of a binding in its own unit; None where there is none, or one that is not finite."""
    value = value_at(message, binding.path)
    if not isinstance(value, (bool, int, float)):
        return None
    number = float(value) * binding.scale + binding.offset
    return number if math.isfinite(number) else None


def seconds_at(message: Message, path: str) -> float | None:
    """Return the seconds of the ``builtin_interfaces/msg/Time`` at a path; None where there is none or it is 0."""
    stamp = value_at(message, path)
    if not isinstance(stamp, Mapping):
        return None
    seconds, nanoseconds = stamp.get("sec"), stamp.get("nanosec")
    if not isinstance(seconds, int) or not isinstance(nanoseconds, int):
        return None
    return seconds + 1e-9 * nanoseconds or None


def message_of(values: Mapping[str, object]) -> Message:
    """A message of values by their paths. Of an array, every element up to the last that is named must be.

    Raises:
        Ros2Error: Paths contradict each other, or leave elements out.
    """
    root: dict[Step, Any] = {}
    for path, value in values.items():
        here, steps = root, steps_of(path)
        for step in steps[:-1]:
            here = here.setdefault(step, {})
            if not isinstance(here, dict):
                raise Ros2Error(f"{path!r} stands beside a path that it is part of")
        if steps[-1] in here:
            raise Ros2Error(f"{path!r} stands beside a path that it is part of")
        here[steps[-1]] = value
    return {str(name): _whole(value, str(name)) for name, value in root.items()}


def _whole(node: object, path: str) -> object:
    """A node whose keys are positions as a tuple, any other as a mapping."""
    if not isinstance(node, dict):
        return node
    positions = sorted(k for k in node if isinstance(k, int))
    if not positions:
        return {name: _whole(value, f"{path}.{name}") for name, value in node.items()}
    if len(positions) != len(node) or positions != list(range(len(positions))):
        raise Ros2Error(f"the elements of {path!r} are not named one after the other from [0] on")
    return tuple(_whole(node[p], f"{path}[{p}]") for p in positions)
