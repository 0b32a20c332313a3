"""Words that only tell or describe something are asked about, if everything else of the request can be planned."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fieldhand.planning.auto import AutoPlanner
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Reason, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site

DEMO, HUSKY = open_site("demo"), load_robot("husky")
COMMAND = "Take a picture of tree 4"
TOLD = {
    f"{COMMAND} while the neighbours are at frobnication.": "while the neighbours are at frobnication",
    f"{COMMAND}. How far apart are the two frobnicators?": "How far apart are the two frobnicators",
    f"{COMMAND}; the frobnicators stay on the other half.": "the frobnicators stay on the other half",
    f"{COMMAND} once it has frobnicated.": "once it has frobnicated",
    f"{COMMAND} with the frobnicator.": "with the frobnicator",
    f"{COMMAND}, frobnicating nicely.": "frobnicating nicely",
    f"{COMMAND} for the new frobnicator.": "for the new frobnicator",
    f"{COMMAND} that frobnicates.": "that frobnicates",
    f"{COMMAND} secretly.": "secretly",
}
RESTRICTS = [
    f"{COMMAND} unless the frobnicators are there.",
    f"{COMMAND} but not while the gurgles frobnicate.",
    f"{COMMAND}. Do not frighten the frobnicators.",
    f"{COMMAND}, tree 5 and the one that is frobnicated.",
    f"{COMMAND} and frobnicate the others.",
    f"Frobnicate the others. {COMMAND}.",
    f"{COMMAND} before the flurb.",
    f"{COMMAND} once it is above 30 flurbs.",
    "Take a picture of the frobnicated tree.",
    "Take a picture of every tree in the frobnicated corner.",
    "Take a picture of the trees with 30 flurbs.",
    f"{COMMAND} without the frobnicator.",
    f"{COMMAND} with the frobnicator of tree 7.",
    f"{COMMAND} with the frobnicator for 20 minutes.",
    f"{COMMAND} using only the frobnicator.",
]


def plan(request: str, answers: tuple[Answer, ...] = (), site: Site = DEMO, robot: RobotProfile = HUSKY) -> Outcome:
    return EnglishPlanner().plan(request, site, robot, answers)


@pytest.mark.parametrize(("request_", "told"), TOLD.items())
def test_what_only_tells_something_is_asked_about_with_what_is_done_without_it(request_: str, told: str) -> None:
    asked = plan(request_)
    assert isinstance(asked, Clarify)
    assert f"'{told}'" in asked.question
    assert isinstance(asked.otherwise, Refused)
    (choice,) = asked.choices
    assert "At tree 4: take a thermal picture." in choice


@pytest.mark.parametrize("request_", TOLD)
def test_the_answer_plans_the_rest_and_is_recorded_with_the_words_left_out(request_: str) -> None:
    asked = plan(request_)
    assert isinstance(asked, Clarify)
    planned = plan(request_, (Answer(question=asked.question, answer=asked.choices[0]),))
    assert isinstance(planned, Planned)
    command = planned.task.command
    assert command.request == request_
    assert any(asked.question in str(sentence) for sentence in command.assumptions)
    bare = plan(f"{COMMAND}.")
    assert isinstance(bare, Planned)

    def places(one: Planned) -> list[object]:
        return [node.selector for node in one.task.composition.plan.children]

    assert places(planned) == places(bare)


@pytest.mark.parametrize("request_", RESTRICTS)
def test_what_may_restrict_or_command_is_never_left_out(request_: str) -> None:
    assert isinstance(plan(request_), Refused)


def test_a_question_about_the_rest_is_shown_with_the_choice_and_asked_next() -> None:
    request = "Take pictures of random trees with the frobnicator."
    asked = plan(request)
    assert isinstance(asked, Clarify)
    (choice,) = asked.choices
    then = plan(request, (Answer(question=asked.question, answer=choice),))
    assert isinstance(then, Clarify)
    assert then.question in choice


def test_other_words_than_the_choice_leave_the_question_open() -> None:
    (request, *_) = TOLD
    asked = plan(request)
    assert isinstance(asked, Clarify)
    assert plan(request, (Answer(question=asked.question, answer="no"),)) == asked


def test_a_request_that_the_robot_cannot_carry_out_is_refused_whatever_else_it_tells() -> None:
    assert isinstance(plan("Before I hang the frobnicators up, spray row 4."), Refused)


class Fixed:
    """A planner whose outcome is given."""

    def __init__(self, outcome: Outcome) -> None:
        self.outcome = outcome

    def plan(self, request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...] = ()) -> Outcome:
        return self.outcome


def test_a_language_model_is_asked_before_the_person() -> None:
    (request, *_) = TOLD
    planned = plan(f"{COMMAND}.")
    assert isinstance(planned, Planned)
    by_model = replace(planned, planner="llm:m")
    answered = AutoPlanner(EnglishPlanner(), Fixed(by_model)).plan(request, DEMO, HUSKY)
    assert answered.planner == "llm:m"
    refused = Refused(reasons=(Reason(what="no"),), planner="llm:m")
    assert isinstance(AutoPlanner(EnglishPlanner(), Fixed(refused)).plan(request, DEMO, HUSKY), Clarify)
    assert isinstance(AutoPlanner(EnglishPlanner(), None).plan(request, DEMO, HUSKY), Clarify)
