"""Questions at the command line: answered by option, by the first choice, or by the person at the terminal."""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from fieldhand.cli import asking, show
from fieldhand.cli.asking import MOST_QUESTIONS, Replies, plan_and_ask
from fieldhand.errors import RequestError
from fieldhand.mission.documents import SiteAndRobot
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Reason, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from fieldhand.task.build import make_task
from fieldhand.task.plan import StopMission
from support.processes.command import fieldhand

SITE_AND_ROBOT = SiteAndRobot(site=open_site("demo"), robot=load_robot("husky"))
PLANNED = Planned(task=make_task(request="go", plan=StopMission(id=""), measures={}), planner="asks")


@dataclass
class Asks:
    """A planner that asks some questions, one after the other, and then has a plan."""

    questions: tuple[Clarify, ...]
    requests: list[str] = field(default_factory=list)
    answers: tuple[Answer, ...] = ()

    def plan(self, request: str, site: Site, robot: object, answers: tuple[Answer, ...] = ()) -> Outcome:
        self.requests.append(request)
        self.answers = answers
        return self.questions[len(answers)] if len(answers) < len(self.questions) else PLANNED


TWO = (Clarify(question="Which end?", choices=("north", "south")), Clarify(question="How many?", choices=("4", "2")))


@pytest.fixture
def typed(monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    """A person at a terminal, who types this."""

    def types(text: str) -> None:
        monkeypatch.setattr(asking, "may_ask", lambda: True)
        monkeypatch.setattr("sys.stdin", io.StringIO(text))

    return types


def test_one_question_after_the_other_is_answered_by_number_or_words(
    typed: Callable[[str], None], capsys: pytest.CaptureFixture[str]
) -> None:
    typed("2\n4\n")
    planner = Asks(TWO)
    words, outcome = plan_and_ask("go", SITE_AND_ROBOT, planner, Replies())
    assert isinstance(outcome, Planned)
    assert (words, outcome.task) == ("go", PLANNED.task)
    assert planner.answers == (
        Answer(question="Which end?", answer="south"),
        Answer(question="How many?", answer="4"),
    )


@pytest.mark.parametrize("text", ["", "\n", "  \n"])
def test_no_answer_ends_it_with_a_message(typed: Callable[[str], None], text: str) -> None:
    typed(text)
    with pytest.raises(RequestError, match="no answer was given, nothing was planned"):
        plan_and_ask("go", SITE_AND_ROBOT, Asks(TWO), Replies())


def test_other_words_are_another_request_or_an_answer_as_the_planner_says(typed: Callable[[str], None]) -> None:
    typed("go there\nsouth\n4\n")
    planner = Asks(TWO)
    assert plan_and_ask("go", SITE_AND_ROBOT, planner, Replies())[0] == "go there"
    typed("the one by the pond\n")
    free = Asks((Clarify(question="Which end?", choices=("north",), free=True),))
    assert plan_and_ask("go", SITE_AND_ROBOT, free, Replies())[0] == "go"
    assert free.answers == (Answer(question="Which end?", answer="the one by the pond"),)


def test_given_answers_come_first_and_the_rest_is_assumed_and_said() -> None:
    planner = Asks(TWO)
    plan_and_ask("go", SITE_AND_ROBOT, planner, Replies(given=("SOUTH",), assume=True))
    assert planner.answers == (
        Answer(question="Which end?", answer="south"),
        Answer(question="How many?", answer="4", assumed=True),
    )


def test_the_first_choice_is_not_taken_without_asking_if_the_request_is_refused_otherwise() -> None:
    refused = Refused(reasons=(Reason(what="not understood: 'flurb'"),), planner="asks")
    planner = Asks((Clarify(question="May it be left out?", choices=("Leave it out.",), otherwise=refused),))
    assert plan_and_ask("go", SITE_AND_ROBOT, planner, Replies(assume=True))[1] == refused
    assert isinstance(plan_and_ask("go", SITE_AND_ROBOT, planner, Replies(given=("1",), assume=True))[1], Planned)


def test_a_planner_that_never_stops_asking_is_stopped() -> None:
    with pytest.raises(RequestError, match=f"no plan after {MOST_QUESTIONS} questions"):
        plan_and_ask("go", SITE_AND_ROBOT, Asks(TWO[:1] * 100), Replies(assume=True))


def test_the_commands_take_answers_and_without_them_end_with_the_question() -> None:
    words = ("plan", "take a picture of row 3", "--site", "demo", "--planner", "english")
    asked = fieldhand(*words)
    assert (asked.status, "2. At the nearest of the trees of row 3: take a thermal picture." in asked.err) == (2, True)
    done = fieldhand(*words, "--answer", "2", "--json")
    assert done.status == 0
    assert any('Answered: "At the nearest of the trees of row 3' in line for line in json.loads(done.out)["read_back"])
    wrong = fieldhand(*words, "--answer", "perhaps")
    assert wrong.status == 2
    assert wrong.err.count("\n") == 1
    assert "--answer: 'perhaps' does not answer" in wrong.err


def test_the_words_of_a_request_are_shown_with_and_without_colour(monkeypatch: pytest.MonkeyPatch) -> None:
    from fieldhand.cli.console import Terminal
    from fieldhand.planning.english.planner import EnglishPlanner

    planned = EnglishPlanner().plan("Please take a picture of tree 4.", SITE_AND_ROBOT.site, SITE_AND_ROBOT.robot)
    assert isinstance(planned, Planned)
    shown = {}
    for system in ("standard", None):
        page = io.StringIO()
        monkeypatch.setattr(
            show, "out", Terminal(file=page, force_terminal=system is not None, color_system=system, width=200)
        )
        show.show_request(planned.task)
        shown[system] = page.getvalue()
    assert "\x1b[1;34mtake a picture\x1b[0m" in shown["standard"]
    assert "\x1b" not in shown[None]
    assert "(no part in the plan: Please; action: take a picture; place: tree 4)" in shown[None]


def test_a_question_is_drawn_before_it_is_answered_or_left(typed: Callable[[str], None], tmp_path: Path) -> None:
    places = tuple((tree.place,) for tree in SITE_AND_ROBOT.site.trees[:2])
    which = Clarify(question="Which end?", choices=("north", "south"), places=places)
    drawn: list[Clarify] = []
    typed("2\n")
    plan_and_ask("go", SITE_AND_ROBOT, Asks((which,)), Replies(draw=drawn.append))
    plan_and_ask("go", SITE_AND_ROBOT, Asks((which,)), Replies(ask=False, draw=drawn.append))
    assert drawn == [which, which]
    plan_and_ask("go", SITE_AND_ROBOT, Asks((which,)), Replies(given=("north",), draw=drawn.append))
    assert len(drawn) == 2


def test_a_question_that_nobody_answers_leaves_its_picture_and_says_where_each_choice_leads(tmp_path: Path) -> None:
    words = ("plan", "take a picture of tree 5 in row 1", "--site", "demo", "--picture", "q.png")
    asked = fieldhand(*words, cwd=tmp_path)
    assert asked.status == 2
    assert "(tree 5)" in asked.err
    assert (tmp_path / "q.png").stat().st_size > 10_000
