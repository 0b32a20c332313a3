"""The English planner and the llm planner, with a model that gives a prepared answer, keep the planner's contract."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Answer, Outcome, Planned, Planner
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.testing.planner_contract import PlannerContract
from fieldhand.testing.scripted_chat import ScriptedChat, planner_of, task_document


class TestEnglishPlanner(PlannerContract):
    understood = (
        "Take a thermal picture of tree 4.",
        "Read CO2 at the corner trees, then return to the start.",
        "Take thermal pictures of as many trees as you can without driving more than 300 meters.",
    )
    not_understood = ("Paint tree 4 blue.",)

    def make(self) -> Planner:
        return EnglishPlanner()


class TestLlmPlanner(PlannerContract):
    understood = ("Read CO2 at tree 4.",)

    def make(self) -> Planner:
        plan = '<act><read_co2/><at><tree-is tree="4"/></at></act>'
        return planner_of(ScriptedChat(task_document(plan)))


class Careless:
    """A planner that breaks the contract: it plans one request only, whatever it is asked."""

    def __init__(self) -> None:
        self._planner = EnglishPlanner()

    def plan(self, request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...] = ()) -> Outcome:
        outcome = self._planner.plan("Read CO2 at tree 4.", site, robot, answers)
        assert isinstance(outcome, Planned)
        return outcome


class CarelessContract(PlannerContract):
    understood = ("Take a thermal picture of tree 4.",)
    not_understood = ("Paint tree 4 blue.",)

    def make(self) -> Planner:
        return Careless()


@pytest.mark.parametrize(
    "test",
    [
        CarelessContract.test_a_plan_keeps_the_request_word_for_word,
        CarelessContract.test_what_is_not_understood_is_refused_or_asked_about,
        CarelessContract.test_an_empty_request_is_an_error,
    ],
)
def test_a_planner_that_breaks_the_contract_fails(test) -> None:
    with pytest.raises(AssertionError):
        test(CarelessContract())
