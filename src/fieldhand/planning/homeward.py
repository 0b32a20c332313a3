"""Choose the end of a mission whose request names none: at home, unless the way there takes most of the budget.

Both planners decide it here, so that the same words end in the same place whoever plans them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from fieldhand.forecast.way_home import excessive_way_home
from fieldhand.language import message
from fieldhand.language.words import say_rounded
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.build import FAULTED_EXITS
from fieldhand.task.frames import FaultedExit, Task, Then

_HOMEWARD: dict[Then, str] = {
    "return_to_end": message("When everything is done, the robot drives to the end marker.", context="assumption"),
    "return_to_start": message(
        "When everything is done, the robot drives back to the start marker.", context="assumption"
    ),
    "stay": message(
        "The site has no start or end marker: when everything is done, the robot stays where it is.",
        context="assumption",
    ),
}


def usual_exit(site: Site) -> Then:
    """Return the usual end of a mission on a site."""
    if "end" in site.markers:
        return "return_to_end"
    return "return_to_start" if "start" in site.markers else "stay"


def faulted_exits(nominal: Then) -> tuple[FaultedExit, ...]:
    """Return the exits after faults; at a low budget the robot goes where the plan ends, or stays."""
    return tuple(replace(e, then=nominal) if e.fault == "low_budget" else e for e in FAULTED_EXITS)


def with_assumed_exit(task: Task, site: Site, robot: RobotProfile) -> Task:
    """Return a Task with the usual exit as an assumption.

    Where the way home would take most of the budget for optional visits, the robot stays after the last of them.

    Args:
        task: Of a request that does not say where to end, with the usual exit.
    """
    then = task.composition.nominal
    metres = excessive_way_home(task, site, robot, then)
    text = _HOMEWARD[then]
    if metres is not None and then == "return_to_end":
        text = message(
            "The way to the end marker alone is {metres} m, a large part of what it may use: the robot stays at its"
            " last place. Ask for the return if you want it.",
            context="assumption",
            metres=say_rounded(metres),
        )
    elif metres is not None:
        text = message(
            "The way to the start alone is {metres} m, a large part of what it may use: the robot stays at its last"
            " place. Ask for the return if you want it.",
            context="assumption",
            metres=say_rounded(metres),
        )
    assumptions = tuple(dict.fromkeys([*task.command.assumptions, text]))
    return replace(
        task,
        command=replace(task.command, assumptions=assumptions),
        composition=task.composition
        if metres is None
        else replace(task.composition, nominal="stay", faulted=_staying(task.composition.faulted)),
    )


def _staying(faulted: Sequence[FaultedExit]) -> tuple[FaultedExit, ...]:
    """Return the exits of a mission that reserves no budget for the way home and stays at its last place."""
    return tuple(replace(e, then="stay") if e.fault == "low_budget" else e for e in faulted)
