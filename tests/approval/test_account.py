"""Each word of a request with what it became, and a warning about what became nothing."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.approval.checks import check
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task.frames import Budget, Command, Composition, Constraints, Task
from fieldhand.task.plan import Act, If, InOrder, Node, OptionalStep, StopMission, walk
from fieldhand.task.request_coverage import Piece, request_pieces

SITE, HUSKY = open_site("demo"), load_robot("husky")
REQUEST = (
    "Please take a picture of tree 4, then, if it is below 33 °C, measure CO2 there, within 20 minutes, with at least"
    " 30 % battery left. Come back to the start."
)


def planned(request: str) -> Task:
    outcome = EnglishPlanner().plan(request, SITE, HUSKY)
    assert isinstance(outcome, Planned)
    return outcome.task


def bare(node: Node) -> Node:
    """A plan of which nothing says from which words it came."""
    match node:
        case InOrder():
            return replace(node, said=(), steps=tuple(bare(step) for step in node.steps))
        case If():
            return replace(node, said=(), then=bare(node.then))
        case Act():
            return replace(node, said=(), at_said=())
        case _:
            return replace(node, said=())


def test_each_word_has_what_it_became_and_the_pieces_are_the_request() -> None:
    pieces = request_pieces(planned(REQUEST))
    assert "".join(piece.text for piece in pieces) == REQUEST
    assert [(p.role, p.text) for p in pieces if p.role != "between"] == [
        ("no_part", "Please"),
        ("action", "take a picture"),
        ("place", "tree 4"),
        ("condition", "if it is below 33 °C"),
        ("action", "measure CO2"),
        ("limit", "within 20 minutes"),
        ("limit", "least 30 % battery left"),
        ("end", "Come back to the start"),
    ]


def test_a_unit_with_a_stroke_stays_together() -> None:
    request = "spray rows 3 to 8 at 250 l/ha"
    outcome = EnglishPlanner().plan(request, SITE, load_robot("tractor"))
    assert isinstance(outcome, Planned)
    assert [(p.role, p.text) for p in request_pieces(outcome.task)] == [("action", request)]


def test_a_step_that_is_gone_from_the_plan_leaves_a_warning_that_quotes_its_words() -> None:
    task = planned("Take a picture of tree 4. If it is below 33 °C, measure CO2 at tree 5.")
    (sequence,) = [node for node in walk(task.composition.plan) if isinstance(node, InOrder)]
    cut = replace(task, composition=replace(task.composition, plan=replace(sequence, steps=sequence.steps[:1])))
    (problem,) = unaccounted(cut)
    assert problem.severity == "warning"
    assert problem.where == "request"
    assert problem.what == "nothing in the plan corresponds to 'If it is below 33 °C', 'measure CO2 at tree 5'"
    assert unaccounted(task) == ()


def test_a_budget_that_is_gone_leaves_a_warning_too() -> None:
    task = planned("Take a picture of tree 4 within 20 minutes.")
    (problem,) = unaccounted(replace(task, constraints=Constraints()))
    assert "'within 20 minutes'" in problem.what


@pytest.mark.parametrize("word", ["not", "except", "only", "if", "unless", "without"])
def test_no_word_that_turns_a_meaning_round_passes_as_one_that_says_nothing(word: str) -> None:
    task = Task(
        id="t",
        command=Command(request=f"stop {word}"),
        composition=Composition(plan=StopMission(id="n1", said=((0, 4),))),
    )
    assert request_pieces(task)[-1] == Piece(text=word, role="nothing")


def test_a_task_that_carries_no_ranges_is_said_to_carry_none_and_one_without_a_request_is_not() -> None:
    task = planned("Take a picture of tree 4.")
    composition = replace(task.composition, plan=bare(task.composition.plan))
    (problem,) = unaccounted(replace(task, composition=composition))
    assert problem.what == "the Task does not record which words of the request became which part of the plan"
    assert unaccounted(replace(task, composition=composition, command=replace(task.command, request=""))) == ()


@pytest.mark.parametrize("span", [(0, 9_999), (50, 60), (7, 3)])
def test_ranges_that_lead_out_of_the_request_are_no_failure(span: tuple[int, int]) -> None:
    task = Task(
        id="t",
        command=Command(request="stop now", no_part=(span,)),
        composition=Composition(plan=OptionalStep(id="n1", body=StopMission(id="n2", said=(span,)))),
        constraints=Constraints(budgets=(Budget(kind="distance_m", limit=5, said=(span,)),)),
    )
    assert "".join(piece.text for piece in request_pieces(task)) == "stop now"


def test_the_checks_warn_of_lost_words_and_still_find_everything_else() -> None:
    task = planned("Take a picture of tree 4.")
    longer = replace(task, command=replace(task.command, request=f"{task.command.request} Bring coffee."))
    assert check(task, SITE, HUSKY) == ()
    assert [(p.severity, p.what) for p in check(longer, SITE, HUSKY)] == [
        ("warning", "nothing in the plan corresponds to 'Bring coffee'")
    ]
