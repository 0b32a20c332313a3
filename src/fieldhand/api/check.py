"""Check a Task document."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Depends

from fieldhand import mission
from fieldhand.api.answers import review_answer
from fieldhand.api.callers import Caller, Scope, require
from fieldhand.api.earlier import with_logs
from fieldhand.api.inputs import CheckBody, open_site_and_robot, open_task
from fieldhand.api.work import Workers
from fieldhand.language import open_language
from fieldhand.task.codec import encode


def router(workers: Workers) -> APIRouter:
    """``POST /check``."""
    routes = APIRouter(tags=["mission"])

    @routes.post("/check")
    async def check(body: CheckBody, caller: Annotated[Caller, Depends(require(Scope.PLAN))]) -> dict[str, Any]:
        """Check a Task document against a site and a robot."""
        return await workers.do(lambda: _check(body), caller.name)

    return routes


def _check(body: CheckBody) -> dict[str, Any]:
    site_and_robot = open_site_and_robot(body)
    task, document = open_task(body.xml, site_and_robot.robot)
    added = with_logs(task, body.earlier, site_and_robot.site)
    if added is not task:
        task, document = added, encode(added)
    review = mission.review(task, site_and_robot.site, site_and_robot.robot, document=document)
    return {
        "outcome": "checked",
        "request": task.command.request,
        **review_answer(review, site_and_robot, open_language(body.lang)),
    }
