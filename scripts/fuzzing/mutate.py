"""Mutate text, JSON, YAML and XML into almost valid documents."""

from __future__ import annotations

import json
import random
import re
from collections.abc import Callable, Sequence
from typing import Any

import yaml
from lxml import etree

Mutator = Callable[[bytes, random.Random], bytes]

_WORD = re.compile(r"[A-Za-z_]+|[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?|\s+|[^\sA-Za-z_\d]")
_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_DUMPER = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
# fmt: off
#: Numbers at the limits of their formats, and texts that only resemble numbers.
NUMBERS = (
    *("0", "-0.0", "-1", "1", "2", "0.1", "1e-320", "1e308", "-1e308", "1e999", "-1e999", "NaN", ".nan", ".inf"),
    *("Infinity", "0x10", "0o17", "017", "1_000", "1:30", "1:2:3.5", "90:59:59:59:59:59", "9007199254740993", "1,5"),
    *(f"1{'0' * 30}", f"{'9' * 5000}", f"0x{'f' * 5000}", f"1.{'1' * 400}", f"{':'.join(['59'] * 400)}.5", "--1", "½"),
)
#: Characters that control terminals, end strings, or are half of a pair.
SIGNS = (
    *("\0", "\x01", "\x1b[2J", "\r", "\n", "\t", "\x85", "\u2028"),
    *("\u202e", "\ufeff", "\ufffe", "\U0001f333", "é", "ﬁ"),
    *("'", '"', "\\", "/", "../", "<", ">", "&", "&amp;", "&x;"),
    *("&#0;", "&#x1F;", "]]>", "<!--", "%", "{", "}", "[", "]", ","),
    *(":", ";", "#", "|", "-", "\\ud800", "\\u0000", "\\x00", "=", "@", "`", "!", "*", "?", " "),
)
YAML_PARTS = (
    *("!!bool x", "!!int ''", "!!float ''", "!!float -", "!!int 0x"),
    *("!!timestamp x", "!!binary é", "!!set {a, b}", "!!null x"),
    *("!!omap [a: 1]", "!!pairs [a: 1]", "!!str [a]", "!!map [a]"),
    *("!!seq {a: 1}", "!!python/name:os.system", "! x", "!u x"),
    *("&a [*a]", "&a {b: *a}", "*a", "&a ", "<<: {a: 1}"),
    *("<<: [{a: 1}, {a: 1}]", "? [a]\n: b", "? {a: b}\n: c", "=", "~"),
    *("2001-13-45", "0001-01-01T00:00:00+14:00", "9999-12-31T23:59:59-23:59"),
    *("2026-05-01T06:00:00+99:99", "2026-05-01"),
    *("2026-05-01 06:00:00.99999999999 -00:00", "yes", "no", "null"),
    *("|\n  x", ">-\n  x", "'", '"\\uD800"', '"\\x00"', "...", "---\n"),
    *("%YAML 9.9\n---\n", "%TAG ! tag:x,2000:\n---\n", "- ", "? "),
    *("{a: 1, a: 2}", "[" * 400, "{a: " * 400, "- " * 400, "!!bool"),
)
XML_PARTS = (
    *("<!DOCTYPE a [<!ENTITY b 'c'>]>", "<![CDATA[x]]>", "<?pi x?>"),
    *("<!-- x -->", '<a xmlns="b">', "<a:b/>", "</a>", "<a/>"),
    *('xml:space="x" ', 'xmlns:a="" ', 'a="1" a="2" ', "<a>" * 300),
    *("<a><b>" * 3000, "{1} == 2", "true", "false", "-1 9 3"),
)
# fmt: on


def mutate_text(data: bytes, rng: random.Random, *, parts: Sequence[str] = ()) -> bytes:
    """Change a few places of a text: swap, drop, repeat or replace words."""
    text = data.decode("utf-8", errors="surrogateescape")
    for _ in range(rng.choice((1, 1, 1, 2, 3, 6))):
        text = _changed(text, rng, parts)
    data = text.encode("utf-8", errors="surrogateescape")
    if rng.random() < 0.03:
        data = _encoded(data, rng)
    return data


def mutate_yaml(data: bytes, rng: random.Random) -> bytes:
    """Change a YAML document, in its text or in its content."""
    if rng.random() < 0.5:
        return mutate_text(data, rng, parts=YAML_PARTS)
    try:
        content = mutate_value(yaml.load(data, Loader=_LOADER), rng)  # noqa: S506  a safe one
        return bytes(yaml.dump(content, Dumper=_DUMPER, sort_keys=False, allow_unicode=True), "utf-8")
    except Exception:  # noqa: BLE001  a document that is already broken can be changed as text
        return mutate_text(data, rng, parts=YAML_PARTS)


def mutate_json(data: bytes, rng: random.Random) -> bytes:
    """Change a JSON document, in its text or in its content."""
    if rng.random() < 0.4:
        return mutate_text(data, rng)
    try:
        return json.dumps(mutate_value(json.loads(data), rng)).encode()
    except (ValueError, RecursionError):
        return mutate_text(data, rng)


def mutate_lines(data: bytes, rng: random.Random) -> bytes:
    """Change, drop or repeat one of several JSON lines."""
    lines = data.split(b"\n")
    k = rng.randrange(len(lines))
    match rng.randrange(6):
        case 0:
            del lines[k]
        case 1:
            lines.insert(rng.randrange(len(lines)), lines[k])
        case _:
            lines[k] = mutate_json(lines[k], rng)
    return b"\n".join(lines)


def mutate_xml(data: bytes, rng: random.Random) -> bytes:
    """Change an XML document, in its text or in its elements and attributes."""
    if rng.random() < 0.4:
        return mutate_text(data, rng, parts=XML_PARTS)
    try:
        root = etree.fromstring(data, etree.XMLParser(resolve_entities=False, no_network=True))
        for _ in range(rng.choice((1, 1, 2, 4))):
            _change_element(root, rng)
        return etree.tostring(root, xml_declaration=True, encoding="UTF-8")
    except (etree.LxmlError, ValueError, TypeError):
        return mutate_text(data, rng, parts=XML_PARTS)


def mutate_value(value: Any, rng: random.Random) -> Any:
    """Return a JSON or YAML value with one change."""
    if isinstance(value, dict) and value and rng.random() < 0.9:
        key = rng.choice(list(value))
        match rng.randrange(8):
            case 0:
                return {k: v for k, v in value.items() if k != key}
            case 1:
                return {(_changed(str(k), rng, ()) if k == key else k): v for k, v in _shuffled(value, rng)}
            case 2:
                return {**value, rng.choice(list(value)): value[key]}
            case _:
                return {**value, key: mutate_value(value[key], rng)}
    if isinstance(value, list) and value and rng.random() < 0.9:
        k = rng.randrange(len(value))
        match rng.randrange(8):
            case 0:
                return [*value[:k], *value[k + 1 :]]
            case 1:
                return [*value, value[k]]
            case 2:
                return value * rng.choice((2, 3, 50))
            case _:
                return [*value[:k], mutate_value(value[k], rng), *value[k + 1 :]]
    return _value(rng, value)


def _shuffled(value: dict[Any, Any], rng: random.Random) -> list[tuple[Any, Any]]:
    pairs = list(value.items())
    rng.shuffle(pairs)
    return pairs


def _value(rng: random.Random, before: Any) -> Any:
    """Return a value to replace another."""
    if isinstance(before, str) and rng.random() < 0.5:
        return _changed(before, rng, ())
    if isinstance(before, int | float) and not isinstance(before, bool) and rng.random() < 0.5:
        with_sign = rng.choice((-1, 1, 1, 1))
        try:
            return with_sign * before * rng.choice((0, 1, 2, 0.5, 10, 1e3, 1e-3, 1e300, 10**30))
        except OverflowError:
            return before
    return rng.choice(
        (
            *(None, True, False, 0, -1, 1, 2, 1e308, -1e308, 1e-320),
            *(float("inf"), float("nan"), 10**30, 10**400, 2**63),
            *("", " ", "x", "0", "true", "\0", "\U0001f333", "a" * 10_000),
            *("..", "\x1b[31m", [], {}, [[]], [None], {"a": 1}),
            [before],
            {"a": before},
            [[0, 0], [0, 1], [1, 1], [0, 0]],
        )
    )


def _changed(text: str, rng: random.Random, parts: Sequence[str]) -> str:
    (start, end), (from_, to) = _word(text, rng), _word(text, rng)
    word, others = text[start:end], text[from_:to]
    match rng.randrange(12):
        case 0:
            new = ""
        case 1:
            new = word * rng.choice((2, 3, 30))
        case 2 | 3:
            new = others
        case 4 | 5:
            new = rng.choice(NUMBERS)
        case 6:
            new = word + rng.choice(SIGNS)
        case 7:
            new = rng.choice(SIGNS)
        case 8:
            return _spliced(text, rng)
        case 9:
            new = word + others
        case _:
            new = rng.choice(parts) if parts else rng.choice(SIGNS) * rng.choice((1, 2, 2000))
    return f"{text[:start]}{new}{text[end:]}"


def _word(text: str, rng: random.Random) -> tuple[int, int]:
    """Return the span of a random word, number, sign or space."""
    if not text:
        return 0, 0
    at = rng.randrange(len(text))
    while at and rng.random() < 0.9 and text[at - 1].isalnum() and text[at].isalnum():
        at -= 1  # mostly from the beginning of a word
    found = _WORD.search(text, at)
    return found.span() if found else (len(text), len(text))


def _spliced(text: str, rng: random.Random) -> str:
    """Remove, repeat or move lines, or truncate the text."""
    lines = text.splitlines(keepends=True) or [""]
    start = rng.randrange(len(lines))
    end = min(len(lines), start + rng.choice((1, 1, 2, 5, 20)))
    chunk, rest = lines[start:end], [*lines[:start], *lines[end:]]
    match rng.randrange(4):
        case 0:
            return "".join(rest)
        case 1:
            return "".join([*lines[:start], *chunk, *lines[start:]])
        case 2:
            k = rng.randrange(len(rest) + 1)
            return "".join([*rest[:k], *chunk, *rest[k:]])
        case _:
            return text[: rng.randrange(len(text) + 1)]


def _encoded(data: bytes, rng: random.Random) -> bytes:
    """Return the text in another encoding, or with a byte order mark."""
    text = data.decode("utf-8", errors="replace")
    match rng.randrange(4):
        case 0:
            return b"\xef\xbb\xbf" + data
        case 1:
            return text.encode("utf-16", errors="replace")
        case 2:
            return text.encode("latin-1", errors="replace")
        case _:
            return text.encode("utf-32-be", errors="replace")


def _change_element(root: Any, rng: random.Random) -> None:
    elements = [e for e in root.iter() if isinstance(e.tag, str)]
    one, other = rng.choice(elements), rng.choice(elements)
    parent = one.getparent()
    match rng.randrange(9):
        case 0 if parent is not None:
            parent.remove(one)
        case 1 if parent is not None:
            parent.insert(rng.randrange(len(parent) + 1), _copy(one))
        case 2:
            one.append(_copy(other))
        case 3:
            one.tag = other.tag
        case 4:
            one.text = rng.choice((*NUMBERS, "x", "", " ", one.text))
        case 5 if one.attrib:
            del one.attrib[rng.choice(list(one.attrib))]
        case 6:
            for name, value in other.attrib.items():
                one.set(name, value)
        case _ if one.attrib:
            name = rng.choice(list(one.attrib))
            values = (*NUMBERS, "", "x", "true", *(v for e in elements for v in e.attrib.values()))
            one.set(name, rng.choice((rng.choice(values), _changed(one.get(name), rng, ()))))


def _copy(element: Any) -> Any:
    return etree.fromstring(etree.tostring(element, with_tail=False))
