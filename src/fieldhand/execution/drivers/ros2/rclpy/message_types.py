"""Sourced interfaces, and conversion between their generated classes and mappings.

Messages are validated by the same definitions and checks as over DDS.
"""

from __future__ import annotations

import array
import re
from collections.abc import Mapping
from functools import cache
from importlib import import_module
from typing import Any

from ament_index_python.resources import get_resource
from rosidl_parser import definition as idl

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.interfaces import Definition, FieldType
from fieldhand.execution.drivers.ros2.interfaces.definitions import INTERFACE_NAME, PRIMITIVES
from fieldhand.execution.drivers.ros2.interfaces.validation import complete
from fieldhand.execution.drivers.ros2.transport import RosMessage

#: Parts of services and actions, as suffixes of their names.
_PART = re.compile(r"(?P<whole>\w+?)_(?P<part>(?:(?:SendGoal|GetResult)_)?(?:Request|Response)|Goal|Result|Feedback)")
_OF_ACTION = re.compile(r"(?P<whole>\w+?)_(?P<part>SendGoal|GetResult|FeedbackMessage)")
_IMPLIED = {"SendGoal": "SendGoalService", "GetResult": "GetResultService", "FeedbackMessage": "FeedbackMessage"}
_BASICS = {"boolean": "bool", "octet": "byte", "float": "float32", "double": "float64"}


@cache
def class_of(name: str) -> Any:
    """Return the generated class of a topic's or service's type, or of a message within it.

    Args:
        name: ``package/msg/Name``, ``package/srv/Name``, ``package/action/Name_SendGoal``, or a part of one, such as
            ``package/srv/Name_Request``.

    Raises:
        Ros2Error: The interface is not sourced; the missing part is named.
    """
    outer, inner = _divided(name)
    _require_sourced(outer, name)
    package, kind, short = outer.split("/")
    try:
        found = getattr(import_module(f"{package}.{kind}"), short)
        found.__class__.__import_type_support__()
        for step in inner:
            found = getattr(found, step)
    except Exception as error:  # an incompletely built package may raise anything
        raise Ros2Error(
            f"the sourced ROS has {outer}, but it cannot be loaded ({error})",
            advice=f"rebuild the package {package}",
        ) from error
    return found


def to_ros(message: str, given: RosMessage) -> Any:
    """Convert a mapping to a ROS message.

    Raises:
        Ros2Error: The message does not fit its sourced type; the field is named.
    """
    return _to_ros_message(message, complete(definition_of, message, given))


def from_ros(message: str, sample: Any) -> dict[str, object]:
    """Convert a received ROS message to a mapping."""
    return {name: _from_ros_value(kind, getattr(sample, name)) for name, kind in definition_of(message).fields.items()}


@cache
def definition_of(message: str) -> Definition:
    """Return the definition of a sourced message.

    Raises:
        Ros2Error: The message is not sourced, or has a field of an unsupported type.
    """
    made = class_of(message)
    fields = {
        name: _field_type(slot, f"{message}: {name}")
        for name, slot in zip(made.get_fields_and_field_types(), made.SLOT_TYPES, strict=True)
    }
    plain = {name: _from_ros_value(kind, getattr(made(), name)) for name, kind in fields.items() if kind.primitive}
    defaults = {name: value for name, value in plain.items() if (any(value) if isinstance(value, tuple) else value)}
    return Definition(name=message, fields=fields, defaults=defaults)


def _divided(name: str) -> tuple[str, tuple[str, ...]]:
    """Return the interface of a type, and the attribute path to the type: rclpy nests the parts."""
    if not INTERFACE_NAME.fullmatch(name):
        raise Ros2Error(f"{name!r} is not a ROS type", advice="write package/msg/Name, package/srv/Name or action")
    package, kind, short = name.split("/")
    if kind == "srv" and (found := _PART.fullmatch(short)):
        return f"{package}/srv/{found['whole']}", (found["part"],)
    if kind == "action" and (found := _PART.fullmatch(short)):
        first, _, second = found["part"].partition("_")
        return f"{package}/action/{found['whole']}", ("Impl", _IMPLIED[first], second) if second else (first,)
    if kind == "action" and (found := _OF_ACTION.fullmatch(short)):
        return f"{package}/action/{found['whole']}", ("Impl", _IMPLIED[found["part"]])
    return name, ()


def _require_sourced(interface: str, wanted: str) -> None:
    """Raise an error unless the package is sourced and has the interface; nothing of it is imported before."""
    package, _, rest = interface.partition("/")
    try:
        has, _ = get_resource("rosidl_interfaces", package)
    except (LookupError, OSError) as error:
        raise Ros2Error(
            f"the type {wanted} is not known here: the package {package} is not in the ROS that is sourced",
            advice=f"install {package} or source the workspace that has it, or reach the robot by dds, which takes "
            "definitions from its profile",
        ) from error
    if rest not in {line.rpartition(".")[0] for line in has.splitlines()}:
        raise Ros2Error(
            f"the type {wanted} is not known here: the package {package} that is sourced has no {rest}",
            advice="correct the name, or source the robot's own version of the package",
        )


def _field_type(slot: Any, where: str) -> FieldType:
    if isinstance(slot, idl.AbstractNestedType):
        one = _field_type(slot.value_type, where)
        array_ = isinstance(slot, idl.Array)
        count = slot.size if array_ else getattr(slot, "maximum_size", 0)
        return FieldType(
            base=one.base,
            many="array" if array_ else "sequence",
            count=count,
            most_characters=one.most_characters,
        )
    if isinstance(slot, idl.NamespacedType):
        return FieldType(base="/".join((*slot.namespaces, slot.name)))
    if isinstance(slot, idl.AbstractString):
        return FieldType(base="string", most_characters=getattr(slot, "maximum_size", 0))
    base = _BASICS.get(slot.typename, slot.typename) if isinstance(slot, idl.BasicType) else "wide string"
    if base not in PRIMITIVES:
        raise Ros2Error(f"{where} is a {base}, which is not supported")
    return FieldType(base=base)


def _to_ros_message(message: str, whole: Mapping[str, Any]) -> Any:
    made = class_of(message)()
    for name, kind in definition_of(message).fields.items():
        setattr(made, name, _to_ros_value(kind, whole[name]))
    return made


def _to_ros_value(kind: FieldType, value: Any) -> Any:
    """Convert a value for the generated classes."""
    if kind.base == "byte":
        return bytes([value]) if kind.many == "one" else [bytes([v]) for v in value]
    if kind.octets:
        return list(value) if kind.many == "array" else array.array("B", value)
    if kind.many == "one":
        return value if kind.primitive else _to_ros_message(kind.base, value)
    return list(value) if kind.primitive else [_to_ros_message(kind.base, v) for v in value]


def _from_ros_value(kind: FieldType, value: Any) -> object:
    """Convert a value of the generated classes for a mapping."""
    if kind.base == "byte":
        return value[0] if kind.many == "one" else b"".join(value)
    if kind.octets:
        return bytes(value)
    if kind.many == "one":
        return value if kind.primitive else from_ros(kind.base, value)
    if not kind.primitive:
        return tuple(from_ros(kind.base, v) for v in value)
    return tuple(value.tolist() if hasattr(value, "tolist") else value)
