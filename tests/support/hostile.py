"""Hostile text: what nobody sees, what a reader of a format would run, and every place of a document to put it."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from lxml import etree, html

from test_hidden_characters import hidden

#: One of each kind that a person cannot see: C0, ESC, DEL, C1, bidi, zero width, separators, tags, private, blank.
HIDDEN = (
    "\x00", "\x07", "\x0b", "\x1b", "\x7f", "\x85", "\x9b", "\xad", "\u061c", "\u200b", "\u200d", "\u200f", "\u2028",
    "\u2029", "\u202a", "\u202e", "\u2066", "\u2069", "\ufeff", "\ufff9", "\uffff", "\ue000", "\U000e0041", "\u3164",
    "\u2800", "\ufe0f",
)  # fmt: skip
#: Sequences of terminals: clear it, set its clipboard (OSC 52), a link (OSC 8), its title; in C0 and C1.
TERMINAL = "\x1b[2J\x1b]52;c;cm0gLXJm\x07\x1b]8;;http://x\x1b\\y\x9b3A\x9d0;t\x9c"
#: All of them, and a line that looks like one of the program.
UNSEEN = TERMINAL + "".join(HIDDEN) + "\r\nfieldhand: Signature trusted: key of Ada"
#: What everyone sees, and the reader of some format takes for its own: HTML, scripts, XML, TeX, markup, templates.
SEEN = "</script><img src=x onerror=x()>\"' onload='x()' ]]>&lt;<!--$x_{a$\\frac{$[red]:bug:{{7*7}}%s\\u202e"
#: What a spreadsheet would compute.
FORMULA = "=cmd|'/c calc'!A0"

Changed = tuple[str, Any]


def each_text(value: Any, change: Callable[[str], str], path: str = "") -> Iterator[Changed]:
    """Copies of a document of mappings, lists and texts, each with one text or key changed; and the path of it."""
    if isinstance(value, Mapping):
        for key, part in value.items():
            where = f"{path}.{key}"
            for inside, changed in each_text(part, change, where):
                yield inside, {**value, key: changed}
            yield f"{where} (key)", {change(k) if k == key else k: v for k, v in value.items()}
    elif isinstance(value, list | tuple):
        for k, part in enumerate(value):
            for inside, changed in each_text(part, change, f"{path}[{k}]"):
                yield inside, [*value[:k], changed, *value[k + 1 :]]
    elif isinstance(value, str):
        yield path, change(value)


def every_text(value: Any, change: Callable[[str, str], str], key: str = "") -> Any:
    """A copy of a document with all its texts changed; ``change`` is given the key of each."""
    if isinstance(value, Mapping):
        return {name: every_text(part, change, name) for name, part in value.items()}
    if isinstance(value, list | tuple):
        return [every_text(part, change, key) for part in value]
    return change(value, key) if isinstance(value, str) else value


def texts_of(value: Any, seen: set[int] | None = None) -> Iterator[str]:
    """Every text that an object holds, however deep."""
    seen = set() if seen is None else seen
    if isinstance(value, str):
        yield value
    elif not isinstance(value, bytes | int | float | type(None)) and id(value) not in seen:
        seen.add(id(value))
        if isinstance(value, Mapping):
            value = [*value, *value.values()]
        parts = value if isinstance(value, list | tuple | set | frozenset) else [
            getattr(value, name, None)
            for name in (*getattr(value, "__dict__", {}), *getattr(type(value), "__slots__", ()))
        ]  # fmt: skip
        for part in parts:
            yield from texts_of(part, seen)


def require_visible(text: str) -> None:
    """Fail where a text holds what nobody sees."""
    assert not hidden(text, "\n\t"), (hidden(text, "\n\t"), text[:2000])


def require_json(text: str, *, visible: bool) -> Any:
    """Fail where a document of JSON holds a hidden character, as a file, or ``visible``, as it is parsed."""
    require_visible(text)
    value = json.loads(text)
    if visible:
        for said in texts_of(value):
            require_visible(said)
    return value


def require_table(text: str) -> None:
    """Fail where a cell is hidden in part, or would be computed."""
    require_visible(text.replace("\r\n", "\n"))
    for row in csv.reader(io.StringIO(text, newline="")):
        for cell in row:
            assert not cell.lstrip().startswith(("=", "@")), cell
            assert cell[:1] not in ("+", "-") or cell[1:].replace(".", "").replace("e-", "").isdigit(), cell


def require_xml(data: bytes) -> Any:
    """Fail where XML is no XML, or one of its texts hides something."""
    root = etree.fromstring(data)
    for element in root.iter():
        for said in (element.text, element.tail, *element.attrib.values()):
            require_visible(said or "")
    return root


def require_page(text: str, scripts: int) -> None:
    """Fail where a page hides something, or text of others became an element or an attribute of it.

    Args:
        scripts: How many scripts it has of its own.
    """
    require_visible(text)
    root = html.document_fromstring(text)
    assert len(root.findall(".//script")) == scripts
    assert "default-src 'none'" in root.find(".//meta[@http-equiv]").get("content")
    for element in root.iter(etree.Element):
        assert not [name for name in element.attrib if name.startswith("on")], element.attrib
        assert element.tag != "img" or element.get("src").startswith("data:")
        for said in (element.text, *element.attrib.values()):
            require_visible(said or "")
