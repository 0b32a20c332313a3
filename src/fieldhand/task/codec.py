"""Encode a Task as an XML document and decode it.

``decode(encode(task)) == task`` for every Task whose text XML can represent. :mod:`fieldhand.task.codec_shapes` derives
the form of each class; this module walks over it. Equal Tasks give identical UTF-8 documents.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import MISSING, dataclass
from typing import TYPE_CHECKING, Any

from fieldhand.errors import TaskError
from fieldhand.task.capabilities import RESERVED_ACTIONS
from fieldhand.task.codec_read import Reader
from fieldhand.task.codec_shapes import NAMESPACE, SURROGATES, Attribute, Child, NamedElement, element_name, shape_of
from fieldhand.task.codec_text import SEVERAL_LINES, attribute_text, bare_value, hidden_character, number_text
from fieldhand.task.codec_xml import MAX_BYTES, MAX_DEPTH, local_name, parse_xml
from fieldhand.task.frames import Constraints, FaultedExit, Task, Then
from fieldhand.task.plan import Node, Span
from fieldhand.task.timing import Timing
from fieldhand.task.watches import Watch

if TYPE_CHECKING:
    from lxml.etree import _Element


@dataclass(frozen=True, kw_only=True)
class TaskDraft:
    """Contents of a draft document, to be completed by ``task.build.make_task``. Omitted ids are empty.

    Attributes:
        request: Empty if omitted.
        faulted: Empty if the draft lists no exits for faults.
    """

    plan: Node
    constraints: Constraints
    nominal: Then
    faulted: tuple[FaultedExit, ...]
    assumptions: tuple[str, ...]
    request: str
    nominal_said: tuple[Span, ...] = ()
    no_part: tuple[Span, ...] = ()
    warnings: tuple[str, ...] = ()
    timing: Timing | None = None
    watches: tuple[Watch, ...] = ()


def encode(task: Task) -> bytes:
    """Return a Task as an indented UTF-8 XML document ending with a newline.

    Raises:
        TaskError: Hidden characters, a number that XML cannot represent, nesting too deep, or a document too large.
    """
    from lxml import etree

    root = etree.Element(f"{{{NAMESPACE}}}task", nsmap={None: NAMESPACE})  # type: ignore[dict-item]  # stubs forget None
    _fill(root, task, depth=1)
    etree.indent(root)
    data: bytes = etree.tostring(root, xml_declaration=True, encoding="UTF-8") + b"\n"
    if len(data) > MAX_BYTES:
        raise TaskError(f"the Task has {len(data)} bytes as XML, more than {MAX_BYTES}", advice="split the mission")
    return data


def decode(data: bytes, *, source: str = "") -> Task:
    """Return the Task in a document. The schema, not this function, checks that a robot can do it.

    Args:
        data: The document.
        source: Name of the document in messages, such as its file name.

    Raises:
        TaskError: Not a Task document; the message gives line and element.
    """
    return Reader(source=source).task(parse_xml(data, source=source))


def decode_draft(data: bytes, *, source: str = "") -> TaskDraft:
    """Return the contents of a draft, which may omit what can be derived: ids, request, goals, state, resources.

    Raises:
        TaskError: Not a draft of a Task; the message gives line and element.
    """
    task = Reader(source=source, draft=True).task(parse_xml(data, source=source))
    return TaskDraft(
        plan=task.composition.plan,
        constraints=task.constraints,
        nominal=task.composition.nominal,
        faulted=task.composition.faulted,
        assumptions=task.command.assumptions,
        request=task.command.request,
        nominal_said=task.composition.nominal_said,
        no_part=task.command.no_part,
        warnings=task.command.warnings,
        timing=task.timing,
        watches=task.composition.watches,
    )


def encode_parts(parts: Iterable[Any]) -> str:
    """Return parts of a Task (selectors, conditions, frames) one after the other as single-line XML without namespace.

    Other formats embed this text, for instance in an attribute of a BehaviorTree.CPP tree.

    Raises:
        TaskError: As for :func:`encode`.
    """
    from lxml import etree

    documents = []
    for part in parts:
        root = etree.Element(f"{{{NAMESPACE}}}{element_name(type(part))}", nsmap={None: NAMESPACE})  # type: ignore[dict-item]  # stubs forget None
        _fill(root, part, depth=2)
        documents.append(etree.tostring(root, encoding="unicode").replace(f' xmlns="{NAMESPACE}"', "", 1))
    return "".join(documents)


def decode_parts(text: str, options: tuple[type, ...], *, source: str = "") -> tuple[Any, ...]:
    """Return the parts written by :func:`encode_parts`, each an instance of one of ``options``.

    Raises:
        TaskError: Anything else; the message names ``source``.
    """
    root = parse_xml(f'<parts xmlns="{NAMESPACE}">{text}</parts>'.encode(), source=source)
    reader = Reader(source=source)
    reader.require_visible(root)
    many = Child(field="parts", name="parts", kind="many", options=options, default=())
    found: tuple[Any, ...] = reader.parts(root, Task, many)["parts"]
    return found


def _fill(element: _Element, value: Any, *, depth: int) -> None:
    """Write the fields of a value into its element."""
    if depth > MAX_DEPTH:
        raise TaskError(f"the plan nests more than {MAX_DEPTH} elements", advice="nest less deeply")
    cls: type = type(value)
    if cls in SURROGATES:
        value = SURROGATES[cls][1](value)
    shape = shape_of(cls)
    for attribute in shape.attributes:
        _set(element, attribute, getattr(value, attribute.field))
    if shape.head:
        _fill_head(element, shape.head, value)
    for child in shape.children:
        content = getattr(value, child.field)
        if content is None or (child.default is not MISSING and content == child.default):
            continue
        inside = element if child.direct else _sub(element, child.name)
        match child.kind:
            case "text":
                inside.text = _text(content, child.name)
            case "texts":
                for text in content:
                    _sub(inside, child.name.removesuffix("s")).text = _text(text, child.name)
            case "inline":
                _fill(inside, content, depth=depth + 1)
            case "one" | "many":
                below = depth + (1 if child.direct else 2)
                for part in content if child.kind == "many" else (content,):
                    _fill(_sub(inside, element_name(type(part))), part, depth=below)


def _fill_head(element: _Element, head: NamedElement, value: Any) -> None:
    """Write what belongs to an action or a quantity into an element of its name."""
    name = getattr(value, head.field)
    if head.optional and not name:
        return
    if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_.-]*", name) or name in RESERVED_ACTIONS:
        raise TaskError(f"{name!r} cannot be the name of a robot's {head.of}", where=f"<{local_name(element)}>")
    inside = _sub(element, name)
    for attribute in head.attributes:
        _set(inside, attribute, getattr(value, attribute.field))
    for key, content in value.parameters if head.of in ("action", "implement") else ():
        where = f"<{name}>, parameter {key!r}"
        if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_.-]*", key) or key in inside.attrib:
            raise TaskError("is not a name, or is given twice", where=where)
        if isinstance(content, str):
            if not isinstance(bare_value(content), str):
                raise TaskError(f"the word {content!r} would be read as a number or true/false", where=where)
            inside.set(key, _text(content, key))
        else:
            inside.set(key, number_text(content))


def _set(element: _Element, attribute: Attribute, value: Any) -> None:
    """Write a field as an attribute, unless it is the default."""
    if value is None or (attribute.default is not MISSING and value == attribute.default):
        return
    try:
        for name, text in attribute_text(attribute, value).items():
            element.set(name, _text(text, attribute.name))
    except ValueError as error:
        raise TaskError(str(error), where=f"<{local_name(element)}>, {attribute.name}") from None


def _sub(element: _Element, name: str) -> _Element:
    from lxml import etree

    return etree.SubElement(element, f"{{{NAMESPACE}}}{name}")


def _text(text: str, name: str) -> str:
    character = hidden_character(text, lines=name in SEVERAL_LINES)
    if character:
        raise TaskError(f"{name} contains the invisible character {character}", advice="remove it")
    return text
