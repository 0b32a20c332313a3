"""What a planner is, and the three things that it may answer."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn, Protocol

from fieldhand.errors import RequestError
from fieldhand.language import joined, message
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task.frames import Task
from fieldhand.task.plan import Span


@dataclass(frozen=True, kw_only=True)
class Planned:
    """The request was understood. What the operator should know before approving stands in the Task."""

    task: Task
    planner: str


@dataclass(frozen=True, kw_only=True)
class Clarify:
    """The request can mean two things here: one question, with the answers to choose from.

    Attributes:
        places: For each choice, the places that it would mean; empty for one that nobody knows of yet. Nothing at all
            where the choices do not differ on the map.
        free: Other words than a choice can be an answer; else they are a request of their own.
    """

    question: str
    choices: tuple[str, ...] = ()
    places: tuple[tuple[Place, ...], ...] = ()
    planner: str = ""
    free: bool = False

    @property
    def task(self) -> NoReturn:
        """Raise: a question has no Task.

        Raises:
            RequestError: Always; it holds the question.
        """
        raise RequestError(
            message("a question first: {question}", question=self.question),
            advice=message("answer it: {choices}", choices="; ".join(self.choices))
            if self.choices
            else message("answer it, or say it in the request"),
        )


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What was answered to the question of a planner.

    Attributes:
        answer: One of the choices, or other words where the question takes them.
        assumed: Nobody was asked: the first choice was taken.
    """

    question: str
    answer: str
    assumed: bool = False

    def __str__(self) -> str:
        """A sentence for the assumptions of a Task."""
        return str(self.sentence())

    def sentence(self) -> str:
        """The same as a message, for other languages."""
        fills = {"question": self.question, "answer": self.answer}
        if self.assumed:
            return message('Asked: "{question}" Taken without asking: "{answer}".', context="assumption", **fills)
        return message('Asked: "{question}" Answered: "{answer}".', context="assumption", **fills)


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

    @property
    def task(self) -> NoReturn:
        """Raise: a refused request has no Task.

        Raises:
            RequestError: Always; it holds the reasons.
        """
        raise RequestError(
            joined("; ", [reason.what for reason in self.reasons]),
            advice=joined("; ", [reason.advice for reason in self.reasons if reason.advice]),
        )


Outcome = Planned | Clarify | Refused


@dataclass(frozen=True, kw_only=True)
class PlannerSettings:
    """Settings with which a planner is made.

    Attributes:
        environ: Environment variables; secrets come from nowhere else.
        transcript: File to which prompts and answers of a language model are appended.
        watched: Wraps the connection to a language model, for example to count its answers.
    """

    environ: Mapping[str, str]
    transcript: Path
    watched: Callable[[Any], Any] = lambda chat: chat


class Planner(Protocol):
    """Turns words into a Task, or says why not. Names places; never computes coordinates."""

    def plan(self, request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...] = ()) -> Outcome:
        """Plan one request.

        Args:
            request: What was asked, word for word.
            site: Site that it is for.
            robot: Robot that it is for.
            answers: What was answered to earlier questions about this request, in their order. They stand among the
                assumptions of the Task; its request stays as it was typed.

        Raises:
            RequestError: The request is empty or too long.
            ModelError: A language model was needed and could not be used.
        """
        ...


#: Makes a planner. Distributions register one under a name by an entry point of the group ``fieldhand.planners``.
PlannerFactory = Callable[[PlannerSettings], Planner]
