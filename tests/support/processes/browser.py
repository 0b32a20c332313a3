"""Calls of the served application, and Tasks to send to it that no planner had to make."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import httpx
from fastapi import FastAPI

from fieldhand import mission
from fieldhand.api.app import create_app
from fieldhand.api.work import Limits
from fieldhand.fleet import Fleet
from fieldhand.places.selectors import Corners, Here, Nearest, Quarter, Where
from fieldhand.planning.planner import Answer, Outcome, Planned, Planner
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import load_demo
from fieldhand.site.model import Site
from fieldhand.task.build import make_task
from fieldhand.task.codec import encode
from fieldhand.task.conditions import Compare
from fieldhand.task.frames import Budget, Constraints, Resource, Task
from fieldhand.task.plan import Act, ForEach, If, InOrder, Node

LOCAL = frozenset({"localhost", "127.0.0.1", "::1"})


class Browser:
    """Calls an application as a browser on this machine does."""

    def __init__(self, app: FastAPI, address: str = "127.0.0.1") -> None:
        self.app, self.address = app, address

    def get(self, path: str, **options: Any) -> httpx.Response:
        return self.call("GET", path, **options)

    def post(self, path: str, body: Any = None, **options: Any) -> httpx.Response:
        return self.call("POST", path, **({"json": body} if body is not None else {}), **options)

    def call(self, method: str, path: str, **options: Any) -> httpx.Response:
        async def send() -> httpx.Response:
            transport = httpx.ASGITransport(app=self.app, client=(self.address, 50_000))
            async with httpx.AsyncClient(transport=transport, base_url="http://localhost:8000") as client:
                return await client.request(method, path, **options)

        return asyncio.run(send())


@dataclass(frozen=True, kw_only=True)
class Says:
    """A planner that gives the same answer to everything."""

    outcome: Callable[[str, Site, RobotProfile], Outcome]

    def plan(self, request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...] = ()) -> Outcome:
        return self.outcome(request, site, robot)


def browser(planner: Planner | None = None, *, limits: Limits | None = None, fleet: Fleet | None = None) -> Browser:
    """The API with one planner for every name."""
    plans = planner or Says(outcome=lambda r, s, p: Planned(task=corner_task(r, s, p), planner="hand"))
    return Browser(create_app(lambda name: plans, hosts=LOCAL, limits=limits, fleet=fleet))


def corner_task(request: str, site: Site, robot: RobotProfile) -> Task:
    """A picture at each corner tree; where it is hot, one of a neighbour; then optional visits within a budget."""
    action = robot.actions[0]
    hot = Compare(reading="r", quantity=action.measures[0], test="gt", value=32.0, unit="degC")
    around = Act(id="", action=action.name, at=Nearest(to=Here()))
    corners = ForEach(
        id="",
        select=Corners(),
        body=InOrder(id="", steps=(Act(id="", action=action.name, reading="r"), If(id="", condition=hot, then=around))),
    )
    nonpareil = Where(attribute="variety", test="eq", value="Nonpareil", of=Quarter(quarter="nw"))
    rest = ForEach(id="", select=nonpareil, optional=True, body=Act(id="", action=action.name))
    return task_of(InOrder(id="", steps=(corners, rest)), request, site, robot)


def task_of(plan: Node, request: str, site: Site, robot: RobotProfile) -> Task:
    """A whole Task of a bare plan, with a budget of 600 m."""
    return make_task(
        request=request,
        plan=plan,
        measures={a.name: tuple((q, robot.quantity[q].unit) for q in a.measures) for a in robot.actions},
        resources=(
            Resource(kind="robot", name=robot.name, sha256=robot.sha256),
            Resource(kind="site", name=site.name, sha256=site.sha256),
        ),
        constraints=Constraints(budgets=(Budget(kind="distance_m", limit=600.0),)),
    )


@cache
def corner_warnings() -> tuple[str, ...]:
    """Return the warning to confirm for that Task: its request names nothing of its plan."""
    site, robot = load_demo(), load_robot("husky")
    return mission.review(corner_task("corners", site, robot), site, robot).warnings


def corner_xml() -> str:
    """Return that Task on the built-in orchard for the husky, as a document."""
    return encode(corner_task("corners", load_demo(), load_robot("husky"))).decode()
