"""YAML from anyone: it is read, or refused for one kind of reason; never anything else."""

from __future__ import annotations

import json
from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.strict_yaml import YamlFault, read_yaml

REFUSED = {
    "a bool that is none": ("a: !!bool x", 1, "'x' cannot be read as bool"),
    "an int that is empty": ("\na: !!int ''", 2, "'' cannot be read as int"),
    "a float that is a sign": ("a: !!float '-'", 1, "cannot be read as float"),
    "a moment that is none": ("a: !!timestamp x", 1, "cannot be read as timestamp"),
    "a day that no month has": ("a: 2001-13-45", 1, "cannot be read as timestamp"),
    "a number to base 60 that no float holds": (f"a: {':'.join(['59'] * 400)}.5", 1, "cannot be read as float"),
    "a number that no float holds": (f"a: 0x{'f' * 400}", 1, "the number is too large"),
    "a number of thousands of digits": (f"a: {'9' * 5000}", 1, "cannot be read as int"),
    "half of a character": ('a: "\\uD800"', 1, "cannot be read as str"),
    "half of a character as a key": ('"\\uDC00": 1', 1, "cannot be read as str"),
    "a character beyond all": ('a: "\\UFFFFFFFF"', None, "a character or a number is out of range"),
    "an alias": ("a: &x 1\nb: *x", 2, "aliases (*name) are not allowed"),
    "a list in itself": ("&a [*a]", 1, "aliases (*name) are not allowed"),
    "merged keys by an alias": ("a: &a {b: 1}\nc: {<<: [*a, *a]}", 2, "aliases (*name) are not allowed"),
    "merged keys": ("a:\n  <<: {b: 1}", 2, "merged keys (<<) are not allowed"),
    "a key twice": ("a: 1\nb: {c: 1, c: 2}", 2, "the key 'c' is given twice"),
    "a key that is a list": ("? [a]\n: 1", 1, "unhashable key"),
    "a mapping that is none": ("a: !!map [b]", 1, "expected a mapping node"),
    "a Python object": ("a: !!python/object/apply:os.system ['true']", 1, "could not determine a constructor"),
    "too deep": ("[" * 3000, 1, "nested too deeply"),
    "two documents": ("a\n---\nb", 2, "another document"),
    "a control character": ("a: \x01", None, "special characters are not allowed"),
}


@pytest.mark.parametrize(("text", "line", "says"), REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_read_is_refused_with_its_line(text: str, line: int | None, says: str) -> None:
    with pytest.raises(YamlFault) as caught:
        read_yaml(text)
    assert says in caught.value.what
    assert caught.value.line == line
    assert len(caught.value.what) <= 200


def test_an_alias_is_read_where_it_may_stand_and_never_merged() -> None:
    assert read_yaml("a: &x [1]\nb: *x", aliases=True) == {"a": [1], "b": [1]}
    with pytest.raises(YamlFault, match="merged keys"):
        read_yaml("a: &x {c: 1}\nb: {<<: *x}", aliases=True)


_TAGS = (
    "!!int ",
    "!!bool ",
    "!!float ",
    "!!timestamp ",
    "!!set ",
    "!!omap ",
    "!!pairs ",
    "!!binary ",
    "&a ",
    "*a",
    "<<: ",
)
_SIGNS = ("- ", "? ", ": ", "\n", "  ", "{", "}", "[", "]", ", ", "'", '"', "-", ".", ":", "| ")
_words = st.sampled_from((*_TAGS, *_SIGNS, "a", "b: ", "0x", "1", "e9", "2001-01-01", "T00:00:00Z"))
_scalars = st.one_of(st.none(), st.booleans(), st.integers(-(2**70), 2**70), st.text("abcXYZ 019", max_size=8))


@given(st.one_of(st.text(), st.lists(_words, max_size=12).map("".join)))
@settings(max_examples=200, deadline=None)
def test_any_text_is_read_or_refused(text: str) -> None:
    for aliases in (False, True):
        with suppress(YamlFault):
            read_yaml(text, aliases=aliases)


@given(
    st.recursive(
        _scalars,
        lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text("abc", min_size=1), inner, max_size=3),
    )
)
@settings(max_examples=100, deadline=None)
def test_what_json_says_is_read_as_json_reads_it(content: object) -> None:
    assert read_yaml(json.dumps(content)) == content
