"""Names and docstrings of the package: each class has a name of its own, and docstrings say what a thing is or does."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import fieldhand

SOURCE = Path(fieldhand.__file__).parent
CLASS = re.compile(r"^ *class (\w+)", re.MULTILINE)
QUESTION = re.compile(r'"""(?:What|Whether|How|Who|Which|That) .*')


def _sources() -> list[str]:
    return [file.read_text(encoding="utf-8") for file in sorted(SOURCE.rglob("*.py"))]


def test_no_two_classes_have_the_same_name() -> None:
    counted = Counter(name for text in _sources() for name in CLASS.findall(text))
    assert len(counted) > 500, "the test sees few classes"
    assert [name for name, number in counted.items() if number > 1] == []


def test_no_docstring_opens_like_a_question() -> None:
    opened = [opening for text in _sources() for opening in QUESTION.findall(text)]
    assert opened == []
    assert QUESTION.findall('"""What a tree is."""'), "the test finds no such docstring"
