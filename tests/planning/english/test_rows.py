"""Requests about rows: on the demo orchard, and where blocks, names, directions or the want of rows matter."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Refused
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task.codec import decode, encode
from fieldhand.task.references import references
from fieldhand.task.schema import validate
from planning.english.outlines import outline
from support.requests.planned import outcome_of, site_of
from support.requests.rows import ASKED, ELSEWHERE, PLANNED, REFUSED

DEMO = open_site("demo")
ROBOTS = {name: load_robot(name) for name in ("husky", "amiga")}
BLOCKS = site_of("blocks")


def said(outcome: Outcome) -> str:
    match outcome:
        case Planned(task=task):
            return outline(task)
        case Clarify(question=question):
            return f"asks {question}"
        case Refused(reasons=reasons):
            return f"refuses {reasons[0].what}"


@pytest.mark.parametrize(("robot", "request_", "plan"), PLANNED, ids=lambda v: str(v)[:60])
def test_a_request_about_rows_becomes_this_plan_and_a_whole_task(robot: str, request_: str, plan: str) -> None:
    outcome = outcome_of(robot, request_)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    capabilities = capabilities_of(ROBOTS[robot])
    document = encode(outcome.task)
    assert references(outcome.task, capabilities) == ()
    assert validate(document, capabilities) == ()
    assert decode(document) == outcome.task


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("row 3", "every other tree"),
        ("the third row from the east", "every fifth tree"),
        ("every third tree", "rows 2 to 5"),
        ("the wet corner", "yellow trees"),
    ],
)
def test_an_area_and_trees_with_a_comma_alone_between_them_are_the_trees_there(first: str, second: str) -> None:
    outcome = EnglishPlanner().plan(f"take a picture of {first}, {second}", DEMO, ROBOTS["husky"])
    assert isinstance(outcome, Planned)
    inner, area = (second, first) if "tree" in second else (first, second)
    whole = EnglishPlanner().plan(f"take a picture of {inner} of {area}", DEMO, ROBOTS["husky"])
    assert said(outcome) == said(whole)


@pytest.mark.parametrize(("robot", "request_", "question"), ASKED, ids=lambda v: str(v)[:60])
def test_what_may_mean_two_things_along_rows_is_asked(robot: str, request_: str, question: str) -> None:
    assert said(outcome_of(robot, request_)) == f"asks {question}"


@pytest.mark.parametrize(("robot", "request_", "why"), REFUSED, ids=lambda v: str(v)[:60])
def test_what_cannot_be_said_of_rows_is_refused_with_its_reason(robot: str, request_: str, why: str) -> None:
    assert said(outcome_of(robot, request_)) == f"refuses {why}"


@pytest.mark.parametrize(("site", "request_", "expected"), ELSEWHERE, ids=lambda v: str(v)[:60])
def test_blocks_names_and_the_way_of_the_rows_matter(site: str, request_: str, expected: str) -> None:
    found = said(outcome_of("husky", request_, site))
    assert found.startswith(expected) if expected.startswith("refuses") else found == expected


def test_a_row_in_several_blocks_is_asked_with_the_blocks_to_choose_from() -> None:
    outcome = EnglishPlanner().plan("take pictures of row 3", BLOCKS, ROBOTS["husky"])
    assert isinstance(outcome, Clarify)
    assert [choice.partition(":")[0] for choice in outcome.choices] == [
        "At each of the trees of row 3 of block A",
        "At each of the trees of row 3 of block B",
    ]
    for choice, block in zip(outcome.choices, "AB", strict=True):
        answer = Answer(question=outcome.question, answer=choice)
        answered = EnglishPlanner().plan("take pictures of row 3", BLOCKS, ROBOTS["husky"], (answer,))
        assert isinstance(answered, Planned)
        assert said(answered) == f"for Rows(3, 3, of InBlock({block})): [picture]"


def test_an_assumption_says_which_way_is_counted() -> None:
    outcome = EnglishPlanner().plan(
        "take a picture of tree 20, go to the next row and take another", DEMO, ROBOTS["husky"]
    )
    assert isinstance(outcome, Planned)
    assert "'go to the next row' is counted towards higher row numbers (east)." in outcome.task.command.assumptions


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        (
            "take a picture of the oldest tree in each block",
            "UnionOf(Top(age, 1, of InBlock(A))+Top(age, 1, of InBlock(B)))",
        ),
        ("take pictures of 3 trees per block", "Quota(block, 3)"),
        ("take pictures at each corner of both blocks", "UnionOf(Corners(of InBlock(A))+Corners(of InBlock(B)))"),
        ("take pictures of every third row of each block", "UnionOf(Rows(3, of InBlock(A))+Rows(3, of InBlock(B)))"),
        ("in each block, take a picture of two trees", "Quota(block, 2)"),
        ("take pictures of all blocks", "UnionOf(InBlock(A)+InBlock(B))"),
    ],
)
def test_what_is_said_of_each_block_is_done_in_each(request_: str, plan: str) -> None:
    assert said(EnglishPlanner().plan(request_, BLOCKS, ROBOTS["husky"])) == f"for {plan}: [picture]"
