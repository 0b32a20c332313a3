"""What a planner is, and the three things that it may answer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task
from fieldhand.task.plan import Span


@dataclass(frozen=True, kw_only=True)
class Planned:
    """The request was understood.

    Attributes:
        warnings: What the operator should know before approving, as sentences.
    """

    task: Task
    planner: str
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Clarify:
    """The request can mean two things here: one question, with the answers to choose from (none: any words)."""

    question: str
    choices: tuple[str, ...] = ()
    planner: str = ""


@dataclass(frozen=True, kw_only=True)
class Reason:
    """Why a request was refused: what, where in the request (character ranges), and how to say it instead."""

    what: str
    said: tuple[Span, ...] = ()
    advice: str = ""


@dataclass(frozen=True, kw_only=True)
class Refused:
    """The request was not understood, or cannot be done with this robot on this site."""

    reasons: tuple[Reason, ...]
    planner: str = ""


Outcome = Planned | Clarify | Refused


class Planner(Protocol):
    """Turns words into a Task, or says why not. Names places; never computes coordinates."""

    def plan(self, request: str, site: Site, robot: RobotProfile) -> Outcome:
        """Plan one request.

        Raises:
            RequestError: The request is empty or too long.
            ModelError: A language model was needed and could not be used.
        """
        ...
