"""Schema of the Task documents for one robot: XSD 1.0, generated from its capabilities.

Documents with an action, quantity, level word or parameter that the robot lacks, a wrong unit, or a parameter out of
bounds are invalid. In XSD 1.0 one attribute cannot depend on another, so each action and each quantity is an element of
its own with its own attributes. Everything else is derived from :mod:`.codec_shapes`, so schema and codec cannot
diverge. Rules that no schema can express (a reading is taken before it is tested) are in :mod:`.references`.
"""

from __future__ import annotations

import re
import threading
from functools import lru_cache
from typing import TYPE_CHECKING

from fieldhand.errors import TaskError, few
from fieldhand.task.capabilities import Capabilities
from fieldhand.task.codec_shapes import Attribute, Shape, element_name
from fieldhand.task.codec_xml import parse_xml
from fieldhand.task.schema_build import SchemaBuilder
from fieldhand.task.schema_messages import SchemaProblem, Vocabulary, explain

if TYPE_CHECKING:
    from lxml.etree import XMLSchema

__all__ = ["SchemaProblem", "require_valid", "schema_xsd", "validate", "vocabulary"]

#: A compiled schema stores its last error log, so only one thread may use it at a time.
_ALONE = threading.Lock()


def schema_xsd(capabilities: Capabilities, *, draft: bool = False) -> bytes:
    """Return the schema of the Task documents that a robot can execute, as a UTF-8 XSD 1.0 document.

    Args:
        capabilities: Capabilities of the robot.
        draft: Give the form that a language model writes, which may omit whatever ``task.build.make_task`` derives
            (ids, request, goals, state, resources).
    """
    from lxml import etree

    return etree.tostring(
        SchemaBuilder(capabilities=capabilities, draft=draft).root(),
        xml_declaration=True,
        encoding="UTF-8",
        pretty_print=True,
    )


def validate(document: bytes, capabilities: Capabilities, *, draft: bool = False) -> tuple[SchemaProblem, ...]:
    """Return the schema violations of a document in the order of its lines; empty if it is valid.

    A document that is not well-formed, or is refused before parsing (entities, size), has that one problem.
    """
    try:
        root = parse_xml(document)
    except TaskError as error:
        line = re.search(r"line (\d+)", error.where)
        message = f"{error.what}; {error.advice}" if error.advice else error.what
        return (SchemaProblem(line=int(line[1]) if line else 1, element="", message=message),)
    with _ALONE:
        schema = _compiled(_Key(capabilities), draft)
        if schema.validate(root):
            return ()
        log = schema.error_log
    return explain(root, log, vocabulary(capabilities, draft=draft))


class _Key:
    """Capabilities as a cache key: by value, and by order, which is the order of the schema."""

    def __init__(self, capabilities: Capabilities) -> None:
        self.capabilities = capabilities
        actions = [(name, a.measures, tuple(a.parameters.items())) for name, a in capabilities.actions.items()]
        self._value = (tuple(actions), tuple(capabilities.quantities.items()), tuple(capabilities.events.items()))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Key) and self._value == other._value

    def __hash__(self) -> int:
        return hash(self._value)


@lru_cache(maxsize=8)
def _compiled(key: _Key, draft: bool) -> XMLSchema:
    from lxml import etree

    return etree.XMLSchema(SchemaBuilder(capabilities=key.capabilities, draft=draft).root())


def require_valid(document: bytes, capabilities: Capabilities, *, source: str = "", draft: bool = False) -> None:
    """Raise one error with the schema violations of a document; return if it is valid.

    Args:
        document: Bytes of a Task document.
        capabilities: Capabilities of the robot.
        source: Name of the document in the message.
        draft: The document is a draft.

    Raises:
        TaskError: Invalid; the message has the first three problems with line and element, and the number of others.
    """
    problems = validate(document, capabilities, draft=draft)
    if problems:
        text = few([str(problem) for problem in problems], 3, "; ")
        advice = "correct the document, or plan the request again for this robot"
        raise TaskError(f"is not valid for this robot: {text}", where=source, advice=advice)


def vocabulary(capabilities: Capabilities, *, draft: bool = False) -> Vocabulary:
    """Return the elements and attributes allowed in each element, for messages."""
    schema = SchemaBuilder(capabilities=capabilities, draft=draft)
    made = Vocabulary()
    for shape in schema.shapes:
        inside = made.children.setdefault(shape.element, [])
        made.attributes["", shape.element] = [name for a in schema.attributes(shape) for name in _names(a)]
        made.kinds.update({(shape.element, a.name): a.kind for a in schema.attributes(shape) if a.kind != "value"})
        for head in schema.heads(shape):
            inside.append(head)
            made.attributes[shape.element, head] = _head_attributes(shape, head, capabilities)
        for child in shape.children:
            options = [element_name(o) for o in schema.usable(child.options)]
            if child.kind == "texts":
                options = [child.name.removesuffix("s")]
            if child.direct:
                inside.extend(options)
                continue
            inside.append(child.name)
            if schema.required(shape.cls, child.field, child.default):
                made.required.setdefault(shape.element, []).append(child.name)
            if child.kind != "inline":
                known = made.children.setdefault(child.name, [])
                known.extend(o for o in options if o not in known)
    return made


def _head_attributes(shape: Shape, head: str, capabilities: Capabilities) -> list[str]:
    """Return the attributes of the element of an action, a quantity or an event."""
    if shape.head is None or shape.head.of in ("action", "implement"):
        return list(capabilities.actions[head].parameters)
    return [a.name for a in shape.head.attributes]


def _names(attribute: Attribute) -> tuple[str, ...]:
    return (attribute.name, f"{attribute.name}-as") if attribute.kind == "value" else (attribute.name,)
