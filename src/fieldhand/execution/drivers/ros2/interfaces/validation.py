"""Validation of messages against their definitions: types, ranges, and defaults of omitted fields."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import cast

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.interfaces.definitions import INTEGERS, Definition, FieldType

#: Largest finite value of a 32-bit float.
_MOST_FLOAT32 = 3.4028234663852886e38

DefinitionOf = Callable[[str], Definition]


def complete(definition_of: DefinitionOf, message: str, given: Mapping[str, object], at: str = "") -> dict[str, object]:
    """Return a message with all its fields, in the order of its definition.

    Args:
        given: Values of some fields; omitted ones get their default. Lists are accepted for tuples, integers for
            floats.
        at: Path of the message within the enclosing one.

    Raises:
        Ros2Error: A value does not fit; its path is named.
    """
    definition = definition_of(message)
    for name in given:
        if name not in definition.fields:
            raise Ros2Error(
                f"{message} has no field {name!r}",
                where=at,
                advice=f"it has {', '.join(definition.fields)}" if definition.fields else "it has none at all",
            )
    whole: dict[str, object] = {}
    for name, kind in definition.fields.items():
        path = f"{at}.{name}" if at else name
        if name in given:
            whole[name] = _value(definition_of, kind, given[name], path)
        elif name in definition.defaults:
            whole[name] = _value(definition_of, kind, definition.defaults[name], path)
        else:
            whole[name] = _default(definition_of, kind, path)
    return whole


def _default(definition_of: DefinitionOf, kind: FieldType, path: str) -> object:
    if kind.octets:
        return bytes(kind.count if kind.many == "array" else 0)
    if kind.many == "sequence":
        return ()
    if kind.base == "bool":
        one: object = False
    elif kind.base == "string":
        one = ""
    elif kind.primitive:
        one = 0 if kind.base in INTEGERS else 0.0
    else:
        one = complete(definition_of, kind.base, {}, path)
    return one if kind.many == "one" else (one,) * kind.count


def _value(definition_of: DefinitionOf, kind: FieldType, value: object, path: str) -> object:
    if kind.many == "one":
        return _one(definition_of, kind, value, path)
    if not isinstance(value, (bytes, bytearray, tuple, list)):
        raise _unfit(kind, value, path)
    if kind.many == "array" and len(value) != kind.count:
        raise Ros2Error(f"{len(value)} values: {kind} has {kind.count}", where=path)
    if kind.many == "sequence" and kind.count and len(value) > kind.count:
        raise Ros2Error(f"{len(value)} values: {kind} has at most {kind.count}", where=path)
    if kind.octets and isinstance(value, (bytes, bytearray)):
        return bytes(value)
    each = tuple(_one(definition_of, kind, v, f"{path}[{i}]") for i, v in enumerate(value))
    return bytes(cast("tuple[int, ...]", each)) if kind.octets else each


def _one(definition_of: DefinitionOf, kind: FieldType, value: object, path: str) -> object:
    if kind.base == "bool":
        if not isinstance(value, bool):
            raise _unfit(kind, value, path)
        return value
    if kind.base == "string":
        return _text(kind, value, path)
    if kind.base in INTEGERS:
        return _integer(kind, value, path)
    if kind.primitive:
        return _float(kind, value, path)
    if not isinstance(value, Mapping):
        raise _unfit(kind, value, path)
    return complete(definition_of, kind.base, value, path)


def _text(kind: FieldType, value: object, path: str) -> str:
    if not isinstance(value, str):
        raise _unfit(kind, value, path)
    try:
        size = len(value.encode())
    except UnicodeEncodeError as error:
        raise Ros2Error("this text contains half a surrogate pair", where=path) from error
    if "\0" in value:
        raise Ros2Error("this text contains a null character, which no ROS string may contain", where=path)
    if kind.most_characters and size > kind.most_characters:
        raise Ros2Error(f"{size} characters: {kind} has at most {kind.most_characters}", where=path)
    return value


def _integer(kind: FieldType, value: object, path: str) -> int:
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    if isinstance(value, bool) or not isinstance(value, int):
        raise _unfit(kind, value, path)
    bits = INTEGERS[kind.base]
    least, most = (-(1 << bits - 1), (1 << bits - 1) - 1) if kind.base.startswith("int") else (0, (1 << bits) - 1)
    if not least <= value <= most:
        raise Ros2Error(f"{value} does not fit in {kind.base}, which ranges from {least} to {most}", where=path)
    return value


def _float(kind: FieldType, value: object, path: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise _unfit(kind, value, path)
    try:
        number = float(value)
    except OverflowError as error:
        raise Ros2Error(f"this number is too large for a {kind.base}", where=path) from error
    if kind.base == "float32" and _MOST_FLOAT32 < abs(number) < float("inf"):
        raise Ros2Error(f"{number:g} is too large for a float32", where=path)
    return number


def _unfit(kind: FieldType, value: object, path: str) -> Ros2Error:
    return Ros2Error(f"{str(value)[:60]!r} ({type(value).__name__}) is not a {kind}", where=path)
