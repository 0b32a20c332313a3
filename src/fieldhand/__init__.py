"""Fieldhand: plain words to a checked, approved mission for a field robot.

The public interface; docs/python.md shows it step by step::

    import fieldhand as fh

    site = fh.Site.demo()
    robot = fh.Robot.load("husky")
    plan = fh.plan("Photograph every third tree of row 2.", site, robot)
    review = fh.review(plan.task, site, robot)
    mission = fh.authorize(review, by="Ada")
    run = fh.simulate(mission, seed=1)

Names are imported when they are first used, so that ``import fieldhand`` is quick.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from fieldhand.errors import FieldhandError
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.execution.vehicle import Vehicle
    from fieldhand.mission import (
        ApprovedMission,
        Assessment,
        Plan,
        Review,
        Run,
        Simulation,
        Simulations,
        authorize,
        build_task,
        carry_out,
        fly_many,
        plan,
        review,
        simulate,
    )
    from fieldhand.missions.earlier_missions import earlier_missions
    from fieldhand.orienteering.policy import Policy
    from fieldhand.places import selectors
    from fieldhand.planning.planner import Answer, Clarify, Planned, Planner, Refused
    from fieldhand.robot.model import RobotProfile as Robot
    from fieldhand.site.earlier_missions import EarlierMissions
    from fieldhand.site.model import Site
    from fieldhand.task import plan as steps
    from fieldhand.task.frames import Task

#: Public names: the module of each, and its name there (empty for the module itself).
_PUBLIC = {
    "Answer": ("fieldhand.planning.planner", "Answer"),
    "ApprovedMission": ("fieldhand.mission", "ApprovedMission"),
    "Assessment": ("fieldhand.mission", "Assessment"),
    "Clarify": ("fieldhand.planning.planner", "Clarify"),
    "EarlierMissions": ("fieldhand.site.earlier_missions", "EarlierMissions"),
    "FieldhandError": ("fieldhand.errors", "FieldhandError"),
    "Plan": ("fieldhand.mission", "Plan"),
    "Planned": ("fieldhand.planning.planner", "Planned"),
    "Planner": ("fieldhand.planning.planner", "Planner"),
    "Policy": ("fieldhand.orienteering.policy", "Policy"),
    "Refused": ("fieldhand.planning.planner", "Refused"),
    "Review": ("fieldhand.mission", "Review"),
    "Robot": ("fieldhand.robot.model", "RobotProfile"),
    "Run": ("fieldhand.mission", "Run"),
    "Simulation": ("fieldhand.mission", "Simulation"),
    "Simulations": ("fieldhand.mission", "Simulations"),
    "Site": ("fieldhand.site.model", "Site"),
    "Task": ("fieldhand.task.frames", "Task"),
    "Vehicle": ("fieldhand.execution.vehicle", "Vehicle"),
    "World": ("fieldhand.execution.drivers.simulation.world", "World"),
    "authorize": ("fieldhand.mission", "authorize"),
    "build_task": ("fieldhand.mission", "build_task"),
    "carry_out": ("fieldhand.mission", "carry_out"),
    "earlier_missions": ("fieldhand.missions.earlier_missions", "earlier_missions"),
    "fly_many": ("fieldhand.mission", "fly_many"),
    "plan": ("fieldhand.mission", "plan"),
    "review": ("fieldhand.mission", "review"),
    "selectors": ("fieldhand.places.selectors", ""),
    "simulate": ("fieldhand.mission", "simulate"),
    "steps": ("fieldhand.task.plan", ""),
}

__all__ = [
    "Answer",
    "ApprovedMission",
    "Assessment",
    "Clarify",
    "EarlierMissions",
    "FieldhandError",
    "Plan",
    "Planned",
    "Planner",
    "Policy",
    "Refused",
    "Review",
    "Robot",
    "Run",
    "Simulation",
    "Simulations",
    "Site",
    "Task",
    "Vehicle",
    "World",
    "authorize",
    "build_task",
    "carry_out",
    "earlier_missions",
    "fly_many",
    "plan",
    "review",
    "selectors",
    "simulate",
    "steps",
]


def __getattr__(name: str) -> Any:
    try:
        module, attribute = _PUBLIC[name]
    except KeyError:
        raise AttributeError(f"module 'fieldhand' has no attribute {name!r}") from None
    found = import_module(module)
    value = getattr(found, attribute) if attribute else found
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
