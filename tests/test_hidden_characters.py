"""Text from outside is visible wherever a person reads it, and no writer goes round the gate."""

from __future__ import annotations

import ast
import csv
import io
import json
import unicodedata
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import fieldhand
from fieldhand.hidden_characters import csv_text, find_hidden, json_text, visible, visible_json

ANY = st.text(st.characters(categories=None))
SOURCE = Path(fieldhand.__file__).parent


def hidden(text: str, kept: str = "") -> set[str]:
    """The characters of a text that no screen shows."""
    return {c for c in text if unicodedata.category(c) in ("Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp") and c not in kept}


@given(ANY)
def test_visible_text_holds_nothing_hidden_and_stays_as_it_is(text: str) -> None:
    shown = visible(text)
    assert not hidden(shown)
    assert visible(shown) == shown
    assert not hidden(visible(text, lines=True), "\n\t")


@given(ANY)
def test_text_is_changed_where_and_only_where_something_is_hidden(text: str) -> None:
    found = find_hidden(text)
    assert (found is None) == (visible(text) == text)
    if found is not None:
        assert visible(text[: found.at]) == text[: found.at]
        assert found.name.startswith(f"U+{ord(text[found.at]):04X}")


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("tree 4\x9b2K", r"tree 4\u{009b}2K"),
        ("a\u202eb", r"a\u{202e}b"),
        ("line\nline", r"line\u{000a}line"),
        ("4\u3164", r"4\u{3164}"),
        ("\U000e0041", r"\u{e0041}"),
        ("34,5 °C CO₂ árbol 樹 🌳", "34,5 °C CO₂ árbol 樹 🌳"),
    ],
)
def test_a_hidden_character_is_shown_by_its_code_point(text: str, shown: str) -> None:
    assert visible(text) == shown


def test_a_hidden_character_is_named() -> None:
    found = find_hidden("4\u202e5")
    assert found is not None
    assert (found.at, found.name) == (1, "U+202E RIGHT-TO-LEFT OVERRIDE")


@given(st.dictionaries(ANY, st.lists(ANY | st.floats(allow_nan=False) | st.none())))
def test_json_for_programs_reads_back_the_same_and_hides_nothing(value: object) -> None:
    text = json_text(value, indent=1)
    assert json.loads(text) == value
    assert not hidden(text, "\n")


@given(ANY)
def test_json_for_people_reads_back_visible(text: str) -> None:
    assert json.loads(visible_json({text: [text]})) == {visible(text, lines=True): [visible(text, lines=True)]}


@given(st.lists(st.lists(ANY, min_size=1), min_size=1))
def test_a_table_reads_back_visible_and_computes_nothing(rows: list[list[str]]) -> None:
    text = csv_text(rows)
    assert not hidden(text, "\r\n")
    read = list(csv.reader(io.StringIO(text, newline="")))
    assert [[cell.removeprefix("'") for cell in row] for row in read] == [
        [visible(cell).removeprefix("'") for cell in row] for row in rows
    ]
    assert not [
        cell
        for row in read
        for cell in row
        if cell.startswith(("=", "+", "-", "@", "\uff1d", "\uff0b", "\uff0d", "\uff20"))
    ]


def _calls(tree: ast.AST) -> list[tuple[str, ast.Call]]:
    return [(ast.unparse(node.func), node) for node in ast.walk(tree) if isinstance(node, ast.Call)]


#: What writes text past the gate, and what is used in its place.
PAST = {
    "print": "print_error, or the consoles of fieldhand.cli.console",
    "Console": "the consoles of fieldhand.cli.console",
    "csv.writer": "csv_text",
    "csv.DictWriter": "csv_text",
}
#: A module without these words calls none of them, and need not be parsed.
WORDS_OF_WRITERS = (*(name.rpartition(".")[2] for name in PAST), "ensure_ascii", "savefig")


def test_no_writer_goes_round_the_gate() -> None:
    for path in sorted(SOURCE.rglob("*.py")):
        if path.name == "hidden_characters.py":
            continue
        text = path.read_text(encoding="utf-8")
        if not any(word in text for word in WORDS_OF_WRITERS):
            continue
        calls = _calls(ast.parse(text))
        for name, call in calls:
            assert name not in PAST, f"{path}:{call.lineno}: use {PAST[name]}"
            raw = [k for k in call.keywords if k.arg == "ensure_ascii" and ast.unparse(k.value) != "True"]
            assert not raw, f"{path}:{call.lineno}: json_text and visible_json write JSON beyond ASCII"
            if name.endswith("savefig") and "bench" not in path.parts:
                assert "make_text_visible" in {other for other, _ in calls}, f"{path}:{call.lineno}"
