"""Parser of interface definitions.

A service consists of two messages. An action consists of three, plus five of the topics and services it is built from
(design.ros2.org, "Actions"): ``N_SendGoal_Request``, ``N_SendGoal_Response``, ``N_GetResult_Request``,
``N_GetResult_Response``, ``N_FeedbackMessage``.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from fieldhand.errors import InputError, ProfileError

#: ``package/kind/Name``.
INTERFACE_NAME = re.compile(r"[a-z][a-z0-9_]*/(msg|srv|action)/[A-Za-z][A-Za-z0-9_]*")

#: Primitive types; all others are messages.
INTEGERS = {f"{sign}int{bits}": bits for sign in ("", "u") for bits in (8, 16, 32, 64)} | {"byte": 8, "char": 8}
FLOATS = ("float32", "float64")
PRIMITIVES = (*INTEGERS, *FLOATS, "bool", "string")

#: Arrays of these are ``bytes`` in a message, one unsigned byte per value.
OCTETS = ("uint8", "byte", "char")

#: Field that rosbags adds to a message without fields, because the wire format needs one.
_FILLER = "structure_needs_at_least_one_member"

#: Size limit of one definition in characters; those of real robots have a few thousand.
_LONGEST = 100_000


@dataclass(frozen=True, kw_only=True)
class FieldType:
    """Type of a field.

    Attributes:
        base: ``float64``, ``string``, ..., or the name of a message.
        many: ``one`` value, a fixed ``array``, or a ``sequence`` of variable length.
        count: Length of an array; maximum length of a sequence, 0 for no limit.
        most_characters: Maximum length of a string; 0 for no limit.
    """

    base: str
    many: Literal["one", "array", "sequence"] = "one"
    count: int = 0
    most_characters: int = 0

    @property
    def primitive(self) -> bool:
        """True if the base type is primitive."""
        return self.base in PRIMITIVES

    @property
    def octets(self) -> bool:
        """True if values are ``bytes`` in a message."""
        return self.many != "one" and self.base in OCTETS

    def __str__(self) -> str:
        base = f"{self.base}<={self.most_characters}" if self.most_characters else self.base
        if self.many == "one":
            return base
        at_most = "<=" if self.many == "sequence" and self.count else ""
        return f"{base}[{at_most}{self.count or ''}]"


@dataclass(frozen=True, kw_only=True)
class Definition:
    """Definition of a message, or of one part of a service or an action.

    Attributes:
        name: ``sensor_msgs/msg/NavSatFix``, ``std_srvs/srv/Trigger_Response``,
            ``nav2_msgs/action/NavigateToPose_SendGoal_Request``.
        defaults: Explicit defaults by field, as in the text, not validated.
        constants: Constants by name.
    """

    name: str
    fields: Mapping[str, FieldType]
    defaults: Mapping[str, object] = field(default_factory=dict)
    constants: Mapping[str, object] = field(default_factory=dict)


def read_definitions(name: str, text: str, *, where: str) -> tuple[Definition, ...]:
    """Parse the messages of a ``.msg``, ``.srv`` or ``.action`` file.

    Args:
        name: ``package/msg/Name``, ``package/srv/Name`` or ``package/action/Name``.
        where: File or part of a profile, for error messages.

    Raises:
        ProfileError: The text cannot be parsed; the line is named if it is known.
    """
    if not INTERFACE_NAME.fullmatch(name):
        raise ProfileError(
            f"{name!r} is not an interface", where=where, advice="call it package/msg/Name, srv or action"
        )
    if len(text) > _LONGEST:
        raise ProfileError(f"{len(text)} characters: no definition has more than {_LONGEST}", where=f"{where}: {name}")
    package, kind, short = name.split("/")
    parts = re.split(r"^---[ \t]*(?:#.*)?$", text.replace("\r\n", "\n"), flags=re.MULTILINE)
    endings = {"msg": [""], "srv": ["_Request", "_Response"], "action": ["_Goal", "_Result", "_Feedback"]}[kind]
    if len(parts) != len(endings):
        raise ProfileError(
            f"{len(parts)} parts: a definition of this kind has {len(endings)}, with a line --- between them",
            where=f"{where}: {name}",
        )
    own = tuple(_read(package, f"{name}{e}", p, f"{where}: {name}") for e, p in zip(endings, parts, strict=True))
    return own + (_around_action(package, short) if kind == "action" else ())


def from_rosbags(name: str, parsed: tuple[Any, Any]) -> Definition:
    """Convert a definition from rosbags: constants, then fields."""
    constants, fields = parsed
    return Definition(
        name=name,
        fields={n: _rosbags_type(t) for n, t in fields if n != _FILLER},
        constants={n: value for n, _, value in constants},
    )


def to_rosbags(definition: Definition) -> tuple[list[Any], list[Any]]:
    """Convert a definition to the form that rosbags hashes."""
    from rosbags.interfaces import Nodetype

    fields = []
    for name, kind in definition.fields.items():
        base: Any = (Nodetype.BASE, (kind.base, kind.most_characters))
        if not kind.primitive:
            base = (Nodetype.NAME, kind.base)
        if kind.many != "one":
            base = (Nodetype.ARRAY if kind.many == "array" else Nodetype.SEQUENCE, (base, kind.count))
        fields.append((name, base))
    return [], fields or [(_FILLER, (Nodetype.BASE, ("uint8", 0)))]


def require_rosbags() -> None:
    """Raise an error with installation advice if rosbags is missing.

    Raises:
        InputError: rosbags is not installed.
    """
    try:
        import rosbags.typesys  # noqa: F401
    except ImportError as error:
        raise InputError(
            "for a robot over ROS 2 the package rosbags is needed, which is not installed here",
            advice='install it with: pip install "fieldhand[ros2-dds]"',
        ) from error


def _read(package: str, name: str, text: str, where: str) -> Definition:
    """Parse one part as a message: rosbags resolves names only next to ``msg``."""
    from rosbags.typesys.base import TypesysError
    from rosbags.typesys.msg import MSGParser

    try:
        (message,) = MSGParser(f"MSG: {package}/msg/Part\n{text.strip()}\n").specification()
    except (TypesysError, ValueError) as error:
        bad = next((line for line in text.splitlines() if not _readable(line)), "")
        raise ProfileError(
            f"this line cannot be read: {bad.strip()!r}" if bad else "it cannot be read",
            where=where,
            advice="each line is a type and a name, such as float64 value",
        ) from error
    fields: dict[str, FieldType] = {}
    for each in message.fields:
        if each.name in fields:
            raise ProfileError(f"two fields are called {each.name!r}", where=where)
        fields[each.name] = kind = _rosbags_type_of(each.typ)
        if kind.many == "array" and kind.count == 0:
            raise ProfileError(f"{each.name} is an array of no values", where=where)
    return Definition(
        name=name,
        fields=fields,
        defaults={each.name: each.value for each in message.fields if each.value is not None},
        constants={each.name: each.value for each in message.constants},
    )


def _readable(line: str) -> bool:
    from rosbags.typesys.base import TypesysError
    from rosbags.typesys.msg import MSGParser

    try:
        MSGParser(f"MSG: package/msg/Part\n{line.strip()}\n").specification()
    except (TypesysError, ValueError):
        return False
    return True


def _rosbags_type_of(parsed: Any) -> FieldType:
    from rosbags.typesys.base import create_field_desc

    return _rosbags_type(create_field_desc(parsed))


def _rosbags_type(parsed: Any) -> FieldType:
    node, inner = int(parsed[0]), parsed[1]
    if node in (3, 4):
        one = _rosbags_type(inner[0])
        return FieldType(
            base=one.base,
            many="array" if node == 3 else "sequence",
            count=inner[1],
            most_characters=one.most_characters,
        )
    return FieldType(base=inner) if node == 2 else FieldType(base=inner[0], most_characters=inner[1])


def _around_action(package: str, short: str) -> tuple[Definition, ...]:
    action = f"{package}/action/{short}"
    goal_id = FieldType(base="unique_identifier_msgs/msg/UUID")
    wrapped: dict[str, dict[str, FieldType]] = {
        "SendGoal_Request": {"goal_id": goal_id, "goal": FieldType(base=f"{action}_Goal")},
        "SendGoal_Response": {
            "accepted": FieldType(base="bool"),
            "stamp": FieldType(base="builtin_interfaces/msg/Time"),
        },
        "GetResult_Request": {"goal_id": goal_id},
        "GetResult_Response": {"status": FieldType(base="int8"), "result": FieldType(base=f"{action}_Result")},
        "FeedbackMessage": {"goal_id": goal_id, "feedback": FieldType(base=f"{action}_Feedback")},
    }
    return tuple(Definition(name=f"{action}_{ending}", fields=fields) for ending, fields in wrapped.items())
