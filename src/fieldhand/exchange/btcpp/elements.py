"""Elements of a tree document: type, ports and position, in either notation that editors write."""

from __future__ import annotations

import difflib
from collections.abc import Collection
from dataclasses import MISSING, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from fieldhand.errors import TaskError
from fieldhand.exchange.btcpp.vocabulary import leaves, plain_attributes, port_name
from fieldhand.task.capabilities import Capabilities
from fieldhand.task.codec import decode_parts
from fieldhand.task.codec_shapes import Attribute
from fieldhand.task.codec_text import parse_value
from fieldhand.task.codec_xml import at_line, line_of
from fieldhand.task.plan import Span

if TYPE_CHECKING:
    from lxml.etree import _Element

#: ``<Action ID="read_co2"/>`` is ``<read_co2/>``.
_GENERIC = ("Action", "Condition", "Control", "Decorator")
#: Ports that BehaviorTree.CPP treats as scripts around a node.
_SCRIPTS = ("_skipIf", "_successIf", "_failureIf", "_while", "_onSuccess", "_onFailure", "_onHalted", "_post")
#: Nodes of BehaviorTree.CPP that have an equivalent in a Task.
STANDARD = (
    "Sequence", "Fallback", "IfThenElse", "Repeat", "Inverter", "ForceSuccess", "LoopString", "LoopInt", "Script",
    "AlwaysSuccess", "AlwaysFailure", "SubTree",
)  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Tag:
    """An XML element as a node of a tree.

    Attributes:
        kind: Type of the node.
        ports: Ports as written.
    """

    element: _Element
    kind: str
    ports: dict[str, str]

    @property
    def line(self) -> int:
        """Return the position in the document."""
        return line_of(self.element)

    @property
    def name(self) -> str:
        """Return the node's own name, or an empty string."""
        given = str(self.element.get("name") or "")
        return "" if given == self.kind else given


@dataclass(frozen=True, kw_only=True)
class Elements:
    """Reader of the elements of one document for one robot.

    Attributes:
        source: Name of the document in error messages.
    """

    source: str
    capabilities: Capabilities

    @cached_property
    def known(self) -> dict[str, frozenset[str]]:
        """Return the leaves accepted in a tree, with the names of their ports."""
        return {leaf.id: frozenset(port.name for port in leaf.ports) for leaf in leaves(self.capabilities)}

    def tag(self, element: _Element) -> Tag:
        """Return an element as a node.

        Raises:
            TaskError: The node type is unknown; the message gives line, name and the nearest known type.
        """
        kind = str(element.tag)
        if kind in _GENERIC:
            kind = str(element.get("ID") or "")
        if kind not in self.known and kind not in STANDARD:
            near = difflib.get_close_matches(kind, [*self.known, *STANDARD], n=1)
            advice = f"did you mean {near[0]}?" if near else f"known leaves: {', '.join(self.known)}"
            raise self.error(element, f"the node {kind!r} is unknown for this robot", advice)
        ports = {str(k): str(v) for k, v in element.attrib.items() if not str(k).startswith("_")}
        ports.pop("name", None)
        if str(element.tag) in _GENERIC:
            ports.pop("ID", None)
        return Tag(element=element, kind=kind, ports=ports)

    def ports(self, tag: Tag, known: Collection[str], *, scripts: Collection[str] = ()) -> None:
        """Refuse ports and scripts that have no equivalent in a Task.

        Args:
            known: Accepted ports.
            scripts: Scripts that the notation of a Task uses around this node.
        """
        for name in tag.ports:
            if name not in known:
                raise self.error(tag.element, f"the port {name!r} is unknown", f"known: {', '.join(known) or 'none'}")
        for name in _SCRIPTS:
            if name in tag.element.attrib and f"{name}={tag.element.get(name)}" not in scripts:
                raise self.error(
                    tag.element, f"a Task cannot express the script {name}", "express it with nodes, or remove it"
                )

    def children(self, tag: Tag, count: int) -> list[_Element]:
        """Return the child nodes after checking their number."""
        found = list(tag.element)
        if len(found) != count:
            raise self.error(tag.element, f"contains {len(found)} nodes, needs {count}", "correct it")
        return found

    def fields(self, tag: Tag, cls: type, *, beside: Collection[str] = ()) -> dict[str, Any]:
        """Return the plain fields of a class from the ports of a node, with defaults for missing ports."""
        found: dict[str, Any] = {}
        for attribute in plain_attributes(cls):
            if attribute.field not in beside:
                found[attribute.field] = self._field(tag, attribute)
        return found

    def parts(self, tag: Tag, port: str, options: tuple[type, ...]) -> Any:
        """Return the single part, such as a selector, that a port contains as XML."""
        where = f"{at_line(self.source, tag.line, tag.kind)}, {port}"
        text = tag.ports.get(port, "")
        if not text.lstrip().startswith("<"):
            raise TaskError(f"{text!r} is not a selector", where=where, advice="write for instance <trees/>, as XML")
        found = decode_parts(text, options, source=where)
        if len(found) != 1:
            raise TaskError(f"contains {len(found)} selectors", where=where, advice="write one")
        return found[0]

    def spans(self, tag: Tag, name: str) -> tuple[Span, ...]:
        """Return the ranges of the request in an attribute, or none if an editor removed it."""
        text = tag.element.get(name)
        try:
            attribute = Attribute(field=name, name=name, kind="spans", default=())
            return () if text is None else tuple(parse_value(attribute, text))
        except ValueError as error:
            raise self.error(tag.element, f"{name}: {error}", "correct it, or take it out") from None

    def error(self, element: _Element, what: str, advice: str) -> TaskError:
        """Return an error located at an element."""
        kind = str(element.get("ID") or element.tag) if element.tag in _GENERIC else str(element.tag)
        return TaskError(what, where=at_line(self.source, line_of(element), kind), advice=advice)

    def _field(self, tag: Tag, attribute: Attribute) -> Any:
        name = port_name(attribute.name)
        text = tag.ports.get(name)
        if text is None or (text == "" and attribute.default is not MISSING):
            if attribute.default is MISSING:
                raise self.error(tag.element, f"the port {name!r} is missing", "add it")
            return attribute.default
        marked = tag.ports.get(port_name(f"{attribute.name}-as")) or None
        try:
            return parse_value(attribute, text, marked if attribute.kind == "value" else None)
        except ValueError as error:
            raise self.error(tag.element, f"{name}: {error}", "correct it") from None
