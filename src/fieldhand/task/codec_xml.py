"""Parse XML from untrusted sources: no document type, no entities, no network, bounded size and depth."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fieldhand.errors import TaskError
from fieldhand.files import FileFault, read_file
from fieldhand.language import message, recalled
from fieldhand.task.codec_text import hidden_character

if TYPE_CHECKING:
    from lxml.etree import _Element

#: Maximum size in bytes. A Task of a hundred thousand words is far smaller.
MAX_BYTES = 4_000_000
#: Maximum nesting of elements. A nested if takes three levels, so about sixty ifs nest.
MAX_DEPTH = 200


_GIVE_XML = message("give an XML file")


def read_xml(path: Path, *, advice: str = _GIVE_XML) -> bytes:
    """Return the bytes of a document, reading no more than the size limit.

    Raises:
        TaskError: The file cannot be read, or is too large.
    """
    try:
        return read_file(path, MAX_BYTES)
    except FileFault as fault:
        advice = message("split the mission") if fault.kind == "too large" else advice
        raise TaskError(recalled(fault.what, "file"), where=str(path), advice=advice) from None


def parse_xml(data: bytes, *, source: str = "") -> _Element:
    """Return the root element of a document, without comments and processing instructions.

    Raises:
        TaskError: The document is empty, too large, nested too deep, not UTF-8, not well-formed, or has a document type
            or entities; the message gives the line.
    """
    from lxml import etree

    if not data.strip():
        raise TaskError("the document is empty", where=source, advice="give a Task document, written by fieldhand plan")
    if len(data) > MAX_BYTES:
        raise TaskError(
            f"the document has {len(data)} bytes, more than {MAX_BYTES}", where=source, advice="split the mission"
        )
    data = _without_doctype(data, source)
    parser = etree.XMLParser(
        encoding="utf-8",
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        dtd_validation=False,
        huge_tree=False,
        remove_comments=True,
        remove_pis=True,
    )
    try:
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        what = re.sub(r",? ?(line \d+, column \d+)?( \(.*\))?$", "", error.msg or "the document ends too early")
        raise TaskError(
            f"is not well-formed XML: {' '.join(what.split())}",
            where=at_line(source, error.lineno or 1),
            advice="correct the XML there",
        ) from None
    _check_depth(root, source)
    return root


def require_visible(root: _Element, *, source: str = "", lines: Callable[[str], bool] = lambda _: True) -> None:
    """Refuse invisible characters anywhere in a document: a signed document must contain exactly what was read back.

    Args:
        root: Outermost element.
        source: Name of the document in messages.
        lines: Returns True for an element name, or ``@name`` of an attribute, whose text may have several lines.

    Raises:
        TaskError: An invisible character; the message gives line, element and part of the element.
    """
    for element in root.iter():
        name = local_name(element)
        texts = [(f"attribute {key!s}", str(text), lines(f"@{key!s}")) for key, text in element.attrib.items()]
        texts += [("name", str(element.tag), False), ("tail", (element.tail or "").strip(" \n\t"), False)]
        texts.append(("text", (element.text or "").strip(" \n\t"), lines(name)))
        for what, text, several in texts:
            character = hidden_character(text, lines=several)
            if character:
                raise TaskError(
                    f"its {what} contains the invisible character {character}",
                    where=at_line(source, line_of(element), name),
                    advice="remove it",
                )


def at_line(source: str, line: int, element: str = "") -> str:
    """Return a location in a document for error messages: ``task.xml, line 12, <act>``."""
    return ", ".join(part for part in (source, f"line {line}", f"<{element}>" if element else "") if part)


def local_name(element: _Element) -> str:
    """Return the name of an element without its namespace."""
    return str(element.tag).rpartition("}")[2]


def line_of(element: _Element) -> int:
    """Return the line on which an element begins, counted from 1."""
    line: Any = element.sourceline  # the stubs declare a wider type
    return int(line or 1)


def _without_doctype(data: bytes, source: str) -> bytes:
    """Return the data as UTF-8 without byte order mark; raise if it has a document type.

    The parser would not load external entities, but it does expand internal ones in attribute values, so a document
    type is refused before parsing. The data is decoded first, so that it cannot hide in another encoding.
    """
    try:
        data = data.decode("utf-8-sig").encode()
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise TaskError("is not UTF-8 text", where=at_line(source, line), advice="save it as UTF-8") from None
    found = re.search(rb"<!(DOCTYPE|ENTITY)", data)
    if found:
        line = data[: found.start()].count(b"\n") + 1
        raise TaskError(
            f"holds <!{found.group(1).decode()}: a Task must not declare a document type or entities",
            where=at_line(source, line),
            advice="remove it",
        )
    return data


def _check_depth(root: _Element, source: str) -> None:
    """Refuse nesting too deep for the recursive readers that follow."""
    from lxml import etree

    depth = 0
    for event, element in etree.iterwalk(root, events=("start", "end")):
        depth += 1 if event == "start" else -1
        if depth > MAX_DEPTH:
            where = at_line(source, line_of(element))
            raise TaskError(f"more than {MAX_DEPTH} elements are nested", where=where, advice="nest less deeply")
