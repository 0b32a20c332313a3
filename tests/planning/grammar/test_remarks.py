"""Remarks ask for nothing and are left out; what asks for something never is."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.planning.grammar.english import ENGLISH
from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.grammar.remarks import without_remarks
from fieldhand.planning.grammar.words import edges_of
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

ROBOT = load_robot("husky")
COMMAND = "take a picture of tree 4"
REMARKS = (
    "We had a leak last week.",
    "My grandfather planted this orchard.",
    "For the irrigation report,",
    "The almonds looked gloomy yesterday.",
)
REASONS = (
    ", so we can check for water stress",
    " because the foreman insists",
    " for the lab",
    " since we promised it",
)


def left(request: str) -> str:
    """The words of a request without its remarks."""
    words = ENGLISH.words_of(request)
    phrases = ENGLISH.phrases(ROBOT, open_site("demo"))
    return " ".join(word.text for word in without_remarks(words, edges_of(words, phrases)).words)


@pytest.mark.parametrize("remark", REMARKS)
def test_a_remark_before_the_command_changes_nothing_but_is_said(remark: str) -> None:
    plain = composed(COMMAND, open_site("demo"), ROBOT)
    remarked = composed(f"{remark} {COMMAND}", open_site("demo"), ROBOT)
    assert isinstance(plain, Planned)
    assert isinstance(remarked, Planned)
    assert outline(remarked.task) == outline(plain.task)
    assert any("taken as a remark" in one for one in remarked.task.command.assumptions)


@pytest.mark.parametrize("reason", REASONS)
def test_a_reason_behind_the_command_changes_nothing_but_is_said(reason: str) -> None:
    remarked = composed(COMMAND + reason, open_site("demo"), ROBOT)
    assert isinstance(remarked, Planned)
    assert outline(remarked.task) == "picture @ TreeIs(4)"
    assert any("taken as a remark" in one for one in remarked.task.command.assumptions)


@pytest.mark.parametrize(
    "request_",
    [
        "We need a picture of tree 9.",
        "The robot zigzags home.",
        "I want you to flambé row 3.",
        "They said to skip row 4.",
        "take a picture of tree 4 because row 3 is wilting",
    ],
)
def test_what_names_places_or_actions_is_no_remark(request_: str) -> None:
    assert "tree" not in request_ or "tree" in left(request_)
    assert "row" not in request_ or "row" in left(request_)
    assert "robot" not in request_ or "robot" in left(request_)


@given(
    st.lists(st.sampled_from([*REMARKS, COMMAND + ".", "We are wondering,", "for the lab", ",", "row 3"]), max_size=6)
)
def test_only_words_of_the_request_are_left_and_in_their_order(parts: list[str]) -> None:
    request = " ".join(parts)
    words = [word.text for word in ENGLISH.words_of(request)]
    rest = left(request).split()
    position = 0
    for word in rest:
        position = words.index(word, position) + 1
    assert bool(rest) == bool(words)
