"""Messages and languages."""

from __future__ import annotations

import copy

import pytest

from fieldhand.errors import InputError
from fieldhand.language import (
    ENGLISH,
    Language,
    Message,
    Number,
    counted,
    joined,
    languages,
    message,
    named,
    open_language,
    recalled,
    shaped,
    spoken,
)
from fieldhand.language.words import capitalised, listed, say_action, say_duration, say_number, say_quantity

SPANISH: Language = open_language("es")


def test_a_message_is_its_english_text() -> None:
    said = message("Return to {place}.", place=message("tree {id}", id="81"))
    assert said == "Return to tree 81."
    assert ENGLISH.say(said) == "Return to tree 81."
    assert SPANISH.say(said) == "Volver al árbol 81."


def test_two_languages_are_spoken_at_the_same_time() -> None:
    said = counted("{count} tree", "{count} trees", 3)
    assert [language.say(said) for language in (SPANISH, ENGLISH, SPANISH)] == ["3 árboles", "3 trees", "3 árboles"]


def test_a_copy_of_a_message_is_one_still() -> None:
    said = copy.deepcopy((message("the first tree"),))
    assert SPANISH.read(said) == ("el primer árbol",)


@pytest.mark.parametrize(
    ("english", "spanish"),
    [
        (message("of {trees}", trees=message("tree {id}", id="4")), "del árbol 4"),
        (message("At {place}", place=message("tree {id}", id="el pozo")), "En el árbol el pozo"),
        (message("of {trees}", trees="El Cerro"), "de El Cerro"),
        (say_number(1234567.5), "1.234.568"),
        (say_number(0.25), "0,25"),
        (say_quantity(33.5, "degC"), "33,5 °C"),
        (say_duration(3900.0), "65 min"),
        (listed(["4", "9", "12"]), "4, 9 y 12"),
        (capitalised(say_action("take_thermal_picture")), "Tomar una fotografía térmica"),
        (say_action("read_co2", 3), "leer el CO₂ 3 veces"),
        (say_action("take_soil_core"), "hacer «take a soil core»"),
        (joined(", ", (message("yes"), message("no"))), "sí, no"),
        (shaped(message("north-west"), str.upper), "NOROESTE"),
        (named("no word of any catalogue", "name"), "no word of any catalogue"),
        ("text that is no message", "text that is no message"),
    ],
)
def test_messages_are_said_in_spanish(english: str, spanish: str) -> None:
    assert SPANISH.say(english) == spanish


def test_numbers_have_the_signs_of_the_language() -> None:
    assert SPANISH.say(Number("12,345.6")) == "12.345,6"


def test_an_empty_fill_takes_its_space_with_it() -> None:
    template = "{a} the {b} trees {c}, {d}"
    assert message(template, a="", b="", c="", d="x") == "the trees, x"
    assert message(template, a="1", b="2", c="3", d="4") == "1 the 2 trees 3, 4"


def test_braces_in_names_from_files_are_names() -> None:
    assert SPANISH.say(message("tree {id}", id="{x} {")) == "el árbol {x} {"


def test_a_sentence_from_a_file_is_known_again() -> None:
    said = "'come back' means back to the start."
    assert SPANISH.say(recalled(said, "assumption")) == "«come back» significa volver al inicio."
    far = (
        "The way to the start alone is 1,250 m, a large part of what it may use: the robot stays at its last place."
        " Ask for the return if you want it."
    )
    assert SPANISH.say(recalled(far, "assumption")).startswith("Solo el camino al inicio son 1.250 m,")
    measured = "'the CO2' is measured first (read CO₂), there."
    assert SPANISH.say(recalled(measured, "assumption")) == "«the CO2» se mide primero (leer el CO₂), allí."
    assert SPANISH.say(recalled("Something that a model wrote {.", "assumption")) == "Something that a model wrote {."
    assert ENGLISH.say(recalled(said, "assumption")) == said


def test_reading_a_structure_says_its_messages_and_keeps_the_rest() -> None:
    assert SPANISH.read({"a": (message("once"), 1.5, None), "b": "x"}) == {"a": ("una vez", 1.5, None), "b": "x"}


def test_an_unknown_language_names_those_that_there_are() -> None:
    for code in ("xx", "../es", "", "ES "):
        with pytest.raises(InputError, match="en, es"):
            open_language(code)
    assert list(languages()) == ["en", "es"]


def test_the_language_is_asked_for_else_the_environments_else_english() -> None:
    assert spoken("ES", {}).code == "es"
    assert spoken(None, {"LANG": "es_MX.UTF-8"}).code == "es"
    assert spoken(None, {"LC_ALL": "C", "LANG": "es_ES"}).code == "en"
    assert spoken("en", {"LANG": "es_ES"}).code == "en"
    assert spoken(None, {"LANG": "nn_NO"}).code == "en"
    assert spoken(None, {}).code == "en"


def test_what_is_said_is_text() -> None:
    assert type(ENGLISH.say(message("once"))) is str
    assert not isinstance(SPANISH.say(message("once")), Message)
