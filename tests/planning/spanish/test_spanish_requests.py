"""Spanish requests: planned with every word, or refused with the words that are not understood."""

from __future__ import annotations

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.language import language_of_request, open_language
from fieldhand.planning.builtin import BuiltinPlanner
from fieldhand.planning.planner import Planned, Refused
from fieldhand.request_check import mismatches
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline
from planning.spanish.requests import PLANNED
from support.requests import english, rows

DEMO = open_site("demo")
HUSKY = load_robot("husky")


@pytest.mark.parametrize(("request_", "plan"), PLANNED)
def test_a_request_is_planned_with_every_word(request_: str, plan: str) -> None:
    outcome = BuiltinPlanner().plan(request_, DEMO, HUSKY)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    assert unaccounted(outcome.task) == ()
    assert mismatches(outcome.task, DEMO, HUSKY) == ()


@pytest.mark.parametrize("word", ["despacio", "mañana", "púrpura", "quizás", "xyzzy", "nunca"])
def test_an_unknown_word_anywhere_ends_it(word: str) -> None:
    for request, _ in PLANNED[::5]:
        words = request.split()
        for k in range(len(words)):
            changed = " ".join([*words[:k], word, *words[k:]])
            assert not isinstance(BuiltinPlanner().plan(changed, DEMO, HUSKY), Planned), changed


def test_english_requests_are_read_as_english() -> None:
    for case in (*english.PLANNED, *rows.PLANNED, *english.ASKED, *rows.ASKED):
        assert language_of_request(case[1]) == "en", case[1]


def test_the_refusal_names_the_words_in_spanish() -> None:
    outcome = BuiltinPlanner().plan("Fotografía el árbol 4 y púlelo", DEMO, HUSKY)
    assert isinstance(outcome, Refused)
    assert outcome.reasons[0].unknown
    assert open_language("es").say(outcome.reasons[0].what) == "no se entiende: «púlelo»"
