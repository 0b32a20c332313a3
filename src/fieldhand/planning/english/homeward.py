"""How a mission ends where the request does not say it: on the way home, unless that is most of what may be used."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.forecast.homeward import costs_too_much
from fieldhand.language import message
from fieldhand.planning.english.told import Told
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task, Then
from fieldhand.task.words import say_rounded

_HOMEWARD: dict[Then, str] = {
    "return_to_end": message("When all is done the robot drives to the end marker.", context="assumption"),
    "return_to_start": message("When all is done the robot drives back to the start marker.", context="assumption"),
}


def exit_of(told: Told, site: Site) -> tuple[Then, list[str]]:
    """How the mission ends, and what was assumed for that."""
    if told.nominal is not None:
        return told.nominal, []
    if "end" in site.markers:
        return "return_to_end", [_HOMEWARD["return_to_end"]]
    if "start" in site.markers:
        return "return_to_start", [_HOMEWARD["return_to_start"]]
    stays = message(
        "The site has no start or end marker: the robot stays where it is when all is done.", context="assumption"
    )
    return "stay", [stays]


def stays_if_home_is_far(task: Task, site: Site, robot: RobotProfile) -> Task:
    """Without the way home that nobody asked for, where that would take most of the budget for optional visits."""
    then = task.composition.nominal
    metres = costs_too_much(task, site, robot, then)
    if metres is None:
        return task
    if then == "return_to_end":
        said = message(
            "The way to the end marker alone is {metres} m, much of what may be used: the robot stays where its last"
            " visit was. Ask for the return if it is wanted.",
            context="assumption",
            metres=say_rounded(metres),
        )
    else:
        said = message(
            "The way to the start alone is {metres} m, much of what may be used: the robot stays where its last visit"
            " was. Ask for the return if it is wanted.",
            context="assumption",
            metres=say_rounded(metres),
        )
    kept = tuple(a for a in task.command.assumptions if a != _HOMEWARD.get(then))
    return replace(
        task,
        command=replace(task.command, assumptions=(*kept, said)),
        composition=replace(task.composition, nominal="stay"),
    )
