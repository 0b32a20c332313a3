"""Read XML from anyone safely: no document type, no entities, no network, bounded in size and depth."""

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

#: A Task of a hundred thousand words stays far below this.
MAX_BYTES = 4_000_000
#: Elements within elements. An if within an if takes three, so about sixty ifs nest.
MAX_DEPTH = 200


_GIVE_XML = message("give an XML file")


def read_xml(path: Path, *, advice: str = _GIVE_XML) -> bytes:
    """The bytes of a document's file; no more of it is read than one may have.

    Raises:
        TaskError: It cannot be read, or is too large.
    """
    try:
        return read_file(path, MAX_BYTES)
    except FileFault as fault:
        advice = message("split the mission") if fault.kind == "too large" else advice
        raise TaskError(recalled(fault.what, "file"), where=str(path), advice=advice) from None


def parse_xml(data: bytes, *, source: str = "") -> _Element:
    """The root element of a document, without comments and processing instructions.

    Raises:
        TaskError: It is empty, too large, nested too deep, not UTF-8, has a document type or entities of its own, or is
            not well-formed; says at which line.
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
        what = re.sub(r",? ?(line \d+, column \d+)?( \(.*\))?$", "", error.msg or "the end came too early")
        raise TaskError(
            f"is not well-formed XML: {' '.join(what.split())}",
            where=at_line(source, error.lineno or 1),
            advice="correct the XML there",
        ) from None
    _check_depth(root, source)
    return root


def require_visible(root: _Element, *, source: str = "", lines: Callable[[str], bool] = lambda _: True) -> None:
    """Refuse characters that nobody sees, wherever in a document: what is read back must be what is signed.

    Args:
        root: Its outermost element.
        source: What to call the document in messages.
        lines: Returns True for the name of an element whose text, or ``@name`` of an attribute, may have several lines.

    Raises:
        TaskError: It holds one; says at which line and element, and where in it.
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
                    f"its {what} holds the character {character}, which nobody can see",
                    where=at_line(source, line_of(element), name),
                    advice="take it out",
                )


def at_line(source: str, line: int, element: str = "") -> str:
    """A place in a document, as errors name it: ``task.xml, line 12, <act>``."""
    return ", ".join(part for part in (source, f"line {line}", f"<{element}>" if element else "") if part)


def local_name(element: _Element) -> str:
    """The name of an element without its namespace."""
    return str(element.tag).rpartition("}")[2]


def line_of(element: _Element) -> int:
    """The line on which an element begins, counted from 1."""
    line: Any = element.sourceline  # the stubs know more kinds of it than there are
    return int(line or 1)


def _without_doctype(data: bytes, source: str) -> bytes:
    """The data as UTF-8 with neither byte order mark nor document type.

    The parser would not load external entities, but it does expand internal ones in attribute values: a document
    type is refused before any parser sees it. The bytes are UTF-8 then, so it cannot hide in another encoding.
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
            f"holds <!{found.group(1).decode()}: a Task has neither a document type nor entities of its own",
            where=at_line(source, line),
            advice="take it out",
        )
    return data


def _check_depth(root: _Element, source: str) -> None:
    """Refuse what is nested too deep for the recursive readers that follow."""
    from lxml import etree

    depth = 0
    for event, element in etree.iterwalk(root, events=("start", "end")):
        depth += 1 if event == "start" else -1
        if depth > MAX_DEPTH:
            where = at_line(source, line_of(element))
            raise TaskError(f"more than {MAX_DEPTH} elements are nested", where=where, advice="nest less deeply")
