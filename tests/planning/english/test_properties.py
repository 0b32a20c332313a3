"""Whatever is typed: an outcome or a RequestError, and no word dropped in silence."""

from __future__ import annotations

import contextlib

from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import RequestError
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.english.vocabulary import vocabulary
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task.codec import encode
from fieldhand.task.references import references
from fieldhand.task.request_coverage import request_pieces
from fieldhand.task.schema import validate
from support.examples import examples
from support.requests import rows as row_requests
from support.requests.english import PLANNED

SITE, HUSKY = open_site("demo"), load_robot("husky")
CAPABILITIES = capabilities_of(HUSKY)
TABLES = ("verbs", "nouns", "words", "sides", "levels")
WORDS = sorted({w for table in TABLES for phrases in vocabulary()[table].values() for w in phrases})
MORE = ["picture", "CO2 reading", "tree 4", "5", "33 °C", "400 ppm", "yellow", "wet corner", ",", ".", "and", "below"]
MORE += ["row 3", "rows 2 to 5", "every third", "last", "2nd", "trees down", "15 m", "every 10 m", "apart", "of", "in"]


def try_to_plan(request: str) -> None:
    with contextlib.suppress(RequestError):
        outcome = EnglishPlanner().plan(request, SITE, HUSKY)
        assert isinstance(outcome, Planned | Clarify | Refused)
        if isinstance(outcome, Planned):
            assert references(outcome.task, CAPABILITIES) == ()
            assert validate(encode(outcome.task), CAPABILITIES) == ()


@settings(max_examples=examples(50, thorough=150), deadline=None)
@given(st.lists(st.sampled_from(WORDS + MORE * 20), min_size=1, max_size=14))
def test_known_words_in_any_order_never_break_it(words: list[str]) -> None:
    try_to_plan(" ".join(words))


@settings(max_examples=examples(30, thorough=80), deadline=None)
@given(st.text(max_size=60))
def test_any_text_never_breaks_it(text: str) -> None:
    try_to_plan(text)


@settings(max_examples=examples(40, thorough=100), deadline=None)
@given(st.sampled_from(PLANNED + row_requests.PLANNED), st.data())
def test_a_request_with_a_word_left_out_or_doubled_never_breaks_it(
    case: tuple[str, str, str], data: st.DataObject
) -> None:
    words = case[1].split()
    at = data.draw(st.integers(0, len(words) - 1))
    try_to_plan(" ".join(words[:at] + words[at + 1 :]))
    try_to_plan(" ".join([*words[:at], words[at], *words[at:]]))


@settings(max_examples=examples(60, thorough=150), deadline=None)
@given(st.sampled_from(PLANNED + row_requests.PLANNED), st.data())
def test_every_word_of_a_planned_request_has_a_part_in_it_or_is_reported(
    case: tuple[str, str, str], data: st.DataObject
) -> None:
    words = case[1].split()
    at, word = data.draw(st.integers(0, len(words))), data.draw(st.sampled_from(WORDS + MORE * 20))
    with contextlib.suppress(RequestError):
        outcome = EnglishPlanner(suggests=False).plan(" ".join([*words[:at], word, *words[at:]]), SITE, HUSKY)
        if isinstance(outcome, Planned):
            reported = " ".join((*outcome.task.command.assumptions, *outcome.task.command.warnings))
            left = [piece.text for piece in request_pieces(outcome.task) if piece.role == "nothing"]
            assert not [text for text in left if text not in reported]


def test_a_word_that_is_not_known_is_named() -> None:
    outcome = EnglishPlanner().plan("take a picture of tree 4 with 3 frobnicators", SITE, HUSKY)
    assert isinstance(outcome, Refused)
    assert "'frobnicators'" in outcome.reasons[0].what
    assert outcome.reasons[0].said == ((32, 44),)
