"""The page's own words: every language has all of them, with the same values, and none is unused."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

SOURCES = Path(__file__).parents[2] / "src" / "fieldhand" / "web" / "ui" / "src"
LANGUAGES = sorted(path.stem for path in (SOURCES / "lang").glob("*.ts") if path.stem != "index")


def words(language: str) -> dict[str, str]:
    text = (SOURCES / "lang" / f"{language}.ts").read_text()
    return dict(re.findall(r'^  (\w+): "((?:[^"\\]|\\.)*)",$', text, re.MULTILINE))


def used() -> set[str]:
    text = "\n".join(path.read_text() for path in SOURCES.rglob("*.ts") if path.name not in ("en.ts", "es.ts"))
    quoted = set(re.findall(r'"(\w+)"', text))
    begun = tuple(f"{one}_" for one in re.findall(r"`(\w+)_\$\{", text))
    return {key for key in words("en") if key in quoted or key.startswith(begun)}


def test_english_and_spanish_are_there() -> None:
    assert {"en", "es"} <= set(LANGUAGES)
    assert len(words("en")) > 80


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_language_says_all_with_the_same_values(language: str) -> None:
    english, own = words("en"), words(language)
    assert own.keys() == english.keys()
    for key, text in own.items():
        assert text.strip(), key
        assert sorted(set(re.findall(r"\{\w+\}", text))) == sorted(set(re.findall(r"\{\w+\}", english[key]))), key


def test_no_words_are_unused() -> None:
    unused = {key for key in words("en") if key not in used() and key.removesuffix("_many") not in used()}
    assert not unused
