"""A language that has every sentence and says it without its words, so that what is no message is seen."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from functools import cache
from importlib import resources

from fieldhand.language import Language, open_language
from fieldhand.language.catalogue import _translations
from fieldhand.language.po import Entry, read_entries


def silent_language() -> Language:
    """Return that language, as one that was read."""
    patterns = open_language("es").patterns
    return Language(code="xx", name="xx", translations=_translations(_entries()), melts={}, patterns=patterns)


@cache
def silent_po() -> str:
    """Its catalogue, as a file."""
    return "\n".join(map(_written, _entries()))


def words_left(said: str, known: set[str]) -> list[str]:
    """Return the words of a text that was said in it, but for the known ones and what is quoted from somebody."""
    return [word for word in words_of(re.sub("«[^»]*»", "", said)) if word not in known]


def words_of(text: str) -> list[str]:
    return re.findall(r"[^\W\d_]{2,}", text)


def _entries() -> Iterator[Entry]:
    """Yield every entry of the Spanish catalogue, which its tests hold whole, with its placeholders alone."""
    file = resources.files("fieldhand.language") / "locale" / "es" / "LC_MESSAGES" / "fieldhand.po"
    for e in read_entries(file.read_text(encoding="utf-8")):
        if e.context == "yes or no" or not e.template:
            yield e  # the one is typed, the other is the header
        else:
            said = tuple(" ".join(re.findall(r"«?\{\w+\}»?", text)) or "·" for text in e.translations)
            yield Entry(template=e.template, many=e.many, context=e.context, translations=said)


def _written(entry: Entry) -> str:
    lines = [f"msgctxt {json.dumps(entry.context)}"] if entry.context else []
    lines.append(f"msgid {json.dumps(entry.template)}")
    if entry.many:
        lines.append(f"msgid_plural {json.dumps(entry.many)}")
        lines += [f"msgstr[{k}] {json.dumps(text)}" for k, text in enumerate(entry.translations)]
    else:
        lines.append(f"msgstr {json.dumps(entry.translations[0])}")
    return "\n".join(lines) + "\n"
