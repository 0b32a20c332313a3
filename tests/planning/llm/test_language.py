"""The language description: complete, in the words of the docstrings, and in the forms that the schema knows."""

from __future__ import annotations

import inspect
import re
from itertools import pairwise
from typing import get_args

import pytest

from fieldhand.errors import ModelError
from fieldhand.planning.llm import language
from fieldhand.planning.llm.language import DERIVED, describe_language
from fieldhand.planning.llm.prompt import instructions
from fieldhand.task import plan
from fieldhand.task.capabilities import Capabilities
from fieldhand.task.codec_shapes import all_shapes, element_name, shape_of
from fieldhand.task.conditions import Condition
from fieldhand.task.plan import Node
from fieldhand.task.schema import schema_xsd
from fieldhand.task.selectors import Selector
from strategies import ROVER

EVERY = [*get_args(Node), *get_args(Condition), *get_args(Selector)]


@pytest.mark.parametrize("cls", EVERY, ids=lambda cls: cls.__name__)
def test_every_class_is_described_with_its_attributes_and_its_own_words(cls: type) -> None:
    form, meaning = paragraphs()[element_name(cls)]
    for attribute in shape_of(cls).attributes:
        assert (f'{attribute.name}="' in form) == (attribute.name not in DERIVED)
    first_words = re.split(r"``|\n", inspect.cleandoc(cls.__doc__ or ""))[0].split()
    assert " ".join(first_words) in meaning


def test_every_element_that_is_named_stands_in_the_schema() -> None:
    schema = schema_xsd(Capabilities(actions=ROVER.actions, quantities=ROVER.quantities), draft=True).decode()
    named = set(re.findall(r"</?([a-z][a-z-]*)", describe_language()))
    assert named
    for name in named:
        assert f'name="{name}"' in schema, name


def test_a_default_that_changes_the_meaning_is_shown() -> None:
    assert 'count="int (2)"' in paragraphs()["adjacent"][0]
    assert 'count="int (1)"' in paragraphs()["nearest"][0]


def test_nothing_of_python_is_left() -> None:
    assert not re.search(r"``|:class:|:attr:|=\.\.\.|ForEach|GoTo|at_most", describe_language())


def test_without_docstrings_there_is_a_clear_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan, "__doc__", None)
    language.describe_language.cache_clear()
    with pytest.raises(ModelError, match="-OO"):
        describe_language()


def paragraphs() -> dict[str, tuple[str, str]]:
    """Form and meaning of each element."""
    lines = describe_language().splitlines()
    found = {}
    for form, meaning in pairwise(lines):
        if form.startswith("<") and meaning.startswith("  "):
            found[re.split(r"[\s>/]", form[1:])[0]] = (form, meaning.strip())
    return found


def test_what_stands_for_a_selector_that_is_left_out_is_shown() -> None:
    forms = {name: form for name, (form, _) in paragraphs().items()}
    for name in ("spaced", "successive"):
        assert "[<near>S (<here/>)</near>]" in forms[name]
    for name in ("along-row", "across"):
        assert "[S = origin (<here/>)]" in forms[name]
    assert forms["half"].endswith(">[S]")


def test_every_element_and_attribute_that_the_rules_and_examples_write_is_of_the_language() -> None:
    shapes = {shape.element: {a.name for a in shape.attributes} for shape in all_shapes().values()}
    text = instructions()
    for name, inside in re.findall(r"<([a-z][a-z-]*)((?: [a-z-]+=\"[^\"<>]*\")*) ?/?>", text):
        if name in shapes:
            written = set(re.findall(r"([a-z-]+)=", inside)) - {"words", "xmlns"}
            assert written <= shapes[name], (name, written - shapes[name])
    alone = set(re.findall(r"[ (]([a-z]+(?:-[a-z]+)*)=\"", text.partition("# The plan language")[0]))
    assert alone - {"words", "xmlns"} <= set().union(*shapes.values())
