"""Spanish requests: planned with every word, or refused with the words that are not understood."""

# ruff: noqa: E501 - requests stand on one line each

from __future__ import annotations

from dataclasses import replace

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.language import language_of_request, open_language
from fieldhand.planning.builtin import BuiltinPlanner
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.request_check import mismatches
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline
from planning.spanish.requests import EARLIER, EXPERIMENTS, NOT_PLANNED, PLANNED
from support.requests import english, orchards, rows
from support.requests.inserted import with_word

DEMO = open_site("demo")
UNKNOWN = ("despacio", "mañana", "púrpura", "quizás", "xyzzy", "nunca")
HUSKY, AMIGA = load_robot("husky"), load_robot("amiga")


@pytest.mark.parametrize(("request_", "plan"), [*PLANNED, *EARLIER])
def test_a_request_is_planned_with_every_word(request_: str, plan: str) -> None:
    outcome = BuiltinPlanner().plan(request_, DEMO, HUSKY)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    assert unaccounted(outcome.task) == ()
    assert mismatches(outcome.task, DEMO, HUSKY) == ()


@pytest.mark.parametrize(("name", "request_", "plan"), EXPERIMENTS)
def test_the_requests_of_the_published_experiments_are_planned_as_the_english_ones(
    name: str, request_: str, plan: str
) -> None:
    robot = AMIGA if name in ("moisture-15m", "nitrate-east") else HUSKY
    site = orchards.rewarded() if name == "reward" else DEMO
    outcome = BuiltinPlanner().plan(request_, site, robot)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    assert unaccounted(outcome.task) == ()
    assert mismatches(outcome.task, site, robot) == ()


@pytest.mark.parametrize("request_", NOT_PLANNED)
def test_what_is_open_or_not_possible_is_asked_or_refused(request_: str) -> None:
    assert isinstance(BuiltinPlanner().plan(request_, DEMO, HUSKY), Clarify | Refused)


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("Toma dos fotos del árbol 4.", "Toma una foto del árbol 4."),
        ("Fotografía los árboles de la fila 3.", "Fotografía los árboles de la fila 5."),
        ("Fotografía la esquina noreste.", "Fotografía la esquina suroeste."),
        ("Mide el CO2 en el árbol 4. Si es menor de 400 ppm, toma una foto.", "Mide el CO2 en el árbol 4. Si es mayor de 400 ppm, toma una foto."),
        ("Fotografía los árboles amarillos.", "Fotografía los árboles verdes."),
        ("Mide el CO2 en el árbol 4.", "Toma una foto del árbol 4."),
        ("Fotografía las esquinas sin recorrer más de 300 metros.", "Fotografía las esquinas sin recorrer más de 800 metros."),
        ("Fotografía el árbol 4 y vuelve al inicio.", "Fotografía el árbol 4 y vuelve al final."),
    ],
)  # fmt: skip
def test_a_plan_of_another_spanish_request_contradicts_it(wrong: str, right: str) -> None:
    outcome = BuiltinPlanner().plan(right, DEMO, HUSKY)
    assert isinstance(outcome, Planned), outcome
    command = replace(outcome.task.command, request=wrong)
    assert mismatches(replace(outcome.task, command=command), DEMO, HUSKY) != ()


@pytest.mark.parametrize("word", UNKNOWN)
def test_an_unknown_word_anywhere_ends_it(word: str) -> None:
    """At each position of each request one of the words, in turn; each of them with the thorough profile."""
    for changed in with_word(word, UNKNOWN, [request for request, _ in PLANNED[::5]]):
        assert not isinstance(BuiltinPlanner().plan(changed, DEMO, HUSKY), Planned), changed


def test_english_requests_are_read_as_english() -> None:
    for case in (*english.PLANNED, *rows.PLANNED, *english.ASKED, *rows.ASKED):
        assert language_of_request(case[1]) == "en", case[1]


def test_the_refusal_names_the_words_in_spanish() -> None:
    outcome = BuiltinPlanner().plan("Fotografía el árbol 4 y púlelo", DEMO, HUSKY)
    assert isinstance(outcome, Refused)
    assert outcome.reasons[0].unknown
    assert open_language("es").say(outcome.reasons[0].what) == "no se entiende: «púlelo»"
