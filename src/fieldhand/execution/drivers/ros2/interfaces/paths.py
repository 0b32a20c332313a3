"""Ways to a value in a message: ``percentage``, ``pose.pose.position.x``, ``cells[0].value``."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from fieldhand.errors import Ros2Error

_STEP = re.compile(r"(?P<field>[A-Za-z][A-Za-z0-9_]*)(?P<places>(?:\[\d{1,6}\])*)")


def read_path(path: str) -> tuple[str | int, ...]:
    """The steps of a path: names of fields and places in arrays.

    Raises:
        Ros2Error: It is none.
    """
    steps: list[str | int] = []
    for part in path.split("."):
        found = _STEP.fullmatch(part)
        if found is None:
            raise Ros2Error(f"{path!r} is no path to a value", advice="write field.field, or field[0].field")
        steps.append(found["field"])
        steps += [int(place) for place in re.findall(r"\d+", found["places"])]
    return tuple(steps)


def value_at(message: Mapping[str, object], path: str) -> object:
    """The value at a path.

    Raises:
        Ros2Error: It is not there; how far the path leads is named.
    """
    value: object = message
    for step in read_path(path):
        if isinstance(step, str):
            if not isinstance(value, Mapping) or step not in value:
                raise Ros2Error(f"there is no {step!r} on the way of {path} in this message")
            value = value[step]
        else:
            if not isinstance(value, Sequence) or isinstance(value, str) or step >= len(value):
                has = len(value) if isinstance(value, Sequence) and not isinstance(value, str) else "no"
                raise Ros2Error(f"there is no [{step}] on the way of {path}: this message has {has} there")
            value = value[step]
    return value


def with_value(message: Mapping[str, object], path: str, value: object) -> dict[str, object]:
    """A copy of a message with another value at a path; what is missing on the way is made.

    Raises:
        Ros2Error: The path leads through something that has no fields, or past the next place of an array.
    """
    changed = _with(message, read_path(path), value, path)
    assert isinstance(changed, dict)  # noqa: S101 - a path begins with a field
    return changed


def _with(at: object, steps: tuple[str | int, ...], value: object, path: str) -> object:
    if not steps:
        return value
    step, rest = steps[0], steps[1:]
    if isinstance(step, str):
        if at is not None and not isinstance(at, Mapping):
            raise Ros2Error(f"{step!r} of {path} stands below a value that has no fields")
        fields = dict(at or {})
        fields[step] = _with(fields.get(step), rest, value, path)
        return fields
    many = [] if at is None else list(at) if isinstance(at, (tuple, list, bytes)) else None
    if many is None or step > len(many):
        raise Ros2Error(f"[{step}] of {path} is past the end: places are given in turn, from [0] on")
    before = many[step] if step < len(many) else None
    many[step:] = [_with(before, rest, value, path), *many[step + 1 :]]
    return tuple(many)
