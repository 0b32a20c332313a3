"""Read gettext ``.po`` catalogues and compile them to the ``.mo`` format of the standard library."""

from __future__ import annotations

import ast
import re
import struct
from collections.abc import Iterable
from dataclasses import dataclass

from fieldhand.errors import InputError

_KEYWORD = re.compile(r'(msgctxt|msgid_plural|msgid|msgstr(?:\[(\d)\])?)\s+(".*")')

_ESCAPED = re.compile(r'["\\]')


@dataclass(frozen=True, kw_only=True)
class Entry:
    """A catalogue entry: a message with its translation.

    Attributes:
        template, many: English singular and plural; ``many`` is empty if the message has no plural.
        context: Distinguishes messages that are identical in English only.
        translations: Translation, one for each plural form.
    """

    template: str
    translations: tuple[str, ...]
    many: str = ""
    context: str = ""

    @property
    def key(self) -> tuple[str, str]:
        """Return the context and template that identify the entry."""
        return self.context, self.template


def read_entries(text: str) -> tuple[Entry, ...]:
    """Parse every entry of a ``.po`` file; the header is the entry with an empty template.

    Raises:
        InputError: A line is not valid in a ``.po`` file.
    """
    found: list[Entry] = []
    held: dict[str, str] = {}
    last = ""
    for number, line in enumerate([*text.splitlines(), ""], start=1):
        stripped = line.strip()
        if stripped.startswith("#"):
            continue
        if not stripped:
            if held:
                found.append(_entry(held))
            held, last = {}, ""
            continue
        match = _KEYWORD.fullmatch(stripped)
        if match:
            last = "msgstr[0]" if match[1] == "msgstr" else match[1]
            held[last] = _unquoted(match[3], number)
        elif stripped.startswith('"') and last:
            held[last] += _unquoted(stripped, number)
        else:
            raise InputError("this is not a line of a .po file", where=f"line {number}", advice="see docs/languages.md")
    return tuple(found)


def compiled(entries: Iterable[Entry]) -> bytes:
    """Return the non-empty entries as the bytes of a ``.mo`` file, as read by :class:`gettext.GNUTranslations`."""
    pairs: dict[bytes, bytes] = {}
    for entry in entries:
        if any(entry.translations):
            key = f"{entry.context}\x04{entry.template}" if entry.context else entry.template
            full = f"{key}\x00{entry.many}" if entry.many else key
            pairs[full.encode()] = "\x00".join(entry.translations).encode()
    keys = sorted(pairs)
    start = 28 + 16 * len(keys)
    ids = b"".join(key + b"\x00" for key in keys)
    texts = b"".join(pairs[key] + b"\x00" for key in keys)
    table, at = [], start
    for piece in (*keys, *(pairs[key] for key in keys)):
        table += [len(piece), at]
        at += len(piece) + 1
    head = struct.pack("<7I", 0x950412DE, 0, len(keys), 28, 28 + 8 * len(keys), 0, start)
    return head + struct.pack(f"<{len(table)}I", *table) + ids + texts


def _entry(held: dict[str, str]) -> Entry:
    translations = tuple(text for key, text in sorted(held.items()) if key.startswith("msgstr"))
    return Entry(
        template=held.get("msgid", ""),
        many=held.get("msgid_plural", ""),
        context=held.get("msgctxt", ""),
        translations=translations or ("",),
    )


def _unquoted(text: str, number: int) -> str:
    inside = text[1:-1]
    if len(text) > 1 and text[0] == text[-1] == '"' and not _ESCAPED.search(inside) and inside.isprintable():
        return inside  # as nearly all are; the parser of Python takes thirty times as long
    try:
        value = ast.literal_eval(text)
    except (SyntaxError, ValueError):
        value = None
    if not isinstance(value, str):
        raise InputError("the quotes do not match", where=f"line {number}", advice="see docs/languages.md")
    return value
