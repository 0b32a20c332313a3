"""How events and goals are said in words: handed in from above, since the command line says them, too."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from fieldhand.robot.model import RobotProfile
from fieldhand.task.frames import Task
from fieldhand.task.results import Event


@dataclass(frozen=True, kw_only=True)
class Words:
    """Says what happened.

    Attributes:
        of_event: For a robot, a function that says an event in one line; None where it is not worth one.
        of_goal: For a Task and a robot, a function that says the goal of an id.
    """

    of_event: Callable[[RobotProfile], Callable[[Event], str | None]]
    of_goal: Callable[[Task, RobotProfile], Callable[[str], str]]
