"""Turn the log of a schema validator into messages for the person or language model that corrects the document."""

from __future__ import annotations

import difflib
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from fieldhand.errors import few
from fieldhand.task.codec_shapes import NAMESPACE, AttributeKind
from fieldhand.task.codec_xml import local_name

if TYPE_CHECKING:
    from lxml.etree import _Element

#: Maximum number of problems reported.
MOST = 50


@dataclass(frozen=True, kw_only=True)
class SchemaProblem:
    """One violation of the schema.

    Attributes:
        line: Line number, from 1.
        element: Name of the element; empty if the document could not be parsed.
        message: What is wrong and what would be right, on one line.
    """

    line: int
    element: str
    message: str

    def __str__(self) -> str:
        at = f"line {self.line}, <{self.element}>" if self.element else f"line {self.line}"
        return f"{at}: {self.message}"


@dataclass(frozen=True, kw_only=True)
class Vocabulary:
    """Elements and attributes allowed in each element.

    Attributes:
        children: Names of the child elements allowed in an element.
        required: Names of those required.
        attributes: Names of the attributes, by (parent, element) where the parent decides, else by ("", element).
        kinds: Kind of an attribute's value, by (element, attribute); those not listed are numbers.
    """

    children: dict[str, list[str]] = field(default_factory=dict)
    required: dict[str, list[str]] = field(default_factory=dict)
    attributes: dict[tuple[str, str], list[str]] = field(default_factory=dict)
    kinds: dict[tuple[str, str], AttributeKind] = field(default_factory=dict)

    def attributes_of(self, parent: str, element: str) -> list[str]:
        """Return the attributes allowed on an element."""
        return self.attributes.get((parent, element), self.attributes.get(("", element), []))


def explain(root: _Element, log: Any, vocabulary: Vocabulary) -> tuple[SchemaProblem, ...]:
    """Return the entries of a validator's log as problems, one per cause, sorted by line."""
    entries = [e for e in log if "Not all fields of key" not in e.message]  # reported already as a missing attribute
    # Nodes inside invalid content are not recognised, so broken references mean something only if all else is valid.
    entries = [e for e in entries if "No match found" not in e.message] or entries
    found: dict[tuple[int, str, str], SchemaProblem] = {}
    for entry in entries:
        element = _element_at(root, entry.path)
        named = re.match(r"Element '(?:\{[^}]*\})?([^']*)'", entry.message)
        name = local_name(element) if element is not None else named[1] if named else ""
        parent = element.getparent() if element is not None else None
        present = () if element is None else tuple(local_name(child) for child in element)
        message = _message(entry.message, name, "" if parent is None else local_name(parent), vocabulary, present)
        attribute = re.search(r"attribute '([^']*)'", entry.message)
        # A value that breaks a facet is reported twice: for the facet, then for the type.
        key = (entry.line, name, attribute[1] if attribute else message)
        found.setdefault(key, SchemaProblem(line=entry.line, element=name, message=message))
    problems = sorted(found.values(), key=lambda p: p.line)
    return tuple(problems[:MOST])


def _element_at(root: _Element, path: str | None) -> _Element | None:
    """Return the element that a log entry refers to."""
    if not path:
        return None
    prefixes = {str(k): str(v) for k, v in root.nsmap.items() if k}
    try:
        found: Any = root.getroottree().xpath(path, namespaces=prefixes)
    except Exception:  # noqa: BLE001  a prefix declared further in: the message then omits the element
        return None
    return found[0] if found else None


def _message(raw: str, name: str, parent: str, vocabulary: Vocabulary, present: tuple[str, ...]) -> str:
    """Return a log message in words; a message of unknown kind is returned without its namespaces."""
    attribute = re.search(r"attribute '([^']*)'", raw)
    if "No matching global declaration" in raw:
        return f'is not a Task document: the outermost element is <task xmlns="{NAMESPACE}">'
    if "This element is not expected" in raw:
        return _not_expected(raw, name, parent, vocabulary)
    if "Missing child element" in raw:
        required = [r for r in vocabulary.required.get(name, []) if r not in present]
        return f"lacks {few([f'<{r}>' for r in required])}" if required else _lacks_one(name, vocabulary)
    if "is not allowed" in raw and attribute:
        known = vocabulary.attributes_of(parent, name)
        return f"has no attribute {attribute[1]!r}{_instead(attribute[1], known)}"
    if "is required but missing" in raw and attribute:
        return f"the attribute {attribute[1]!r} is missing"
    if attribute and ("[facet '" in raw or "is not a valid value" in raw):
        return _bad_value(raw, attribute[1], vocabulary.kinds.get((name, attribute[1]), "number"))
    if match := re.search(r"Duplicate key-sequence \['(.*)'\]", raw):
        return f"the id {match[1]!r} is used twice; ids are unique"
    if match := re.search(r"No match found for key-sequence \['(.*)'\]", raw):
        return f"names the node {match[1]!r}, which the plan does not have"
    if "haracter content" in raw:
        return "contains text between its elements; remove it"
    return re.sub(r"\{[^}]*\}", "", raw)


_KINDS: dict[AttributeKind, str] = {
    "number": "is not a number",
    "integer": "is not a whole number",
    "flag": "is neither true nor false",
    "spans": "is not a list of character ranges such as 0-12 20-31",
}
_BOUNDS = {"minInclusive": "at least", "minExclusive": "above", "maxInclusive": "at most", "maxExclusive": "below"}


def _bad_value(raw: str, attribute: str, kind: AttributeKind) -> str:
    """Return the message for an invalid attribute value."""
    value = re.search(r"The value '(.*?)' (?:is|has|does|must)|: '(.*?)' is not a valid", raw, re.DOTALL)
    given = (value[1] if value[1] is not None else value[2]) if value else ""
    shown = f'{attribute}="{given}"'
    facet = re.search(r"\[facet '(\w+)'\]", raw)
    match facet[1] if facet else "":
        case "enumeration":
            allowed = re.findall(r"'([^']*)'", raw.rpartition("{")[2])
            near = difflib.get_close_matches(given, allowed, n=1) if len(allowed) > 1 else []
            hint = f"; did you mean {near[0]!r}?" if near else ""
            return f"{shown} must be {'one of ' if len(allowed) > 1 else ''}{few(allowed)}{hint}"
        case "minLength":
            return f"the attribute {attribute!r} is empty"
        case ("minInclusive" | "minExclusive" | "maxInclusive" | "maxExclusive") as side:
            bound = re.findall(r"'([^']*)'", raw)[-1]
            return f"{shown} is out of bounds: it must be {_BOUNDS[side]} {bound}"
    return f"{shown} {_KINDS.get(kind, 'is not allowed here')}"


def _lacks_one(name: str, vocabulary: Vocabulary) -> str:
    return f"lacks an element inside; one of: {few(vocabulary.children.get(name, []))}"


def _not_expected(raw: str, name: str, parent: str, vocabulary: Vocabulary) -> str:
    """Return the message for a misplaced element: unknown there, one too many, or in the wrong order."""
    known = vocabulary.children.get(parent, [])
    if name not in known:
        return f"is not known inside <{parent}>{_instead(name, known)}"
    expected = _expected(raw)
    if expected and name not in expected:
        return f"is not allowed here; expected: {few(expected)}"
    return f"is one too many inside <{parent}>"


def _expected(raw: str) -> list[str]:
    return re.findall(r"(?:\{[^}]*\})([\w.-]+)", raw.rpartition("Expected is")[2])


def _instead(given: str, known: list[str]) -> str:
    near = difflib.get_close_matches(given, known, n=1)
    hint = f"; did you mean {near[0]!r}?" if near else ""
    return f"{hint}; known: {few(known)}" if known else "; it takes none"
