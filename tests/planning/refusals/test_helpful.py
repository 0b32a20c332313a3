"""Refusals help: they say what is asked for in vain, what was understood, and suggest a request that can be planned."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fieldhand.planning.auto import AutoPlanner
from fieldhand.planning.english.lexicon import lexicon_for
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.english.tokens import words_of
from fieldhand.planning.english.wishes import wish_kinds, wishes
from fieldhand.planning.planner import Clarify, Outcome, Planned, Refused
from fieldhand.planning.refusals.spelling import likely_meant
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import load_demo
from fieldhand.site.model import Site
from planning.english.vineyards import vineyard

HUSKY, DEMO = load_robot("husky"), load_demo()
#: A wish that no plan can express, and what it is called.
WISHES = [
    ("Photograph the south block every Tuesday by lunchtime.", "a schedule"),
    ("Measure CO2 at vine N100 three times a week.", "a schedule"),
    ("Photograph row 1, then at 5:30 am take pictures of row 2 of the north block.", "the whole mission can begin"),
    ("As soon as the fog lifts, photograph row 1 of the south block.", "the whole mission can begin"),
    ("Wait at the gate until I come back.", "waiting"),
    ("Take pictures of row 7 of the north block and then mow it.", "cannot mow: no action 'mow'"),
    ("Spray sulfur on rows 1 to 6 of the south block.", "cannot spray: no action 'spray'"),
    ("Prune the Syrah vines in row 4 of the south block.", "cannot prune: no action 'prune'"),
    ("Take a soil sample at vine N30.", "no action for"),
    ("Take pictures of the vines as usual.", "an earlier mission"),
    ("Redo the measurements in row 3 of the north block.", "an earlier mission"),
    ("Count how many vines are dead in the north block.", "asks to count"),
    ("Tell me which vines have mildew in row 2 of the south block.", "to recognise something"),
    ("Check whether the drip lines leak in row 8 of the north block.", "to recognise something"),
    ("Compare vine N100 with vine N101.", "to compare readings"),
    ("Measure CO2 at vine N100 and stop when you see a person.", "cannot tell"),
    ("Take a picture of vine N100 unless it rains.", "the weather"),
    ("If the battery gets low go back to the start.", "the battery"),
    ("Follow the tractor through row 5 of the north block.", "to follow or lead"),
    ("Use both robots to photograph the south block.", "several robots"),
    ("Send me the pictures of row 3 of the south block by email.", "a message"),
    ("Measure the humidity at vine N100.", "does not record"),
    ("Take a video of row 2 of the north block.", "cannot film: no action 'film'"),
    ("Photograph N100, then zoom in on the leaves.", "how a picture is taken"),
    ("Fly over the south block and take pictures.", "a flight"),
    ("Never touch the trunks and photograph the Merlot.", "a prohibition"),
    ("Take pictures of unhealthy looking vines in row 5 of the south block.", "does not say this of the trees"),
    ("Take pictures of the Zinfandel vines.", "does not say this of the trees"),
    ("Go to the winery and take a picture.", "is no place"),
]


def plan(request: str, site: Site) -> Outcome:
    return AutoPlanner(EnglishPlanner(), None).plan(request, site, HUSKY)


def refused(request: str, site: Site) -> Refused:
    outcome = plan(request, site)
    assert isinstance(outcome, Refused), outcome
    return outcome


@pytest.mark.parametrize(("request_", "kind"), WISHES, ids=lambda v: str(v)[:50])
def test_a_wish_is_called_what_it_is_and_something_possible_is_suggested(request_: str, kind: str) -> None:
    outcome = refused(request_, vineyard())
    assert any(kind in reason.what for reason in outcome.reasons)
    assert not any(reason.unknown for reason in outcome.reasons)
    assert not any("FIELDHAND_MODEL" in reason.advice for reason in outcome.reasons)
    assert isinstance(plan(outcome.example, vineyard()), Planned)


@pytest.mark.parametrize(
    "request_",
    [
        "Do the usual round.",
        "Frobnicate tree 4.",
        "Take a picture of tree 4 with 3 blorbs.",
        "Water tree 5 and measure CO2 there.",
        "trees",
        "Take a picture of tree 512.",
        "Take a picture of row 44.",
        "Fertilize the youngest trees.",
        "Compare tree 4 with tree 5.",
        "Take me to tree 9.",
    ],
)
def test_what_is_suggested_can_be_planned_on_the_site(request_: str) -> None:
    outcome = refused(request_, DEMO)
    suggested = plan(outcome.example, DEMO)
    assert isinstance(suggested, Planned)
    assert not suggested.task.command.warnings


def test_what_was_understood_is_said_in_the_words_of_the_read_back_and_suggested() -> None:
    outcome = refused("Sometimes take pictures of row 5 of the north block.", vineyard())
    assert outcome.understood == ("At each of the trees of row 5 of block North: take a thermal picture.",)
    assert outcome.example == "Take pictures of row 5 of the north block."
    several = refused("Water tree 5 and measure CO2 there.", DEMO)
    assert several.understood == ("tree 5", "read CO₂")
    assert several.example == "Measure CO2 at tree 5."


def test_the_example_does_not_do_what_was_forbidden() -> None:
    outcome = refused("Take pictures of 5 vines. Never touch the trunks of row 10.", vineyard())
    assert outcome.example == "Take pictures of 5 vines."


def test_a_model_is_named_only_where_it_could_help() -> None:
    assert any("FIELDHAND_MODEL" in reason.advice for reason in refused("Frobnicate tree 4.", DEMO).reasons)
    for request in ("Take a picture of tree 512.", "Measure soil moisture at tree 4.", "row 3", "Spray tree 4."):
        assert not any("FIELDHAND_MODEL" in reason.advice for reason in refused(request, DEMO).reasons), request


@pytest.mark.parametrize("word", ["Scout", "you", "rest", "missing", "count", "grass", "rains", "frost", "barn", "how"])
def test_a_word_of_its_own_is_no_misspelling(word: str) -> None:
    assert likely_meant(word, lexicon_for(HUSKY, DEMO)) == ""


def test_a_misspelling_is_suggested_where_the_request_is_then_understood() -> None:
    outcome = refused("Measure C02 at tree 5.", DEMO)
    assert "did you mean 'CO2'" in outcome.reasons[0].advice or "did you mean 'co2'" in outcome.reasons[0].advice
    assert outcome.example == "Measure CO2 at tree 5."


def test_a_robot_that_has_the_tool_is_not_told_that_it_lacks_it() -> None:
    mowing = replace(HUSKY.actions[0], name="mow_grass", words=("mowing",), verbs=("mow",), measures=())
    mower = replace(HUSKY, actions=(*HUSKY.actions, mowing))
    words = words_of("Mow tree 4.")
    assert wishes(words, lexicon_for(HUSKY, DEMO))
    assert not wishes(words, lexicon_for(mower, DEMO))


def test_a_block_that_the_site_does_not_have_is_no_part_of_the_site() -> None:
    outcome = refused("Take a picture of every vine in the east block.", vineyard())
    assert outcome.reasons[0].what == "there is no block 'east'"
    assert isinstance(plan(outcome.example, vineyard()), Planned)


def test_a_vague_number_is_asked_for_and_no_question_has_impossible_answers_only() -> None:
    asked = plan("Take pictures of a few vines in the north block.", vineyard())
    assert isinstance(asked, Clarify)
    assert [number for choice in asked.choices for number in ("3", "5", "10") if f" {number} " in choice] == [
        "3",
        "5",
        "10",
    ]
    assert refused("Take a picture of row 44.", DEMO).reasons[0].what == "there is no row '44'"


def test_each_kind_of_wish_says_what_it_is_and_what_to_do() -> None:
    for kind in wish_kinds():
        assert "{said}" in kind.what
        assert kind.advice
        assert ("{offers}" in kind.advice) == bool(kind.offers)
