"""Detect hidden characters in untrusted text, and make them visible in terminal, page, report and files.

Text of a Task, a site, a robot's message or a model's answer may contain characters that move the cursor, reverse the
direction of writing or are invisible, so that a person reads something other than the text. All output of the package
passes through the functions here; files that a mission is planned or signed with are checked by :func:`find_hidden`
and refused.
"""

from __future__ import annotations

import csv
import io
import json
import re
import sys
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

#: Unicode categories without a visible form: control, format (bidi, zero width), surrogate, private, unassigned,
#: line and paragraph separators.
_HIDDEN = frozenset({"Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"})
#: Invisible letters, marks and symbols (Unicode: Default_Ignorable_Code_Point, Braille blank).
_BLANK = re.compile("[\u034f\u115f\u1160\u17b4\u17b5\u180b-\u180f\u2800\u3164\ufe00-\ufe0f\uffa0\U000e0100-\U000e01ef]")
_NOT_ASCII = re.compile("[^\x00-\x7e]")
_ESCAPE_OR_NOT_ASCII = re.compile(r"\\(?:u[0-9a-f]{4}|.)|[^\x00-\x7e]")
_HARMLESS_ESCAPES = frozenset({r"\n", r"\t", r"\"", r"\\"})
#: First characters that a spreadsheet interprets as a formula (OWASP, "CSV Injection"), also in full width.
_FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n", "\uff1d", "\uff0b", "\uff0d", "\uff20")


@dataclass(frozen=True, kw_only=True)
class HiddenCharacter:
    """A hidden character in a text.

    Attributes:
        at: Index in the text.
        name: Code point and Unicode name, if any: ``U+202E RIGHT-TO-LEFT OVERRIDE``.
    """

    at: int
    name: str


def visible(text: str, *, lines: bool = False) -> str:
    r"""Return a text with every hidden character replaced by its code point, as ``\u{009b}``.

    Args:
        text: Untrusted text.
        lines: Keep line ends and tabs; otherwise they are replaced too, and the result is one line.
    """
    if not _has_hidden(text):
        return text
    kept = "\n\t" if lines else ""
    return "".join(c if c in kept or not _is_hidden(c) else f"\\u{{{ord(c):04x}}}" for c in text)


def print_error(*lines: str) -> None:
    """Print lines on standard error, each with its hidden characters visible and on one line."""
    for line in lines:
        print(visible(line), file=sys.stderr, flush=True)  # noqa: T201


def find_hidden(text: str, *, lines: bool = False) -> HiddenCharacter | None:
    """Return the first hidden character of a text; None if there is none.

    Args:
        text: Untrusted text.
        lines: Accept line ends and tabs.
    """
    if not _has_hidden(text):
        return None
    kept = "\n\t" if lines else ""
    for at, character in enumerate(text):
        if character not in kept and _is_hidden(character):
            name = unicodedata.name(character, "")
            return HiddenCharacter(at=at, name=f"U+{ord(character):04X}{f' {name}' if name else ''}")
    return None


def find_hidden_within(value: object, where: str = "") -> tuple[str, HiddenCharacter] | None:
    """Return the path, as ``a.b[2]``, and the first hidden character in nested mappings, lists and strings."""
    if isinstance(value, str):
        character = find_hidden(value, lines=True)
        return None if character is None else (where, character)
    parts: Iterable[tuple[str, object]] = ()
    if isinstance(value, Mapping):
        parts = ((f"{where}.{visible(str(key))}".lstrip("."), part) for key, part in value.items())
        for key in value:
            if isinstance(key, str) and (hidden := find_hidden(key, lines=True)) is not None:
                return where, hidden
    elif isinstance(value, list | tuple):
        parts = ((f"{where}[{k}]", part) for k, part in enumerate(value))
    return next((found for place, part in parts if (found := find_hidden_within(part, place)) is not None), None)


def json_text(
    value: Any, *, indent: int | None = None, separators: tuple[str, str] | None = None, allow_nan: bool = True
) -> str:
    r"""Return JSON for programs, with hidden characters as escapes (``\u009b``), so that a parser restores the text.

    Mappings of any kind become objects; other types unknown to JSON are written as strings.
    """
    text = _dumped(value, indent, separators, allow_nan=allow_nan)
    return text if text.isascii() and "\x7f" not in text else _NOT_ASCII.sub(_escaped, text)


def visible_json(
    value: Any, *, indent: int | None = None, separators: tuple[str, str] | None = None, allow_nan: bool = True
) -> str:
    r"""Return JSON whose strings are shown to people: a parser returns them with hidden characters made visible."""
    text = _dumped(value, indent, separators, allow_nan=allow_nan)
    return _ESCAPE_OR_NOT_ASCII.sub(_spelt, text)


def csv_text(rows: Iterable[Sequence[object]]) -> str:
    """Return rows as CSV (RFC 4180) with visible text; cells that look like a formula get a leading apostrophe."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\r\n")
    writer.writerows([_cell(cell) for cell in row] for row in rows)
    return out.getvalue()


def _cell(value: object) -> object:
    if not isinstance(value, str):
        return value
    return f"'{visible(value)}" if value.startswith(_FORMULA) else visible(value)


def _has_hidden(text: str) -> bool:
    return not text.isprintable() or (not text.isascii() and _BLANK.search(text) is not None)


@lru_cache(maxsize=4096)
def _is_hidden(character: str) -> bool:
    return unicodedata.category(character) in _HIDDEN or _BLANK.match(character) is not None


def _dumped(value: Any, indent: int | None, separators: tuple[str, str] | None, *, allow_nan: bool) -> str:
    return json.dumps(
        value, ensure_ascii=False, indent=indent, separators=separators, allow_nan=allow_nan, default=_plain
    )


def _escaped(match: re.Match[str]) -> str:
    character = match.group()
    return json.dumps(character)[1:-1] if _is_hidden(character) else character


def _spelt(match: re.Match[str]) -> str:
    """Return a match in a JSON string with a hidden character replaced by its escaped code point."""
    found = match.group()
    if found in _HARMLESS_ESCAPES:
        return found
    character = json.loads(f'"{found}"') if found.startswith("\\") else found
    return f"\\\\u{{{ord(character):04x}}}" if _is_hidden(character) else found


def _plain(value: object) -> object:
    return dict(value) if isinstance(value, Mapping) else str(value)
