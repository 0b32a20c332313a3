"""Languages: gettext catalogues of translations, read directly from ``.po`` files.

Each language is one file, ``locale/<code>/LC_MESSAGES/fieldhand.po``. Its header contains the other settings of the
language: ``X-Decimal`` and ``X-Thousands`` are the separators in numbers, ``X-Melts`` lists contractions of two
words ("de el=del").
"""

from __future__ import annotations

import gettext
import io
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import lru_cache
from importlib import resources
from typing import Any, TypeVar, cast

from fieldhand.errors import InputError
from fieldhand.language.message import (
    LOG,
    Fill,
    Joined,
    Message,
    Number,
    Shaped,
    fill,
    joined,
    kept_in_log,
    message,
    named,
)
from fieldhand.language.po import Entry, compiled, read_entries
from fieldhand.language.recalling import QUANTITY, SHAPES, Effort, Sentence, sentences

_Text = TypeVar("_Text")

SOURCE = "en"
_DOMAIN = "fieldhand"
_MISSING = "\x00"
#: Placeholders of assumptions whose values are numbers.
_FIGURES = frozenset({"metres", "least", "most"})


#: Maximum length in characters of a log sentence that is matched against the catalogue.
_LONGEST_RETOLD = 600
_KNOWN = frozenset({"known", "also", "how", "reason"})
_WORDS = {"name": "name", "word": "level", "role": "role", "quantity": "quantity", "action": "action"}
_VALUES = frozenset({"bound", "has"})
_NAMES = frozenset({"id", "one", "two", "robot"})


@dataclass(frozen=True, kw_only=True, eq=False)
class Language:
    """Translations and number format of one language.

    Attributes:
        code: ISO 639 code: ``es``.
        name: Name of the language in that language.
        decimal, thousands: Decimal and thousands separators.
        melts: Contractions: two words that merge where a placeholder value follows, and the merged word.
        patterns: Sentences that are recognized in text from a file, by context.
    """

    code: str
    name: str
    translations: gettext.NullTranslations
    decimal: str = "."
    thousands: str = ","
    melts: Mapping[tuple[str, str], str]
    patterns: Mapping[str, tuple[Sentence, ...]]

    def say(self, text: str) -> str:
        """Return a message in this language; text that is not a message is returned unchanged."""
        if self.code == SOURCE:
            return str(text)
        match text:
            case Joined():
                return text.sign.join(self.say(part) for part in text.parts)
            case Shaped():
                return text.through(self.say(text.inner))
            case Message():
                return self._message(text)
            case Number():
                return text.translate({ord("."): self.decimal, ord(","): self.thousands})
            case _:
                return str(text)

    def read(self, value: _Text) -> _Text:
        """Return a copy of a dataclass, tuple or mapping with every message in it translated."""
        if isinstance(value, str):
            return cast(_Text, self.say(value))
        if isinstance(value, tuple | list):
            return cast(_Text, type(value)(self.read(part) for part in value))
        if isinstance(value, dict):
            return cast(_Text, {key: self.read(part) for key, part in value.items()})
        if is_dataclass(value) and not isinstance(value, type):
            changed = {f.name: self.read(getattr(value, f.name)) for f in fields(value) if f.init}
            return cast(_Text, replace(cast(Any, value), **changed))
        return value

    def _message(self, text: Message) -> str:
        if self.code in text.labels:
            return self.say(text.labels[self.code])
        found = self._looked_up(text)
        if found is not None:
            return self._filled(found, text.fills)
        known = self._known_again(text)
        if known is not None:
            return self.say(known)
        if text.instead is not None:
            return self._message(text.instead)
        if text.fills:
            return self._filled(text.template if text.number == 1 or not text.many else text.many, text.fills)
        return str(text)

    def _looked_up(self, text: Message) -> str | None:
        """Return the translation from the catalogue, or None."""
        context, own = text.context, self.translations
        found = _MISSING
        if not text.many:
            found = own.pgettext(context, text.template) if context else own.gettext(text.template)
        if found == _MISSING:  # gettext of Python 3.10 ignores entries that have a plural form
            many = text.many or text.template
            found = (
                own.npgettext(context, text.template, many, text.number)
                if context
                else own.ngettext(text.template, many, text.number)
            )
        return None if found == _MISSING else found

    def _known_again(self, text: Message) -> Message | None:
        if text.context == LOG:
            return self._retold(str(text), Effort())
        effort = Effort()
        for sentence in self.patterns.get(text.context, ()):
            found = sentence.fills_of(str(text), effort)
            if found is not None:
                fills = {name: _recalled_fill(name, part) for name, part in found.items()}
                return message(sentence.template, context=text.context, **fills)
        return None

    def _retold(self, text: str, effort: Effort) -> Message | None:
        """Return the message that a text from a log was made of, or None if no sentence or clause is recognized."""
        if len(text) > _LONGEST_RETOLD or not effort.step():
            return None
        clauses = _clauses(text)
        if len(clauses) > 1:
            retold = [self._retold(clause, effort) for clause in clauses]
            translated = [clause if known is None else known for known, clause in zip(retold, clauses, strict=True)]
            return joined("; ", translated) if any(known is not None for known in retold) else None
        for sentence in self.patterns.get(LOG, ()):
            parts = sentence.fills_of(text, effort)
            if parts is None:
                continue
            refilled = {name: self._refilled(name, part, effort) for name, part in parts.items()}
            fills = {name: part for name, part in refilled.items() if part is not None}
            if len(fills) == len(refilled):
                return message(sentence.template, context=LOG, **fills)
        where, colon, what = text.partition(": ")
        known = self._retold(what, effort) if colon else None
        return None if known is None else joined(": ", (kept_in_log(where), known))

    def _refilled(self, name: str, text: str, effort: Effort) -> str | None:
        """Return the value of a placeholder in a log sentence, or None if it must be recognized and is not."""
        if name in _KNOWN:
            return self._retold(text, effort)
        if name in _WORDS:
            return named(text, _WORDS[name])
        if name == "ids":
            more = re.fullmatch(r"(?P<items>.+) and (?P<count>\d+) more", text)
            last = re.fullmatch(r"(?P<items>.+) and (?P<last>\S+)", text)
            if more is not None:
                return message("{items} and {count} more", **more.groupdict())
            return text if last is None else message("{items} and {last}", **last.groupdict())
        if name in SHAPES and name not in _NAMES:
            return Number(text)
        if name in _VALUES and QUANTITY.fullmatch(text):
            return Number(text)
        known = None if name in _NAMES else self._retold(text, effort)
        return text if known is None else known

    def _filled(self, template: str, fills: Mapping[str, Fill]) -> str:
        translated: dict[str, Fill] = {
            name: self.say(value) if isinstance(value, str) else value for name, value in fills.items()
        }
        return fill(template, translated, self._melted if self.melts else None)

    def _melted(self, before: str, after: str) -> str:
        """Return two parts joined, with a contraction where they meet: "de" and "el árbol" become "del árbol"."""
        for (first, second), one in self.melts.items():
            if after.startswith(f"{second} ") and re.search(rf"(?<!\w){first} $", before, re.IGNORECASE):
                kept = before[: -len(first) - 1]
                large = before[len(kept)].isupper()
                return f"{kept}{one[0].upper() if large else one[0]}{one[1:]}{after[len(second) :]}"
        return before + after


class _Missing(gettext.NullTranslations):
    """Translations that mark missing entries, because a valid translation may equal the English text."""

    def gettext(self, message: str) -> str:  # noqa: ARG002
        return _MISSING

    def ngettext(self, msgid1: str, msgid2: str, n: int) -> str:  # noqa: ARG002
        return _MISSING

    def pgettext(self, context: str, message: str) -> str:  # noqa: ARG002
        return _MISSING

    def npgettext(self, context: str, msgid1: str, msgid2: str, n: int) -> str:  # noqa: ARG002
        return _MISSING


#: Language of the source code.
ENGLISH = Language(code=SOURCE, name="English", translations=_Missing(), melts={}, patterns={})


def _translations(entries: Iterable[Entry]) -> gettext.NullTranslations:
    found = gettext.GNUTranslations(io.BytesIO(compiled(entries)))
    found.add_fallback(_Missing())
    return found


def _recalled_fill(name: str, text: str) -> str:
    """Return the value of a placeholder in a recognized sentence: a number, or a word in the context of that name."""
    return Number(text) if name in _FIGURES else named(text, name)


def languages() -> Mapping[str, str]:
    """Return the available languages as code and name, with English first."""
    found = {SOURCE: "English"}
    for code in sorted(folder.name for folder in _locale().iterdir() if folder.is_dir()):
        found[code] = open_language(code).name
    return found


@lru_cache
def open_language(code: str) -> Language:
    """Return the language with a code.

    Raises:
        InputError: There is no catalogue for the code.
    """
    if code == SOURCE:
        return ENGLISH
    file = _file(code)
    if not file.is_file():
        there = ", ".join(languages())
        raise InputError(f"there is no language '{code[:40]}'", where="--lang", advice=f"choose one of {there}")
    entries = read_entries(file.read_text(encoding="utf-8"))
    header = _header(entries)
    return Language(
        code=code,
        name=header.get("X-Language-Name", code),
        translations=_translations(entries),
        decimal=header.get("X-Decimal", ".").strip('"'),
        thousands=header.get("X-Thousands", ",").strip('"'),
        melts=_melts(header.get("X-Melts", "")),
        patterns=sentences(entries),
    )


def spoken(wanted: str | None, environ: Mapping[str, str]) -> Language:
    """Return the requested language, else the language of the environment, else English.

    Raises:
        InputError: The requested language has no catalogue.
    """
    if wanted is not None:
        return open_language(wanted.strip().lower())
    setting = next((environ[name] for name in ("LC_ALL", "LC_MESSAGES", "LANG") if environ.get(name)), "")
    code = re.split(r"[_.@-]", setting.lower())[0]
    return open_language(code if code == SOURCE or _file(code).is_file() else SOURCE)


def _file(code: str) -> Any:
    """Return the catalogue file of a code, which may not exist."""
    return _locale() / (code if re.fullmatch(r"[a-z]{2,3}", code) else "none") / "LC_MESSAGES" / f"{_DOMAIN}.po"


def _locale() -> Any:
    return resources.files("fieldhand.language") / "locale"


def _header(entries: Iterable[Entry]) -> dict[str, str]:
    text = next((e.translations[0] for e in entries if not e.template), "")
    pairs = (line.partition(":") for line in text.splitlines())
    return {name.strip(): value.strip() for name, _, value in pairs}


def _melts(text: str) -> dict[tuple[str, str], str]:
    found = {}
    for pair in filter(None, (part.strip() for part in text.split(","))):
        words, _, one = pair.partition("=")
        first, second = words.split()
        found[first, second] = one.strip()
    return found


def _clauses(text: str) -> list[str]:
    """Return the clauses of a sentence, split at semicolons outside brackets."""
    found, depth, begins = [], 0, 0
    for k, sign in enumerate(text):
        depth += (sign == "(") - (sign == ")")
        if depth <= 0 and text.startswith("; ", k):
            found.append(text[begins:k])
            begins = k + 2
    return [*found, text[begins:]]
