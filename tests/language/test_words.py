"""Words for numbers, units, lists and actions."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.language import words


@pytest.mark.parametrize(
    ("value", "text"), [(33.0, "33"), (0.5, "0.5"), (-4.25, "\N{MINUS SIGN}4.25"), (1e6, "1,000,000"), (1e-9, "0")]
)
def test_numbers_carry_no_needless_digits(value, text):
    assert words.say_number(value) == text


@given(st.floats())
def test_every_number_can_be_said_without_an_exponent(value):
    said = words.say_number(value)
    assert said
    assert not any(mark in said.replace("unknown number", "") for mark in ("e+", "e-", "inf", "nan"))


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [(33.0, "degC", "33 °C"), (40.0, "percent", "40 %"), (400.0, "ppm", "400 ppm"), (6.5, "", "6.5")],
)
def test_units_are_printed_as_people_write_them(value, unit, text):
    assert words.say_quantity(value, unit) == text


@pytest.mark.parametrize(
    ("seconds", "text"), [(0, "0 s"), (89, "89 s"), (91, "2 min"), (3600, "60 min"), (7500, "2 h 05 min")]
)
def test_durations_are_as_fine_as_they_need_to_be(seconds, text):
    assert words.say_duration(seconds) == text


@given(st.floats(min_value=0))
def test_every_duration_can_be_said_in_few_words(seconds):
    assert len(words.say_duration(seconds)) <= 20


@pytest.mark.parametrize("seconds", [1e300, float("inf")])
def test_what_no_mission_lasts_is_said_without_a_figure(seconds):
    assert words.say_duration(seconds) == "more than ten years"


@pytest.mark.parametrize(
    ("noun", "many"),
    [
        ("tree", "trees"),
        ("thermal picture", "thermal pictures"),
        ("leaf", "leaves"),
        ("branch", "branches"),
        ("berry", "berries"),
        ("survey day", "survey days"),
        ("fruit", "fruit"),
        ("box", "boxes"),
    ],
)
def test_plurals(noun, many):
    assert words.plural(noun) == many


@pytest.mark.parametrize(
    ("noun", "text"),
    [("image", "an image"), ("thermal picture", "a thermal picture"), ("RGB image", "an RGB image"), ("CO₂", "a CO₂")],
)
def test_articles_follow_the_sound(noun, text):
    assert words.article(noun) == text


@pytest.mark.parametrize(
    ("action", "count", "text"),
    [
        ("take_thermal_picture", 1, "1 thermal picture"),
        ("read_co2", 2, "2 CO₂ readings"),
        ("sample_leaf", 3, "3 leaves"),
        ("photograph", 2, "2 photographs"),
    ],
)
def test_captures_are_counted_by_what_they_yield(action, count, text):
    assert words.say_captures(action, count) == text


@pytest.mark.parametrize(
    ("action", "count", "text"), [("photograph", 1, "photograph"), ("photograph", 3, "photograph 3 times")]
)
def test_an_action_of_one_word_is_a_verb(action, count, text):
    assert words.say_action(action, count) == text


@pytest.mark.parametrize(("items", "text"), [((), ""), (("1",), "1"), (("1", "2"), "1 and 2"), ("123", "1, 2 and 3")])
def test_lists(items, text):
    assert words.listed(items) == text


@pytest.mark.parametrize("name", ["{", "}", "take_{count}_pictures", "{0}"])
def test_names_that_look_like_placeholders_are_quoted(name):
    assert str(words.say_action(name)) == f"do “{name}”"
    assert str(words.say_action(name, 2)) == f"do “{name}” twice"
    assert str(words.say_captures(name, 3)) == f"3 captures of “{name}”"
