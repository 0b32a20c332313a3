"""Each choice of a question says which places it would mean, as far as they differ."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned
from fieldhand.request_check import mismatches
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task.codec import decode, encode

DEMO, HUSKY = open_site("demo"), load_robot("husky")
ROW_3 = {str(DEMO.trees[k].place.id) for k in DEMO.planting.rows[2].trees}


def plan(request: str, *answers: Answer) -> Outcome:
    return EnglishPlanner().plan(request, DEMO, HUSKY, answers)


def ask(request: str) -> Clarify:
    asked = plan(request)
    assert isinstance(asked, Clarify), asked
    return asked


def led(asked: Clarify) -> list[set[str]]:
    return [{place.id for place in places} for places in asked.places]


def test_a_choice_leads_where_its_words_lead() -> None:
    every, one = led(ask("take a picture of row 3"))
    assert every == ROW_3
    assert len(one) == 1
    assert one < every
    assert led(ask("take a picture of tree 5 in row 1"))[1] == {"5"}


def test_only_the_places_that_are_asked_about_are_shown() -> None:
    every, _ = led(ask("Measure CO2 at tree 100. Then take a picture of row 3."))
    assert every == ROW_3


def test_a_place_that_depends_on_where_the_robot_is_by_then_is_walked_to() -> None:
    asked = ask("Drive to tree 50. Then take a picture of 5 trees down the row.")
    one, several = led(asked)
    assert len(one) == 1
    assert len(several) == 5


def test_a_question_without_choices_shows_no_places() -> None:
    asked = ask("take a picture of 5 trees down the row")
    assert asked.choices == ()
    assert asked.places == ()


@pytest.mark.parametrize(
    "request_", ["take a picture of tree 5, and repeat three times", "go 5 trees down and take a picture"]
)
def test_choices_that_do_not_differ_on_the_map_show_nothing(request_: str) -> None:
    assert ask(request_).places == ()


@pytest.mark.parametrize(
    "request_",
    ["take a picture of row 3", "Take a picture at tree 5 or tree 6.", "take a picture of the three yellow trees"],
)
def test_a_plan_is_held_against_what_was_answered_wherever_it_is_kept(request_: str) -> None:
    asked = ask(request_)
    for choice in asked.choices:
        outcome = plan(request_, Answer(question=asked.question, answer=choice))
        assert isinstance(outcome, Planned)
        kept = decode(encode(outcome.task))
        assert kept.command.request == request_
        assert mismatches(kept, DEMO, HUSKY) == ()
