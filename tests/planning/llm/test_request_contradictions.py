"""A plan that contradicts the request goes back once; after that the operator reads each contradiction as a warning."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fieldhand import mission
from fieldhand.errors import ModelError
from fieldhand.planning.planner import Clarify, Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task.codec import decode, encode
from fieldhand.task.frames import Task
from fieldhand.task.plan import Act
from fieldhand.testing.scripted_chat import SETTINGS, ScriptedChat, planner_of, task_document

DEMO, HUSKY = open_site("demo"), load_robot("husky")
REQUEST = "Take 3 pictures of tree 4."
RIGHT = task_document('<act count="3"><take_thermal_picture/><at><tree-is tree="4"/></at></act>')
WRONG = RIGHT.replace('count="3"', 'count="2"')
BROKEN = RIGHT.replace("take_thermal_picture", "paint")


def captures(task: Task) -> int:
    assert isinstance(task.composition.plan, Act)
    return task.composition.plan.count


def doubted(task: Task) -> tuple[str, ...]:
    """Return the findings of approval on the Task as it is read from its document, wherever it was kept."""
    review = mission.review(decode(encode(task)), DEMO, HUSKY)
    return tuple(w for w in review.warnings if "this may not be what was asked" in w)


def test_a_right_plan_is_taken_at_once_without_a_warning() -> None:
    chat = ScriptedChat(RIGHT)
    outcome = planner_of(chat).plan(REQUEST, DEMO, HUSKY)
    assert isinstance(outcome, Planned)
    assert (len(chat.prompts), doubted(outcome.task)) == (1, ())


def test_a_contradiction_goes_back_as_a_typed_problem_with_its_place() -> None:
    chat = ScriptedChat(WRONG, RIGHT)
    outcome = planner_of(chat).plan(REQUEST, DEMO, HUSKY)
    assert isinstance(outcome, Planned)
    assert (captures(outcome.task), doubted(outcome.task), len(chat.prompts)) == (3, (), 2)
    assert "[request] line 4 <act>: the plan holds the number 2" in chat.prompts[1]
    assert "[request] the request says '3 pictures'" in chat.prompts[1]
    assert "keep the plan as it is if the request does mean it" in chat.prompts[1]


def test_a_model_that_insists_is_not_asked_again_and_the_operator_reads_why() -> None:
    chat = ScriptedChat(WRONG)
    outcome = planner_of(chat).plan(REQUEST, DEMO, HUSKY)
    assert isinstance(outcome, Planned)
    assert len(chat.prompts) == 2
    assert captures(outcome.task) == 2
    assert len(doubted(outcome.task)) == 2
    assert any("'3 pictures'" in warning for warning in doubted(outcome.task))


def test_another_contradiction_in_place_of_the_first_is_a_warning_too() -> None:
    other = RIGHT.replace('tree="4"', 'tree="5"')
    outcome = planner_of(ScriptedChat(WRONG, other)).plan(REQUEST, DEMO, HUSKY)
    assert isinstance(outcome, Planned)
    assert any("tree '5'" in warning for warning in doubted(outcome.task))


@pytest.mark.parametrize("after", [BROKEN, "sorry", ""], ids=["invalid", "prose", "nothing"])
def test_a_model_that_only_breaks_its_plan_leaves_the_doubted_one(after: str) -> None:
    chat = ScriptedChat(WRONG, after)
    outcome = planner_of(chat).plan(REQUEST, DEMO, HUSKY)
    assert isinstance(outcome, Planned)
    assert len(chat.prompts) == SETTINGS.repairs + 1
    assert captures(outcome.task) == 2
    assert doubted(outcome.task)


def test_a_doubt_does_not_use_up_the_other_repairs() -> None:
    chat = ScriptedChat(BROKEN, WRONG, BROKEN, RIGHT)
    outcome = planner_of(chat).plan(REQUEST, DEMO, HUSKY)
    assert isinstance(outcome, Planned)
    assert (captures(outcome.task), doubted(outcome.task), len(chat.prompts)) == (3, (), 4)


def test_a_model_may_ask_when_it_is_doubted() -> None:
    outcome = planner_of(ScriptedChat(WRONG, "<question>Two or three?</question>")).plan(REQUEST, DEMO, HUSKY)
    assert isinstance(outcome, Clarify)


def test_without_repairs_a_doubt_is_a_warning_at_once() -> None:
    chat = ScriptedChat(WRONG)
    outcome = planner_of(chat, replace(SETTINGS, repairs=0)).plan(REQUEST, DEMO, HUSKY)
    assert isinstance(outcome, Planned)
    assert doubted(outcome.task)
    assert len(chat.prompts) == 1


def test_a_model_that_never_gives_a_usable_plan_still_fails_clearly() -> None:
    chat = ScriptedChat(BROKEN)
    with pytest.raises(ModelError, match="none of 4 answers"):
        planner_of(chat).plan(REQUEST, DEMO, HUSKY)
    assert len(chat.prompts) == 4


def test_faulted_exits_that_nobody_asked_for_are_doubted() -> None:
    exits = '<exits nominal="return_to_end"><faulted fault="low_budget" then="stay"/></exits>'
    chat = ScriptedChat(RIGHT.replace("</plan>", f"</plan>{exits}"))
    outcome = planner_of(chat).plan(REQUEST, DEMO, HUSKY)
    assert isinstance(outcome, Planned)
    assert any("low budget" in warning for warning in doubted(outcome.task))
