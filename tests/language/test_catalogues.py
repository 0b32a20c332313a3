"""The catalogues: every message of the source in every language, with the same placeholders."""

from __future__ import annotations

import importlib.util
import re
import sys
from pathlib import Path
from types import ModuleType

import pytest

from fieldhand.errors import InputError
from fieldhand.language.po import Entry, compiled, read_entries

ROOT = Path(__file__).parents[2]


def _script() -> ModuleType:
    """``scripts/catalogue.py``, which knows what the source says."""
    spec = importlib.util.spec_from_file_location("catalogue_script", ROOT / "scripts" / "catalogue.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


SCRIPT = _script()
FILES = list(SCRIPT.catalogues())


@pytest.fixture(scope="module")
def source() -> dict[tuple[str, str], Entry]:
    """Every message of the source, by context and English text."""
    found: dict[tuple[str, str], Entry] = SCRIPT.source_entries()
    return found


def placeholders(text: str) -> set[str]:
    return set(re.findall(r"\{(\w+)\}", text))


def test_there_is_spanish() -> None:
    assert "es" in {file.parts[-3] for file in FILES}


def test_the_source_is_read_for_its_messages(source: dict[tuple[str, str], Entry]) -> None:
    """The finder finds: plain, counted and contextual messages, and the words of built-in robots."""
    for key in (
        ("", "Return to {place}."),
        ("", "{count} tree"),
        ("compass", "north-west"),
        ("row", "{number}th"),
        ("action", "take a thermal picture"),
        ("assumption", "'{said}' means back to the start."),
    ):
        assert key in source


@pytest.mark.parametrize("file", FILES, ids=lambda f: f.parts[-3])
def test_every_message_has_a_translation_with_its_placeholders(
    file: Path, source: dict[tuple[str, str], Entry]
) -> None:
    found = {entry.key: entry for entry in read_entries(file.read_text(encoding="utf-8"))}
    for key, entry in source.items():
        assert key in found, f"{file.name} lacks {key}: run scripts/catalogue.py"
        said = found[key].translations
        assert all(said), f"not translated: {key}"
        assert found[key].many == entry.many
        # One of a thing may be said without the figure: "el único árbol".
        both = placeholders(entry.template) | placeholders(entry.many)
        for form in said:
            missing = both - placeholders(form)
            assert placeholders(form) <= both, key
            assert not missing or (entry.many and missing <= {"count", "times"}), key
    assert set(found) - set(source) == {("", "")}, "the source does not say these any more: run scripts/catalogue.py"


@pytest.mark.parametrize("file", FILES, ids=lambda f: f.parts[-3])
def test_a_catalogue_stands_as_the_script_writes_it(file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    assert SCRIPT.updated(text) == (text, [])


def test_what_is_new_is_added_and_named_and_what_is_gone_goes(source: dict[tuple[str, str], Entry]) -> None:
    text, missing = SCRIPT.updated('msgid ""\nmsgstr "Language: xx\\n"\n\nmsgid "gone"\nmsgstr "x"\n')
    assert 'msgid "gone"' not in text
    assert {entry.key for entry in missing} == set(source)


def test_entries_are_read_with_contexts_plurals_and_long_lines() -> None:
    text = (
        'msgid ""\nmsgstr ""\n"Language: xx\\n"\n\n# a remark\nmsgctxt "row"\nmsgid "a "\n"b"\nmsgstr "c\\"d"\n\n'
        'msgid "one"\nmsgid_plural "many"\nmsgstr[0] "x"\nmsgstr[1] "y"\n'
    )
    assert read_entries(text) == (
        Entry(template="", translations=("Language: xx\n",)),
        Entry(template="a b", context="row", translations=('c"d',)),
        Entry(template="one", many="many", translations=("x", "y")),
    )
    assert compiled(read_entries(text)).startswith(b"\xde\x12\x04\x95")


@pytest.mark.parametrize("text", ["msgid no quotes", 'msgid "open', '"no keyword"', 'msgid "a" "b'])
def test_a_line_that_is_none_is_named(text: str) -> None:
    with pytest.raises(InputError, match="line 2"):
        read_entries(f"# catalogue\n{text}\n")
