"""An answer stands in place of the words that were asked about; the Task keeps the request as it was typed."""

from __future__ import annotations

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.english.rewording import Worded
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task.plan import Act, ForEach, walk
from planning.english.outlines import outline

SITE, HUSKY = open_site("demo"), load_robot("husky")

ANSWERED = [
    ("take a picture of the northern half", ("at every tree",), "for Half(north): [picture]"),
    ("take a picture of rows 2-4", ("at 4 trees",), "for Take(4, of Rows(2, 4)): [picture]"),
    (
        "Take a picture at the corner of row 3.",
        ("south-west",),
        "picture @ Corners(sw, of Rows(3, 3))",
    ),
    ("take 2 pictures at the corners", ("2 at each of them",), "for Corners: [picture x2]"),
    ("take 2 pictures at the corners", ("2 in all",), "for Take(2, of Corners): [picture]"),
    (
        "take a picture of the three yellow trees",
        ("any 3 of them",),
        "for Take(3, of Where(leaf_color, eq, yellow)): [picture]",
    ),
    ("take a picture of tree 5, and repeat three times", ("3 more times",), None),
    ("take a picture of tree 5 in row 1", ("the tree with id 5",), "picture @ TreeIs(5)"),
    ("take a picture at either end of row 3", ("the northern one",), "picture @ InRow(1, 1, north, of Rows(3, 3))"),
    ("measure tree 4", ("co2 reading",), "co2 @ TreeIs(4)"),
    (
        "take a picture of row 3, then of row 4",
        ("at every tree", "at 4 trees"),
        "for Rows(3, 3): [picture]; for Take(4, of Rows(4, 4)): [picture]",
    ),
]


def answered(request: str, *said: str) -> Outcome:
    """What comes of a request when its questions are answered one after the other."""
    answers: tuple[Answer, ...] = ()
    for answer in said:
        outcome = EnglishPlanner().plan(request, SITE, HUSKY, answers)
        assert isinstance(outcome, Clarify), outcome
        answers = (*answers, Answer(question=outcome.question, answer=answer))
    return EnglishPlanner().plan(request, SITE, HUSKY, answers)


@pytest.mark.parametrize(("request_", "said", "plan"), ANSWERED, ids=lambda v: str(v)[:40])
def test_an_answer_makes_the_plan_and_the_words_stay_those_that_were_typed(
    request_: str, said: tuple[str, ...], plan: str | None
) -> None:
    planned = answered(request_, *said)
    assert isinstance(planned, Planned), planned
    assert plan is None or outline(planned.task) == plan
    assert planned.task.command.request == request_
    assert [text.endswith(f'"{answer}".') for text, answer in zip(_asked(planned), said, strict=True)] == [
        True for _ in said
    ]
    for node in walk(planned.task.composition.plan):
        assert all(0 <= start < end <= len(request_) for start, end in node.said)
    assert unaccounted(planned.task) == ()


def _asked(planned: Planned) -> list[str]:
    return [text for text in planned.task.command.assumptions if text.startswith("Asked: ")]


def test_ranges_behind_an_answer_are_those_of_the_typed_words() -> None:
    request = "take a picture of row 3, then measure CO2 at tree 9"
    planned = answered(request, "at every tree")
    assert isinstance(planned, Planned)
    loop, _, co2 = [node for node in walk(planned.task.composition.plan) if isinstance(node, ForEach | Act)]
    assert [request[a:b] for a, b in loop.said] == ["of row 3"]
    assert [request[a:b] for a, b in co2.said] == ["measure CO2 at tree 9"]


def test_a_range_of_the_new_words_is_the_whole_of_what_they_replaced() -> None:
    worded = Worded.typed("abc the corner xyz").with_words((8, 14), "north-west corner")
    assert worded.text == "abc the north-west corner xyz"
    assert worded.spans([(8, 18), (26, 29), (0, 3)]) == ((8, 14), (15, 18), (0, 3))
    assert worded.with_words((29, 29), " again").spans([(29, 35)]) == ()


def test_an_answer_that_is_no_choice_is_refused_with_the_choices() -> None:
    refused = answered("take a picture of row 3", "perhaps")
    assert isinstance(refused, Refused)
    (reason,) = refused.reasons
    assert reason.what.startswith("'perhaps' does not answer")
    assert reason.advice == "choose: 'at every tree', 'at 4 trees'"


def test_a_choice_whose_place_in_the_request_is_not_known_is_refused_with_what_to_do() -> None:
    refused = answered("If the battery allows, go to tree 5. Take a picture there.", "at a tree that you name")
    assert isinstance(refused, Refused)
    assert refused.reasons[0].advice == "write it there, and plan again"


def test_an_answer_to_another_question_changes_nothing() -> None:
    other = Answer(question="Which way?", answer="up")
    asked = EnglishPlanner().plan("take a picture of row 3", SITE, HUSKY, (other,))
    assert isinstance(asked, Clarify)
    assert not asked.free
