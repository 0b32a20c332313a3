"""Read the elements of a Task document into dataclasses; errors give the line."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from dataclasses import MISSING, dataclass
from typing import TYPE_CHECKING, Any

from fieldhand.errors import TaskError
from fieldhand.task.codec_shapes import (
    DRAFT_DEFAULTS,
    FAMILIES,
    NAMESPACE,
    SURROGATES,
    Attribute,
    Child,
    NamedElement,
    element_name,
    shape_of,
)
from fieldhand.task.codec_text import SEVERAL_LINES, bare_value, parse_value
from fieldhand.task.codec_xml import at_line, line_of, local_name, require_visible
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from lxml.etree import _Element

XSI = "{http://www.w3.org/2001/XMLSchema-instance}"


@dataclass(frozen=True, kw_only=True)
class Reader:
    """Reads elements into dataclasses.

    Attributes:
        source: Name of the document in messages.
        draft: Accept omission of whatever can be derived.
    """

    source: str
    draft: bool = False

    def task(self, root: _Element) -> Task:
        """Return the Task in a root element."""
        self.require_visible(root)
        if root.tag == "task":
            raise self.error(root, "the namespace is missing", f'write <task xmlns="{NAMESPACE}">')
        if root.tag != f"{{{NAMESPACE}}}task":
            raise self.error(root, "is not a Task document", f'the outermost element is <task xmlns="{NAMESPACE}">')
        task: Task = self.value(root, Task)
        return task

    def require_visible(self, root: _Element) -> None:
        """Refuse invisible characters; drafts are exempt, since nobody signs them."""
        if not self.draft:
            require_visible(root, source=self.source, lines=SEVERAL_LINES.__contains__)

    def value(self, element: _Element, cls: type) -> Any:
        """Return the dataclass in an element."""
        shape = shape_of(cls)
        self.no_text(element)
        found = self.attributes(element, shape.attributes)
        children = list(element)
        for child in children:
            self.name(child)
        if shape.head:
            beside = {c.name for c in shape.children}
            heads = [c for c in children if local_name(c) not in beside]
            children = [c for c in children if local_name(c) in beside]
            found |= self.head(element, heads, shape.head)
        if len(shape.children) == 1 and shape.children[0].direct:
            found |= self.parts(element, shape.cls, shape.children[0])
        else:
            found |= self.fields(element, shape.cls, shape.children, children)
        made = shape.cls(**found)
        return SURROGATES[cls][2](made) if cls in SURROGATES else made

    def fields(
        self, element: _Element, cls: type, expected: tuple[Child, ...], children: list[_Element]
    ) -> dict[str, Any]:
        """Return the fields that have a child element of their own name."""
        by_name = {c.name: c for c in expected}
        found: dict[str, Any] = {}
        for inside in children:
            child = by_name.get(local_name(inside))
            if child is None:
                raise self.unknown(inside, by_name)
            if child.field in found:
                raise self.error(inside, "is given twice here", "keep one")
            match child.kind:
                case "text":
                    found[child.field] = self.text(inside)
                case "texts":
                    found[child.field] = tuple(self.items(inside, child.name.removesuffix("s")))
                case "inline":
                    found[child.field] = self.value(inside, child.options[0])
                case "one" | "many":
                    self.no_text(inside)
                    self.attributes(inside, ())
                    found |= self.parts(inside, cls, child)
        for child in expected:
            if child.field not in found:
                found[child.field] = self.default(element, cls, child.field, child.default, f"<{child.name}>")
        return found

    def parts(self, element: _Element, cls: type, child: Child) -> dict[str, Any]:
        """Return the field whose values are direct children of the element."""
        options = {element_name(option): option for option in child.options}
        values = []
        for inside in element:
            option = options.get(self.name(inside))
            if option is None:
                raise self.unknown(inside, options)
            values.append(self.value(inside, option))
        if child.kind == "many":
            return {child.field: tuple(values)}
        if len(values) > 1:
            raise self.error(element[1], f"is one too many: <{local_name(element)}> can contain only one", "remove one")
        if not values:
            what = f"a {_family(child)} inside"
            return {child.field: self.default(element, cls, child.field, child.default, what)}
        return {child.field: values[0]}

    def head(self, element: _Element, heads: list[_Element], head: NamedElement) -> dict[str, Any]:
        """Return the fields in the child element named after an action or a quantity."""
        if head.optional and not heads:
            return {}
        if len(heads) != 1:
            what = f"has {len(heads)} elements that name the {head.of}, it needs one"
            raise self.error(element, what, f"write for instance <{head.of}_name .../> inside <{local_name(element)}>")
        inside = heads[0]
        self.no_text(inside)
        if len(inside):
            raise self.error(inside[0], f"is not allowed inside <{local_name(inside)}>", "move it out")
        found: dict[str, Any] = {head.field: local_name(inside)}
        if head.of not in ("action", "implement"):
            return found | self.attributes(inside, head.attributes)
        parameters = [(str(key), bare_value(str(text))) for key, text in inside.attrib.items()]
        for key, content in parameters:
            if isinstance(content, bool) or key.startswith("{"):
                raise self.error(inside, f"the parameter {key} is neither a number nor a word", "correct it")
        return found | {"parameters": tuple(parameters)}

    def attributes(self, element: _Element, expected: Iterable[Attribute]) -> dict[str, Any]:
        """Return the fields written as attributes of an element."""
        left = {str(k): str(v) for k, v in element.attrib.items() if not str(k).startswith(XSI)}
        names = [a.name for a in expected]
        found: dict[str, Any] = {}
        for attribute in expected:
            text = left.pop(attribute.name, None)
            marked = left.pop(f"{attribute.name}-as", None) if attribute.kind == "value" else None
            if text is None:
                what = f"the attribute {attribute.name}"
                found[attribute.field] = self.default(element, type(None), attribute.field, attribute.default, what)
                continue
            try:
                found[attribute.field] = parse_value(attribute, text, marked)
            except ValueError as error:
                raise self.error(element, f"{attribute.name}: {error}", "correct it") from None
        for name in left:
            raise self.error(element, f"has no attribute {name!r}", _nearest(name, names))
        return found

    def default(self, element: _Element, cls: type, field: str, default: Any, what: str) -> Any:
        """Return the default of an omitted field, or raise if it is required."""
        if default is not MISSING:
            return default
        for key in (field, (cls, field)) if self.draft else ():
            if key in DRAFT_DEFAULTS:
                return DRAFT_DEFAULTS[key]
        raise self.error(element, f"{what} is missing", "add it")

    def items(self, element: _Element, name: str) -> Iterable[str]:
        """Return the texts of a list."""
        self.no_text(element)
        self.attributes(element, ())
        for item in element:
            if self.name(item) != name:
                raise self.unknown(item, {name: None})
            yield self.text(item)

    def text(self, element: _Element) -> str:
        """Return the text of an element without children."""
        self.attributes(element, ())
        if len(element):
            raise self.error(element[0], f"is not allowed inside <{local_name(element)}>", "write < as &lt; in text")
        return element.text or ""

    def no_text(self, element: _Element) -> None:
        """Refuse text between child elements, which would otherwise be dropped silently."""
        for text in (element.text, *(child.tail for child in element)):
            if text and text.strip():
                shown = " ".join(text.split())[:40]
                raise self.error(element, f"contains the text {shown!r} between its elements", "remove it")

    def name(self, element: _Element) -> str:
        """Return the local name of an element in the Task namespace."""
        if not isinstance(element.tag, str) or not element.tag.startswith(f"{{{NAMESPACE}}}"):
            raise self.error(element, "is not in the namespace of Task documents", f"use {NAMESPACE}")
        return local_name(element)

    def unknown(self, element: _Element, known: Mapping[str, Any]) -> TaskError:
        """Return the error for an element that is not allowed where it is."""
        return self.error(element, "is unknown here", _nearest(local_name(element), list(known)))

    def error(self, element: _Element, what: str, advice: str) -> TaskError:
        """Return an error located at an element."""
        return TaskError(what, where=at_line(self.source, line_of(element), local_name(element)), advice=advice)


def _family(child: Child) -> str:
    return FAMILIES.get(child.options, child.name)


def _nearest(name: str, known: list[str]) -> str:
    near = difflib.get_close_matches(name, known, n=1)
    if near:
        return f"did you mean {near[0]!r}?"
    return f"known here: {', '.join(known)}" if known else "remove it"
