"""Two missions on the built-in orchard, flown once for the tests of this folder."""

from __future__ import annotations

from functools import cache

from fieldhand.exchange.routes.route import ExportedRoute, driven, planned
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import load_demo
from fieldhand.task.frames import Task
from support.missions.flights import Flight, fly_task

#: Every branch drives the same ways; at each corner hangs one capture on a reading.
STRAIGHT = "Take a thermal picture of each corner tree. If it is below 33 C, read the CO2 there."
#: After the first stop the branches part.
PARTING = (
    "Take a thermal picture of the first tree. If it is below 33 C, read the CO2 at the farthest tree. "
    "Then take a picture of the last tree."
)


@cache
def task_of(request: str) -> Task:
    outcome = EnglishPlanner().plan(request, load_demo(), load_robot("husky"))
    assert isinstance(outcome, Planned)
    return outcome.task


@cache
def flight() -> Flight:
    return fly_task(task_of(STRAIGHT), load_demo())


@cache
def planned_route(request: str = STRAIGHT) -> ExportedRoute:
    return planned(task_of(request), load_demo(), load_robot("husky"))


@cache
def driven_route() -> ExportedRoute:
    return driven(flight().events)
