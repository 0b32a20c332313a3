"""AutoPlanner: English first, a model only where English does not understand, advice where there is no model."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import cast

import pytest

from fieldhand.errors import ModelError, RequestError
from fieldhand.places.selectors import First
from fieldhand.planning.auto import AutoPlanner
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Reason, Refused
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.build import make_task
from fieldhand.task.codec import decode, encode
from fieldhand.task.plan import GoTo

PLAN = GoTo(id="", place=First())


@dataclass
class Fixed:
    """A planner whose outcome is given."""

    outcome: Outcome | Exception
    asked: list[str] = field(default_factory=list)

    def plan(self, request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...] = ()) -> Outcome:
        self.asked.append(request)
        if isinstance(self.outcome, Exception):
            raise self.outcome
        return self.outcome


def planned(planner: str) -> Planned:
    task = make_task(request="go", plan=PLAN, measures={})
    return Planned(task=replace(task, command=replace(task.command, warnings=("of its own",))), planner=planner)


CLARIFY = Clarify(question="Which?", planner="english")
REFUSED = Refused(reasons=tuple(Reason(what=f"'{w}' is not known", said=((0, 2),)) for w in "abcde"), planner="english")


def ask(english: Fixed, llm: Fixed | None) -> Outcome:
    # The site and the robot are only handed on, so nothing of them is needed here.
    return AutoPlanner(english, llm).plan("go", cast(Site, object()), cast(RobotProfile, object()))


@pytest.mark.parametrize("outcome", [planned("english"), CLARIFY], ids=["planned", "clarify"])
def test_a_model_is_not_asked_where_english_accounts_for_every_word(outcome: Outcome) -> None:
    llm = Fixed(planned("llm:m"))
    answered = ask(Fixed(outcome), llm)
    assert type(answered) is type(outcome)
    assert answered.planner == "english"
    assert not llm.asked


def test_the_operator_reads_which_planner_it_was_and_why() -> None:
    by_english, by_model = ask(Fixed(planned("english")), None), ask(Fixed(REFUSED), Fixed(planned("llm:m")))
    assert isinstance(by_english, Planned)
    assert isinstance(by_model, Planned)
    assert by_english.task.command.warnings == ("of its own",)
    first, last = by_model.task.command.warnings
    assert first == "of its own"
    assert "'llm:m'" in last
    assert "'a' is not known" in last
    assert "and 2 more" in last
    assert decode(encode(by_model.task)) == by_model.task


def test_a_question_of_the_model_is_handed_on() -> None:
    question = Clarify(question="Which corner?", planner="llm:m")
    assert ask(Fixed(REFUSED), Fixed(question)) == question


def test_two_refusals_give_the_reasons_of_both() -> None:
    both = ask(Fixed(REFUSED), Fixed(Refused(reasons=(Reason(what="no arm"),), planner="llm:m")))
    assert isinstance(both, Refused)
    assert [r.what for r in both.reasons][:2] == ["no arm", "'a' is not known"]
    assert len(both.reasons) == 6


def test_without_a_model_the_refusal_says_what_was_not_understood_and_how_to_get_one() -> None:
    refused = ask(Fixed(REFUSED), None)
    assert isinstance(refused, Refused)
    assert [r.what for r in refused.reasons] == [r.what for r in REFUSED.reasons]
    assert "FIELDHAND_MODEL" in refused.reasons[-1].advice


def test_a_model_that_fails_says_so_and_why_it_was_asked() -> None:
    failure = ModelError("the endpoint cannot be reached", where="http://127.0.0.1:1/v1", advice="check that it runs")
    with pytest.raises(ModelError) as caught:
        ask(Fixed(REFUSED), Fixed(failure))
    assert "cannot be reached" in caught.value.what
    assert "'a' is not known" in caught.value.what
    assert (caught.value.where, caught.value.advice) == (failure.where, failure.advice)


def test_an_unusable_request_is_no_matter_for_a_model() -> None:
    llm = Fixed(planned("llm:m"))
    with pytest.raises(RequestError):
        ask(Fixed(RequestError("the request is empty")), llm)
    assert not llm.asked
