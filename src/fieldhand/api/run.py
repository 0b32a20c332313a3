"""Approve a mission, simulate it and judge it."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable
from dataclasses import asdict
from datetime import datetime
from typing import Annotated, Any

from fastapi import APIRouter, Depends

from fieldhand import mission
from fieldhand.api.answers import unplanned_answer
from fieldhand.api.audit import Record
from fieldhand.api.callers import Caller, Scope, approver, require
from fieldhand.api.earlier import records_of, with_logs
from fieldhand.api.inputs import RunBody, answers_of, open_site_and_robot, open_task
from fieldhand.api.maps import driven_map
from fieldhand.api.plan import Planners
from fieldhand.api.work import Limits, Workers
from fieldhand.approval.production import require_unsigned_allowed
from fieldhand.compatibility import UTC
from fieldhand.mission.documents import SiteAndRobot
from fieldhand.planning.planner import Planned
from fieldhand.task.event_lines import to_json
from fieldhand.task.frames import Task
from fieldhand.task.results import Ended
from fieldhand.wording.events import EventText, goal_names


def router(workers: Workers, planners: Planners, limits: Limits, record: Record) -> APIRouter:
    """``POST /run``."""
    routes = APIRouter(tags=["mission"])

    @routes.post("/run")
    async def run(body: RunBody, caller: Annotated[Caller, Depends(require(Scope.APPROVE))]) -> dict[str, Any]:
        """Approve a mission in the name of an operator, simulate it and judge it."""
        by = approver(caller, body.approved_by)
        answer = await workers.do(lambda: _run(body, by, planners, limits), caller.name)
        if answer["outcome"] == "ran":
            authorization = answer["authorization"]
            await record(caller, "approve and simulate", authorization["task_sha256"], approved_by=by, seed=body.seed)
        return answer

    return routes


def _run(body: RunBody, by: str, planners: Planners, limits: Limits) -> dict[str, Any]:
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.execution.drivers.simulation.world_file import parse_world

    require_unsigned_allowed(os.environ)
    site_and_robot = open_site_and_robot(body)
    world = World() if body.world is None else parse_world(body.world, source="world")
    if body.request is not None:
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
        task = outcome.task
    else:
        task, _ = open_task(body.xml or "", site_and_robot.robot)
        task = with_logs(task, body.earlier, site_and_robot.site)
    approved = mission.authorize(
        mission.review(task, site_and_robot.site, site_and_robot.robot),
        by=by,
        at=datetime.now(UTC),
        confirmed=body.confirmed,
        language=body.lang,
    )
    run = mission.simulate(
        approved,
        world=world,
        seed=world.seed if body.seed is None else body.seed,
        interrupted=_deadline(limits.run_s),
    )
    return _answer(run, site_and_robot)


def _deadline(seconds: float) -> Callable[[], str | None]:
    """Return a function that returns a reason to end the simulation after a number of seconds, else None."""
    until = time.monotonic() + seconds
    return lambda: f"the simulation took longer than {seconds:g} s" if time.monotonic() > until else None


def _answer(run: mission.Run, site_and_robot: SiteAndRobot) -> dict[str, Any]:
    authorized, events, assessment = run.mission.authorized, run.events, run.assessment
    ended = next(event for event in reversed(events) if isinstance(event, Ended))
    tell = EventText(site_and_robot.robot).line
    return {
        "outcome": "ran",
        "authorization": asdict(authorized.authorization),
        "status": ended.status,
        "reason": ended.reason,
        "travelled_m": ended.travelled_m,
        "seconds": ended.t,
        "charge_percent": ended.charge_percent,
        "success": assessment.success,
        "exceeded": [asdict(one) for one in assessment.exceeded],
        "goals": _goals(authorized.task, site_and_robot, assessment),
        "events": [json.loads(to_json(event)) for event in events],
        "told": [tell(event) or "" for event in events],
        "map": driven_map(events),
    }


def _goals(task: Task, site_and_robot: SiteAndRobot, assessment: mission.Assessment) -> list[dict[str, Any]]:
    nodes = {goal.id: goal.node for goal in task.command.goals}
    name = goal_names(task, site_and_robot.robot)
    return [
        {**asdict(outcome), "node": nodes.get(outcome.goal, ""), "name": name(outcome.goal)}
        for outcome in assessment.outcomes
    ]
