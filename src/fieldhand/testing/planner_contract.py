"""Contract tests for planners: subclass :class:`PlannerContract` and list requests that your planner understands.

::

    class TestMyPlanner(PlannerContract):
        understood = ("Take a thermal picture of tree 4.",)
        not_understood = ("Paint tree 4 blue.",)

        def make(self) -> Planner:
            return MyPlanner()
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import ClassVar

from fieldhand import mission
from fieldhand.errors import RequestError
from fieldhand.planning.planner import Clarify, Planned, Planner, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from fieldhand.task.codec import encode
from fieldhand.task.frames import Task

__all__ = ["PlannerContract"]


class PlannerContract(ABC):
    """The contract of :class:`fieldhand.planning.planner.Planner`, as tests.

    Attributes:
        understood: Requests that are planned on the site without a question.
        not_understood: Requests that the planner refuses or asks a question about.
    """

    understood: ClassVar[Sequence[str]]
    not_understood: ClassVar[Sequence[str]] = ()

    @abstractmethod
    def make(self) -> Planner:
        """Return a planner."""

    def site(self) -> Site:
        """Return the site to plan on; by default the built-in orchard."""
        return open_site("demo")

    def robot(self) -> RobotProfile:
        """Return the robot to plan for; by default the built-in husky."""
        return load_robot("husky")

    def test_a_plan_keeps_the_request_word_for_word(self) -> None:
        for request in self.understood:
            kept = self._planned(request).command.request
            assert kept == request, f"the Task's request is {kept!r}, it was {request!r}"

    def test_a_plan_is_a_document_that_the_robots_schema_accepts(self) -> None:
        for request in self.understood:
            task = self._planned(request)
            again = mission.decode_task(encode(task), self.robot(), source=request)
            assert encode(again) == encode(task), f"{request!r}: the document is read as another Task"

    def test_a_plan_can_be_carried_out_here(self) -> None:
        for request in self.understood:
            errors = mission.review(self._planned(request), self.site(), self.robot()).errors
            assert not errors, f"{request!r}: {'; '.join(str(error.line()) for error in errors)}"

    def test_the_same_request_becomes_the_same_plan(self) -> None:
        for request in self.understood:
            first, second = encode(self._planned(request)), encode(self._planned(request))
            assert first == second, f"{request!r} became two plans"

    def test_what_is_not_understood_is_refused_or_asked_about(self) -> None:
        for request in self.not_understood:
            outcome = self.make().plan(request, self.site(), self.robot())
            assert isinstance(outcome, Clarify | Refused), f"{request!r} became a plan"
            if isinstance(outcome, Refused):
                assert outcome.reasons, f"{request!r} is refused without a reason"
            else:
                assert outcome.question, f"{request!r}: the question is empty"

    def test_an_empty_request_is_an_error(self) -> None:
        try:
            outcome = self.make().plan(" ", self.site(), self.robot())
        except RequestError:
            return
        raise AssertionError(f"an empty request became {type(outcome).__name__}")

    def _planned(self, request: str) -> Task:
        """Return the Task planned from a request."""
        outcome = self.make().plan(request, self.site(), self.robot())
        assert isinstance(outcome, Planned), f"{request!r} became {outcome}"
        return outcome.task
