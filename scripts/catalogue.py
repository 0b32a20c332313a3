"""Update each language's catalogue with the messages of the source.

    python scripts/catalogue.py

adds new messages to every ``src/fieldhand/language/locale/*/LC_MESSAGES/fieldhand.po`` with an empty translation,
removes messages that the source no longer contains, and prints those without a translation; exit status 1 if there are
any.
"""

from __future__ import annotations

import ast
import json
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

SOURCE = Path(__file__).parents[1] / "src" / "fieldhand"
sys.path.insert(0, str(SOURCE.parent))

from fieldhand.language.message import Message  # noqa: E402
from fieldhand.language.po import Entry, read_entries  # noqa: E402
from fieldhand.language.words import say_action, say_captures, say_name  # noqa: E402
from fieldhand.places.filters.attribute_words import say_attribute, say_with_article  # noqa: E402
from fieldhand.planning.english.languages import known_languages  # noqa: E402
from fieldhand.planning.english.vocabulary import vocabulary  # noqa: E402
from fieldhand.planning.english.wishes import wish_kinds  # noqa: E402
from fieldhand.robot.loader import load_robot, robot_names  # noqa: E402

#: Attribute names of the built-in orchard, of common site files and of Tasks: they come from data, not from the source.
ATTRIBUTES = (
    *("variety", "cultivar", "species", "rootstock", "age_years", "yield_kg", "reward", "leaf_color", "color"),
    *("height_m", "diameter_cm", "health", "status", "condition", "planted", "priority", "row", "block"),
)
#: Messages of `fieldhand.files`, which does not use catalogues, and file errors of the operating system.
FILE_FAULTS = (
    "cannot be read: {reason}",
    "is larger than {most} bytes",
    "is not a file",
    "there is no such file",
)
SYSTEM_REASONS = (
    *("No such file or directory", "Permission denied", "Is a directory", "Not a directory"),
    *("No space left on device", "Read-only file system", "Input/output error"),
)
COLOURS = ("yellow", "green", "brown", "red", "healthy", "sick", "dead", "young", "old")


@cache
def source_entries() -> dict[tuple[str, str], Entry]:
    """Return every message of the source, by context and English text, without translations."""
    found: dict[tuple[str, str], Entry] = {}
    for file in sorted(SOURCE.rglob("*.py")):
        text = file.read_text(encoding="utf-8")
        if not any(called in text for called in _CALLED):
            continue
        for entry in _of_file(ast.parse(text)):
            found.setdefault(entry.key, entry)
    for entry in _of_data():
        found.setdefault(entry.key, entry)
    return found


def _of_file(tree: ast.Module) -> Iterator[Entry]:
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        texts = [a.value for a in node.args if isinstance(a, ast.Constant) and isinstance(a.value, str)]
        given = {k.arg: k.value for k in node.keywords}.get("context")
        context = given.value if isinstance(given, ast.Constant) else ""
        contexts = _ORDINALS if isinstance(given, ast.Name) else (context,)
        if called == "message" and texts:
            for one in contexts:
                yield Entry(template=texts[0], context=str(one), translations=())
        elif called == "counted" and len(texts) > 1:
            yield Entry(template=texts[0], many=texts[1], context=str(context), translations=())


#: Functions whose calls give messages.
_CALLED = ("message", "counted")
#: Contexts of ordinals (`fieldhand.places.row_words`).
_ORDINALS = ("tree", "row", "one")


def _of_data() -> Iterator[Entry]:
    robots = [load_robot(name) for name in robot_names()]
    for robot in robots:
        for action in robot.actions:
            yield _entry(say_action(action.name, 2))
            yield _entry(say_captures(action.name, 2))
            if action.words:
                yield Entry(template=action.words[0], context="capture", translations=())
            for parameter in action.parameters:
                yield _entry(say_name(parameter.name))
        for quantity in robot.quantities:
            yield _entry(say_with_article(quantity.name))
            yield _entry(say_name(quantity.name))
            for level in quantity.levels:
                yield Entry(template=level, context="level", translations=())
    for attribute in ATTRIBUTES:
        words = say_attribute(attribute)[0]
        yield _entry(words)
        yield Entry(template=str(words), context="of the tree", translations=())
        yield _entry(say_name(attribute))
    for colour in COLOURS:
        yield Entry(template=colour, context="tree", translations=())
        yield Entry(template=colour, context="trees", translations=())
        yield Entry(template=colour, context="value", translations=())
    for fault in ("action_failed", "drive_failed", "low_budget", "aborted"):
        yield Entry(template=fault, context="fault", translations=())
    yield Entry(template="power cut", context="log", translations=())
    for role in ("start", "end"):
        yield Entry(template=role, context="role", translations=())
    for way in ("return to end", "return to start", "stay"):
        yield Entry(template=way, context="way", translations=())
    for state in ("running", "paused", "interrupted", "ended"):
        yield Entry(template=state, context="state", translations=())
    for ending in ("completed", "returned", "exceeded", "faulted", "aborted"):
        yield Entry(template=ending, context="ending", translations=())
    for outcome in ("success", "failure", "indeterminate"):
        yield Entry(template=outcome, context="outcome", translations=())
    for order in ("pause", "continue", "return", "abort"):
        yield Entry(template=order, context="order", translations=())
    for fault in FILE_FAULTS:
        yield Entry(template=fault, context="file", translations=())
    for reason in SYSTEM_REASONS:
        yield Entry(template=reason, context="reason", translations=())
    for unit in ("metres", "seconds", "percent"):
        yield Entry(template=unit, context="unit", translations=())
    for language in known_languages():
        yield Entry(template=language, context="language", translations=())
    for hint in sorted(
        {known["attribute"] for part in ("superlatives", "compare_attribute") for known in vocabulary()[part]}
    ):
        if hint:
            yield Entry(template=hint, context="attribute hint", translations=())
    for known in vocabulary()["not_yet"]:
        yield Entry(template=known["advice"], context="advice", translations=())
    for kind in wish_kinds():
        yield Entry(template=kind.what, context="wish", translations=())
        yield Entry(template=kind.advice, context="wish", translations=())


def _entry(text: str) -> Entry:
    if not isinstance(text, Message):
        raise TypeError(f"'{text}' is no message")
    return Entry(template=text.template, many=text.many, context=text.context, translations=())


def catalogues() -> Iterator[Path]:
    """Yield the path of each language's catalogue."""
    yield from sorted((SOURCE / "language" / "locale").glob("*/LC_MESSAGES/*.po"))


def updated(text: str) -> tuple[str, list[Entry]]:
    """Return an updated catalogue and its entries without a translation."""
    known = {entry.key: entry for entry in read_entries(text)}
    header = text.split("\n\n", 1)[0]
    parts, missing = [header], []
    for key, entry in sorted(source_entries().items(), key=lambda one: (one[0][1], one[0][0])):
        old = known.get(key)
        translations = (
            old.translations if old is not None and old.many == entry.many else ("", "") if entry.many else ("",)
        )
        whole = Entry(template=entry.template, many=entry.many, context=entry.context, translations=translations)
        if not all(whole.translations):
            missing.append(whole)
        parts.append(_written(whole))
    return "\n\n".join(parts) + "\n", missing


def _written(entry: Entry) -> str:
    lines = [f"msgctxt {_quoted(entry.context)}"] if entry.context else []
    lines.append(f"msgid {_quoted(entry.template)}")
    if entry.many:
        lines.append(f"msgid_plural {_quoted(entry.many)}")
        lines += [f"msgstr[{k}] {_quoted(text)}" for k, text in enumerate(entry.translations)]
    else:
        lines.append(f"msgstr {_quoted(entry.translations[0])}")
    return "\n".join(lines)


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def main() -> int:
    """Update every catalogue; return 1 if any message lacks a translation."""
    status = 0
    for file in catalogues():
        text, missing = updated(file.read_text(encoding="utf-8"))
        file.write_text(text, encoding="utf-8")
        for entry in missing:
            print(f"{file.parts[-3]}: {entry.context + ': ' if entry.context else ''}{entry.template}")
            status = 1
    return status


if __name__ == "__main__":
    sys.exit(main())
