"""The planner protocol and its three outcomes: planned, a clarifying question, or refused."""

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
    """The outcome of an understood request (``fh.Planned``).

    Attributes:
        task: Task to review and approve; assumptions and warnings of the planner are part of it.
        planner: Name of the planner that made it.
    """

    task: Task
    planner: str


@dataclass(frozen=True, kw_only=True)
class Clarify:
    """The outcome of an ambiguous request: one question with its choices (``fh.Clarify``).

    Answer it by planning the request again with an :class:`Answer`.

    Example:
        >>> outcome = planner.plan(request, site, robot)
        >>> if isinstance(outcome, Clarify):
        ...     answer = Answer(question=outcome.question, answer=outcome.choices[0])
        ...     outcome = planner.plan(request, site, robot, (answer,))

    Attributes:
        question: The question, as a sentence.
        choices: Answers to choose from; empty for an open question.
        places: Places that each choice would select, in the order of ``choices``; empty for a choice whose places are
            unknown so far, and an empty tuple if the choices do not differ on the map.
        planner: Name of the planner that asks.
        free: An answer may use words other than a choice; otherwise such words are treated as a new request.
        otherwise: Refusal that stands unless somebody gives a choice; no choice may then be taken without asking. None
            for a question between readings.
    """

    question: str
    choices: tuple[str, ...] = ()
    places: tuple[tuple[Place, ...], ...] = ()
    planner: str = ""
    free: bool = False
    otherwise: Refused | None = None

    @property
    def task(self) -> NoReturn:
        """Raise, because a question has no Task.

        Raises:
            RequestError: Always; the message contains the question.
        """
        raise RequestError(
            message("a question first: {question}", question=self.question),
            advice=message("answer it: {choices}", choices="; ".join(self.choices))
            if self.choices
            else message("answer it, or write it in the request"),
        )


@dataclass(frozen=True, kw_only=True)
class Answer:
    """An answer to a planner's question (``fh.Answer``), recorded among the assumptions of the Task.

    Attributes:
        question: The question, as in :attr:`Clarify.question`.
        answer: One of the choices, or other words if :attr:`Clarify.free` is set.
        assumed: The first choice was taken without asking anybody.
    """

    question: str
    answer: str
    assumed: bool = False

    def __str__(self) -> str:
        """Return the sentence for the assumptions of a Task."""
        return str(self.sentence())

    def sentence(self) -> str:
        """Return the sentence for the assumptions of a Task as a translatable message."""
        fills = {"question": self.question, "answer": self.answer}
        if self.assumed:
            return message('Asked: "{question}" Taken without asking: "{answer}".', context="assumption", **fills)
        return message('Asked: "{question}" Answered: "{answer}".', context="assumption", **fills)


@dataclass(frozen=True, kw_only=True)
class Reason:
    """A reason for refusing a request.

    Attributes:
        what: Description of the problem.
        said: Character ranges of the request that caused it: start, and end (exclusive).
        advice: Suggested wording or remedy; empty if there is none.
        unknown: True if the planner does not know these words; False if it knows them and cannot do what they say.
        final: True if neither other words nor a language model can help: the plan, the robot or the site lacks it.
        instead: Name of the site that can stand in place of the words; empty if there is none.
    """

    what: str
    said: tuple[Span, ...] = ()
    advice: str = ""
    unknown: bool = False
    final: bool = False
    instead: str = ""


@dataclass(frozen=True, kw_only=True)
class Refused:
    """The outcome of a request that is not understood, or impossible with this robot on this site (``fh.Refused``).

    Attributes:
        reasons: Reasons for the refusal, at least one.
        planner: Name of the planner that refused.
        understood: The parts of the request that were understood, in the words of the read-back.
        example: A request about these parts that can be planned on this site with this robot; empty if there is none.
    """

    reasons: tuple[Reason, ...]
    planner: str = ""
    understood: tuple[str, ...] = ()
    example: str = ""

    @property
    def task(self) -> NoReturn:
        """Raise, because a refused request has no Task.

        Raises:
            RequestError: Always; the message contains the reasons.
        """
        advice = [reason.advice for reason in self.reasons if reason.advice]
        if self.example:
            advice.append(message("for example: '{example}'", example=self.example))
        raise RequestError(joined("; ", [reason.what for reason in self.reasons]), advice=joined("; ", advice))


Outcome = Planned | Clarify | Refused


@dataclass(frozen=True, kw_only=True)
class PlannerSettings:
    """Settings for creating a planner.

    Attributes:
        environ: Environment variables, the only source of secrets.
        transcript: File to which prompts and answers of a language model are appended.
        watched: Function that wraps the connection to a language model, for example to count its answers.
    """

    environ: Mapping[str, str]
    transcript: Path
    watched: Callable[[Any], Any] = lambda chat: chat


class Planner(Protocol):
    """A planner converts a request to a Task, a question or a refusal (``fh.Planner``).

    Plans name places by selectors; a planner never computes coordinates.
    """

    def plan(self, request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...] = ()) -> Outcome:
        """Plan one request.

        Args:
            request: The request as typed.
            site: Site of the mission.
            robot: Robot that executes it.
            answers: Answers to earlier questions about this request, in order. They become assumptions of the Task; its
                request remains as typed.

        Raises:
            RequestError: The request is empty or too long.
            ModelError: A language model was needed and could not be used.
        """
        ...


#: Function that creates a planner; distributions register one by an entry point of the group ``fieldhand.planners``.
PlannerFactory = Callable[[PlannerSettings], Planner]
