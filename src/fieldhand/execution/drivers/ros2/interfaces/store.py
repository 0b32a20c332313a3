"""All interface definitions for one robot."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from importlib.resources import files

from fieldhand.compatibility import Traversable
from fieldhand.errors import ProfileError, Ros2Error
from fieldhand.execution.drivers.ros2.interfaces import validation
from fieldhand.execution.drivers.ros2.interfaces.definitions import (
    Definition,
    FieldType,
    from_rosbags,
    read_definitions,
    require_rosbags,
    to_rosbags,
)
from fieldhand.execution.drivers.ros2.message_fields import steps_of
from fieldhand.execution.drivers.ros2.transport import RosMessage
from fieldhand.robot.bindings import Distro

#: Limit of values in a message with empty sequences: a definition could demand more than memory holds.
_MOST_VALUES = 100_000
#: Limit of nesting.
_DEEPEST = 20


class Interfaces:
    """Messages, services and actions by name, for one release of ROS.

    Message names are ``package/msg/Name``, or the parts of services and actions: ``package/srv/Name_Request``,
    ``package/action/Name_FeedbackMessage``.

    Args:
        definitions: Definitions by name, including all nested ones.
        announced: True if endpoints announce the hashes of their types, as from Iron on.
    """

    def __init__(self, definitions: Mapping[str, Definition], *, announced: bool = True) -> None:
        self._definitions = definitions
        self.announced = announced
        self._hashes: dict[str, str] = {}

    @classmethod
    def of(cls, distro: Distro, own: Mapping[str, str] | None = None) -> Interfaces:
        """Load the definitions of a release, overridden by those of a profile.

        Args:
            own: Texts of ``.msg``, ``.srv`` and ``.action`` files, by ``package/kind/Name``.

        Raises:
            ProfileError: A text cannot be parsed, or names an unknown type.
            InputError: rosbags is not installed.
        """
        require_rosbags()
        brought: dict[str, Definition] = {}
        for name, text in (own or {}).items():
            brought.update((each.name, each) for each in read_definitions(name, text, where="ros2: interfaces"))
        store = cls({**_of_release(distro), **brought}, announced=distro != "humble")
        for each in brought.values():
            store._refuse_unknown(each, distro)
        counted: dict[str, int] = {}
        for each in brought.values():
            store._values(each.name, (), counted)
            store._refuse_defaults(each.name)
        return store

    def names(self) -> tuple[str, ...]:
        """Return the names of all messages in alphabetical order."""
        return tuple(sorted(self._definitions))

    def knows(self, name: str) -> bool:
        """Return True if a message, a service, an action, or a service of an action is known."""
        return any(f"{name}{ending}" in self._definitions for ending in ("", "_Request", "_Goal"))

    def has(self, message: str) -> bool:
        """Return True if a message is known."""
        return message in self._definitions

    def definition(self, message: str) -> Definition:
        """Return the definition of a message.

        Raises:
            Ros2Error: The message is unknown.
        """
        if message not in self._definitions:
            short = message if "/msg/" in message else message.rpartition("_")[0].removesuffix("_SendGoal")
            raise Ros2Error(
                f"the type {short} is not known here",
                advice="write package/msg/Name, or give its definition under ros2: interfaces in the robot's profile",
            )
        return self._definitions[message]

    def fields(self, message: str) -> Mapping[str, FieldType]:
        """Return the fields of a message in order."""
        return self.definition(message).fields

    def constants(self, message: str) -> Mapping[str, object]:
        """Return the constants of a message."""
        return self.definition(message).constants

    def field_at(self, message: str, path: str) -> FieldType:
        """Return the type of the field at a path.

        Raises:
            Ros2Error: The path leads nowhere in this message; the error describes where it fails.
        """
        at, kind = message, FieldType(base=message)
        for step in steps_of(path):
            if isinstance(step, int):
                if kind.many == "one":
                    raise Ros2Error(f"{path} of {message}: {kind} is a single value, [{step}] leads nowhere")
                if kind.count and step >= kind.count:
                    raise Ros2Error(f"{path} of {message}: {kind} has no [{step}]")
                kind = FieldType(base=kind.base, most_characters=kind.most_characters)
                continue
            if kind.many != "one":
                raise Ros2Error(f"{path} of {message}: say which of the {kind}, such as [0], before {step}")
            if kind.primitive:
                raise Ros2Error(f"{path} of {message}: {kind} has no fields, {step} leads nowhere")
            at = kind.base
            if step not in self.fields(at):
                raise Ros2Error(
                    f"{path}: {at} has no {step!r}", advice=f"it has {', '.join(self.fields(at)) or 'none'}"
                )
            kind = self.fields(at)[step]
        return kind

    def default(self, message: str) -> dict[str, object]:
        """Return a message with every field at its default."""
        return self.complete(message, {})

    def complete(self, message: str, given: RosMessage) -> dict[str, object]:
        """Return a message with all fields, validated, as it is sent.

        Raises:
            Ros2Error: A value does not fit; the path of its field is named.
        """
        return validation.complete(self.definition, message, given)

    def type_hash(self, message: str) -> str:
        """Return the hash ``RIHS01_...`` of a message (REP 2016); endpoints announce it from Iron on.

        Raises:
            Ros2Error: The message is unknown.
        """
        if message not in self._hashes:
            from rosbags.typesys.store import Typestore

            store = Typestore()
            store.fielddefs.update((d.name, to_rosbags(d)) for d in self._within(message))
            self._hashes[message] = store.hash_rihs01(message)
        return self._hashes[message]

    def _within(self, message: str) -> tuple[Definition, ...]:
        """Return the definitions of a message and of all messages nested in it."""
        found: dict[str, Definition] = {}
        wanted = [message]
        while wanted:
            name = wanted.pop()
            if name not in found:
                found[name] = self.definition(name)
                wanted += [k.base for k in found[name].fields.values() if not k.primitive]
        return tuple(found.values())

    def _refuse_unknown(self, definition: Definition, distro: Distro) -> None:
        for name, kind in definition.fields.items():
            if not kind.primitive and kind.base not in self._definitions:
                wide = kind.base.endswith("/wstring")
                raise ProfileError(
                    f"{name} is a wide string, which is not supported"
                    if wide
                    else f"{kind.base} is unknown in {distro}",
                    where=f"ros2: interfaces: {definition.name}",
                    advice="" if wide else "give its definition under interfaces, too",
                )

    def _refuse_defaults(self, message: str) -> None:
        try:
            self.default(message)
        except Ros2Error as error:
            raise ProfileError(str(error), where=f"ros2: interfaces: {message}") from error

    def _values(self, message: str, within: tuple[str, ...], known: dict[str, int]) -> int:
        """Count the values of a message with empty sequences."""
        if message in within:
            raise ProfileError(f"{message} contains itself", where="ros2: interfaces")
        if message not in known:
            number = 0
            for kind in self.fields(message).values():
                each = 1 if kind.primitive else self._values(kind.base, (*within, message), known)
                if kind.many == "array":
                    each *= max(1, kind.count // 1000) if kind.octets else kind.count
                number += 1 if kind.many == "sequence" else each
            known[message] = number
        if known[message] > _MOST_VALUES or len(within) > _DEEPEST:
            raise ProfileError(f"{message} has more than {_MOST_VALUES} values, or too deep", where="ros2: interfaces")
        return known[message]


@cache
def _of_release(distro: Distro) -> Mapping[str, Definition]:
    from rosbags.typesys.stores import Stores, get_typestore

    release = get_typestore(Stores(f"ros2_{distro}")).fielddefs
    definitions = {name: from_rosbags(name, parsed) for name, parsed in release.items()}
    for folder in ("common", distro):
        for name, text in _texts(files(__package__) / "text" / folder):
            definitions.update((d.name, d) for d in read_definitions(name, text, where=folder))
    return definitions


def _texts(folder: Traversable) -> Iterator[tuple[str, str]]:
    for package in folder.iterdir():
        for kind in package.iterdir():
            for file in kind.iterdir():
                yield f"{package.name}/{kind.name}/{file.name.rpartition('.')[0]}", file.read_text(encoding="utf-8")
