"""What can be planned in several ways is asked, and each answer leads to the plan that it tells."""

from __future__ import annotations

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.planning.builtin import BuiltinPlanner
from fieldhand.planning.planner import Answer, Clarify, Planned, Refused
from fieldhand.request_check import mismatches
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.wording.steps import write_lines
from planning.english.outlines import outline
from support.requests import english, rows

SITE, HUSKY = open_site("demo"), load_robot("husky")
ASKED = [case[1] for case in (*english.ASKED, *rows.ASKED) if case[0] == "husky"]


def asked(request: str, *answers: Answer) -> Clarify:
    outcome = BuiltinPlanner().plan(request, SITE, HUSKY, answers)
    assert isinstance(outcome, Clarify), outcome
    return outcome


@pytest.mark.parametrize("request_", ASKED, ids=lambda text: str(text)[:50])
def test_each_answer_is_the_read_back_of_a_plan_that_says_all_of_the_request(request_: str) -> None:
    question = asked(request_)
    plans = []
    for choice in question.choices:
        answers = (Answer(question=question.question, answer=choice),)
        outcome = BuiltinPlanner().plan(request_, SITE, HUSKY, answers)
        if isinstance(outcome, Clarify):
            assert outcome.question != question.question
        elif isinstance(outcome, Planned):
            assert unaccounted(outcome.task) == ()
            assert mismatches(outcome.task, SITE, HUSKY) == ()
            assert any(choice in text for text in outcome.task.command.assumptions)
            plans.append(outline(outcome.task))
        else:  # the rules ask, and only the person can say where the answer's words stand
            assert not question.question.endswith("which is meant?")
    assert len(set(plans)) == len(plans)


@pytest.mark.parametrize(
    ("request_", "plans"),
    [
        ("Toma una foto de la fila 3.", {"for Rows(3, 3): [picture]", "picture @ Take(1, of Rows(3, 3))"}),
        ("Photograph tree 4 or 9.", {"picture @ TreeIs(4)", "picture @ TreeIs(9)"}),
        ("test tree 4", {"picture @ TreeIs(4)", "air @ TreeIs(4)", "co2 @ TreeIs(4)"}),
        (
            "Take a picture of tree 4, if the battery allows, and measure CO2 at tree 5.",
            {"maybe [picture @ TreeIs(4)]; co2 @ TreeIs(5)", "picture @ TreeIs(4); maybe [co2 @ TreeIs(5)]"},
        ),
        (
            "Take 6 CO2 readings at the trees 4, 5 and 6.",
            {f"for UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)): [co2 x{count}]" for count in (6, 2)},
        ),
        (
            "Go to row 6. Photograph every second tree.",
            {"for EveryNth(2, of Rows(6, 6)): [picture]", "go Take(1, of Rows(6, 6)); for EveryNth(2): [picture]"},
        ),
    ],
)
def test_the_answers_are_the_plans_that_differ(request_: str, plans: set[str]) -> None:
    question = asked(request_)
    found = set()
    for choice in question.choices:
        outcome = BuiltinPlanner().plan(
            request_, SITE, HUSKY, (Answer(question=question.question, answer=choice.upper()),)
        )
        assert isinstance(outcome, Planned)
        found.add(outline(outcome.task).removesuffix(" | stay"))
        lines = " ".join(line.text for line in write_lines(outcome.task, SITE, HUSKY, {}))
        assert choice in lines
    assert found == plans


def test_a_place_that_only_one_reading_can_mean_is_not_asked_about() -> None:
    outcome = BuiltinPlanner().plan("take a picture of tree 40 in row 3", SITE, HUSKY)
    assert isinstance(outcome, Planned)
    assert outline(outcome.task) == "picture @ TreeIs(40)"


def test_an_answer_that_is_none_of_the_choices_is_refused_with_them() -> None:
    question = asked("take a picture of row 3")
    outcome = BuiltinPlanner().plan(
        "take a picture of row 3", SITE, HUSKY, (Answer(question=question.question, answer="some"),)
    )
    assert isinstance(outcome, Refused)
    assert all(choice in outcome.reasons[0].advice for choice in question.choices)


def test_two_draws_at_random_have_seeds_of_their_own() -> None:
    outcome = BuiltinPlanner().plan("Photograph 4 random trees. Measure CO2 at 4 random trees.", SITE, HUSKY)
    assert isinstance(outcome, Planned)
    assert outline(outcome.task) == "for RandomSample(4): [picture]; for RandomSample(4, 1): [co2]"


@pytest.mark.parametrize(
    ("answer", "plan"),
    [
        ("north-west", "picture @ Corners(nw)"),
        ("SOUTH-EAST corner", "picture @ Corners(se)"),
        ("corner", None),
        ("", None),
    ],
)
def test_words_that_only_one_choice_contains_are_an_answer(answer: str, plan: str | None) -> None:
    request = "Take a picture at the corner."
    given = Answer(question=asked(request).question, answer=answer)
    outcome = BuiltinPlanner().plan(request, SITE, HUSKY, (given,))
    assert isinstance(outcome, Refused if plan is None else Planned)
    assert plan is None or (isinstance(outcome, Planned) and outline(outcome.task) == plan)
