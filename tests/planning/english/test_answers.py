"""An answer stands in place of the words that were asked about; the Task keeps the request as it was typed."""

from __future__ import annotations

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task.plan import Act, ForEach, walk
from planning.english.outlines import outline

SITE, HUSKY = open_site("demo"), load_robot("husky")

ANSWERED = [
    ("take a picture of the northern half", ("each of the trees in the northern half",), "for Half(north): [picture]"),
    ("take a picture of rows 2-4", ("nearest of the trees of rows 2 to 4",), "picture @ Take(1, of Rows(2, 4))"),
    (
        "Take a picture at the corner of row 3.",
        ("the last tree",),
        "picture @ InRow(-1, -1, of Rows(3, 3))",
    ),
    ("take 2 pictures at the corners", ("2 thermal pictures",), "for Corners: [picture x2]"),
    ("take 2 pictures at the corners", ("each of the 2 nearest",), "for Take(2, of Corners): [picture]"),
    (
        "take a picture of the three yellow trees",
        ("3 nearest",),
        "for Take(3, of Where(leaf_color, eq, yellow)): [picture]",
    ),
    (
        "take a picture of tree 5, and repeat three times",
        ("At tree 5: take a thermal picture. Do this 3 times: At tree 5: take a thermal picture.",),
        "picture @ TreeIs(5); 3 times: [picture @ TreeIs(5)]",
    ),
    (
        "take a picture of tree 5, and repeat three times",
        ("Do this 3 times: At tree 5: take a thermal picture.",),
        "3 times: [picture @ TreeIs(5)]",
    ),
    ("take a picture of tree 5 in row 1", ("At tree 5:",), "picture @ TreeIs(5)"),
    ("take a picture at either end of row 3", ("At tree 1",), "picture @ InRow(1, 1, of Rows(3, 3))"),
    ("measure tree 4", ("CO₂",), "co2 @ TreeIs(4)"),
    (
        "take a picture of row 3, then of row 4",
        ("each of the trees of row 4",),
        "for Rows(3, 3): [picture]; for Rows(4, 4): [picture]",
    ),
]


def answered(request: str, *said: str) -> Outcome:
    """Return what comes of a request when its questions are answered by the choices that contain some words."""
    answers: tuple[Answer, ...] = ()
    for answer in said:
        outcome = EnglishPlanner().plan(request, SITE, HUSKY, answers)
        assert isinstance(outcome, Clarify), outcome
        held = [choice for choice in outcome.choices if answer in choice]
        chosen = answer if answer in held or not held else held[0]
        answers = (*answers, Answer(question=outcome.question, answer=chosen))
    return EnglishPlanner().plan(request, SITE, HUSKY, answers)


@pytest.mark.parametrize(("request_", "said", "plan"), ANSWERED, ids=lambda v: str(v)[:40])
def test_an_answer_makes_the_plan_and_the_words_stay_those_that_were_typed(
    request_: str, said: tuple[str, ...], plan: str | None
) -> None:
    planned = answered(request_, *said)
    assert isinstance(planned, Planned), planned
    assert plan is None or outline(planned.task) == plan
    assert planned.task.command.request == request_
    assert all(answer in text for text, answer in zip(_asked(planned), said, strict=True))
    for node in walk(planned.task.composition.plan):
        assert all(0 <= start < end <= len(request_) for start, end in node.said)
    assert unaccounted(planned.task) == ()


def _asked(planned: Planned) -> list[str]:
    return [text for text in planned.task.command.assumptions if text.startswith("Asked: ")]


def test_ranges_behind_an_answer_are_those_of_the_typed_words() -> None:
    request = "take a picture of row 3, then measure CO2 at tree 9"
    planned = answered(request, "each of the trees")
    assert isinstance(planned, Planned)
    loop, _, co2 = [node for node in walk(planned.task.composition.plan) if isinstance(node, ForEach | Act)]
    assert [request[a:b] for a, b in loop.said] == ["row 3"]
    assert [request[a:b] for a, b in (*co2.said, *co2.at_said)] == ["measure CO2 at", "tree 9"]


def test_an_answer_that_is_no_choice_is_refused_with_the_choices() -> None:
    refused = answered("take a picture of row 3", "perhaps")
    assert isinstance(refused, Refused)
    (reason,) = refused.reasons
    assert reason.what.startswith("'perhaps' does not answer")
    assert "'At each of the trees of row 3: take a thermal picture.'" in reason.advice


def test_a_question_without_choices_is_answered_by_another_request() -> None:
    request = "If the battery allows, go to tree 5. Take a picture there."
    asked = EnglishPlanner().plan(request, SITE, HUSKY)
    assert isinstance(asked, Clarify)
    assert asked.choices == ()
    again = EnglishPlanner().plan(request, SITE, HUSKY, (Answer(question=asked.question, answer="at tree 4"),))
    assert again == asked


def test_an_answer_to_another_question_changes_nothing() -> None:
    other = Answer(question="Which way?", answer="up")
    asked = EnglishPlanner().plan("take a picture of row 3", SITE, HUSKY, (other,))
    assert isinstance(asked, Clarify)
    assert not asked.free
