"""Plan a request: the response is a Task, a question or a refusal."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any

from fastapi import APIRouter, Depends

from fieldhand import mission
from fieldhand.api.answers import review_answer, unplanned_answer
from fieldhand.api.audit import Record
from fieldhand.api.callers import Caller, Scope, require
from fieldhand.api.earlier import records_of
from fieldhand.api.inputs import PlanBody, answers_of, open_site_and_robot
from fieldhand.api.work import Workers
from fieldhand.language import open_language
from fieldhand.planning.planner import Planned, Planner

#: Returns the planner of a name: auto, english or llm.
Planners = Callable[[str], Planner]


def router(workers: Workers, planners: Planners, record: Record) -> APIRouter:
    """``POST /plan``."""
    routes = APIRouter(tags=["mission"])

    @routes.post("/plan")
    async def plan(body: PlanBody, caller: Annotated[Caller, Depends(require(Scope.PLAN))]) -> dict[str, Any]:
        """Plan a request: what was understood, where, and what it will take."""
        answer = await workers.do(lambda: _plan(body, planners), caller.name)
        await record(caller, "plan", body.request, outcome=answer["outcome"], task=answer.get("task", ""))
        return answer

    return routes


def _plan(body: PlanBody, planners: Planners) -> dict[str, Any]:
    from fieldhand.task.codec import encode

    site_and_robot = open_site_and_robot(body)
    outcome = mission.plan(
        body.request,
        site_and_robot.site,
        site_and_robot.robot,
        planners(body.planner),
        answers_of(body),
        earlier=records_of(body.earlier, site_and_robot.site),
    )
    if not isinstance(outcome, Planned):
        return unplanned_answer(outcome, site_and_robot)
    document = encode(outcome.task)
    review = mission.review(outcome.task, site_and_robot.site, site_and_robot.robot, document=document)
    return {
        "outcome": "planned",
        "planner": outcome.planner,
        "xml": document.decode(),
        **review_answer(review, site_and_robot, open_language(body.lang)),
    }
