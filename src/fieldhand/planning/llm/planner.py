"""Plan with a language model: ask, parse the answer, check it, and request a limited number of repairs.

A usable plan that contradicts the request is returned to the model once. If the contradiction remains, the operator
receives the plan with a warning for each contradiction, since the model may be right.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from datetime import datetime
from pathlib import Path

from fieldhand.errors import ModelError, RequestError
from fieldhand.language import joined, message
from fieldhand.planning.homeward import faulted_exits, usual_exit, with_assumed_exit
from fieldhand.planning.llm.answer import QuestionAnswer, RefusalAnswer, TaskAnswer, Unusable, read_answer
from fieldhand.planning.llm.chat import Chat, ChatMessage, Reply
from fieldhand.planning.llm.coordinates import coordinates
from fieldhand.planning.llm.display_text import visible_line
from fieldhand.planning.llm.prompt import answered, opening, repair
from fieldhand.planning.llm.request_contradictions import request_contradictions
from fieldhand.planning.llm.review import AnswerProblem, read_draft, review
from fieldhand.planning.llm.settings import LlmSettings
from fieldhand.planning.llm.transcript import TranscriptWriter, wall_clock
from fieldhand.planning.llm.transport import ModelChat
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Reason, Refused
from fieldhand.robot.capabilities import capabilities_of, measures_of
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.build import make_task
from fieldhand.task.codec import TaskDraft
from fieldhand.task.codec_text import hidden_character
from fieldhand.task.frames import Resource

#: Maximum length of a request in characters; a longer one is probably a wrong file and would cost tokens.
LONGEST_REQUEST = 8_000
#: Maximum number of problems sent back to the model or listed in an error.
MOST_PROBLEMS = 12
#: Maximum length of a model's assumption in characters.
LONGEST_ASSUMPTION = 400


@dataclass(frozen=True, kw_only=True)
class _Understood:
    """Result of parsing a reply: an outcome, a list of problems, or both for a plan with doubts."""

    outcome: Outcome | None = None
    problems: tuple[AnswerProblem, ...] = ()


class LlmPlanner:
    """Planner that uses a language model.

    The model names places and never computes them; it writes a draft that is checked against the robot's schema and the
    site before anyone sees it. Ids, goals and the words of the request are added by the program.

    Args:
        settings: Model and request settings.
        transcript: File to which every exchange is appended; None for no transcript.
        chat: Connection to the model; by default created from ``settings``.
        now: Returns the current time, for the transcript.
        note: Origin of the transcript, stored in its first line.
    """

    def __init__(
        self,
        settings: LlmSettings,
        transcript: Path | None = None,
        *,
        chat: Chat | None = None,
        now: Callable[[], datetime] = wall_clock,
        note: str = "",
    ) -> None:
        self._settings = settings
        self._chat = chat or ModelChat(settings)
        self._transcript = TranscriptWriter(transcript, now, settings.redact)
        self._transcript_path = transcript
        self._note = note

    def plan(self, request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...] = ()) -> Outcome:
        """Plan one request; the operator's answers are sent to the model after the questions.

        Raises:
            RequestError: The request is empty or too long.
            ModelError: The model is unreachable, or none of its answers is usable.
            OutputError: The transcript cannot be written.
        """
        _check(request)
        self._transcript.begin(
            request,
            planner=self._settings.name,
            provider=self._settings.provider,
            endpoint=self._settings.endpoint,
            temperature=self._settings.temperature,
            site={"name": site.name, "sha256": site.sha256},
            robot={"name": robot.name, "sha256": robot.sha256},
            note=self._note,
            **({"answers": [asdict(answer) for answer in answers]} if answers else {}),
        )
        try:
            outcome = self._converse(request, site, robot, answers)
        except ModelError as error:
            self._transcript.end("failed", self._settings.redact(str(error)))
            raise
        self._transcript.end(type(outcome).__name__.lower())
        return outcome

    def _converse(self, request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...]) -> Outcome:
        """Ask until an answer is usable, with at most ``repairs`` further attempts."""
        talk: list[ChatMessage] = [*opening(request, site, robot), *answered(answers)]
        new: Sequence[ChatMessage] = talk
        doubted: Outcome | None = None
        problems: tuple[AnswerProblem, ...] = ()
        for tries_left in range(self._settings.repairs, -1, -1):
            reply = self._chat.ask(talk)
            understood = self._understand(reply, request, site, robot, answers)
            outcome, problems = understood.outcome, understood.problems
            reported = problems[:MOST_PROBLEMS]
            self._transcript.exchange(list(new), reply, [str(problem) for problem in reported])
            if outcome is not None and (not problems or doubted is not None or not tries_left):
                return outcome
            doubted = outcome or doubted
            if tries_left:
                new = (repair(reported, tries_left),)
                # Endpoints reject an assistant message without text.
                talk += [ChatMessage(role="assistant", text=reply.text.strip() or "(nothing)"), *new]
        if doubted is not None:
            return doubted
        raise self._unusable(problems)

    def _understand(
        self, reply: Reply, request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...]
    ) -> _Understood:
        """Parse and check a reply."""
        name = self._settings.name
        answer = read_answer(reply)
        match answer:
            case Unusable():
                return _Understood(
                    problems=(AnswerProblem(kind="answer", message=answer.reason, truncated=answer.truncated),)
                )
            case QuestionAnswer():
                question = Clarify(question=answer.question, choices=answer.choices, planner=name, free=True)
                return _Understood(outcome=question)
            case RefusalAnswer():
                return _Understood(outcome=Refused(reasons=(Reason(what=answer.reason),), planner=name))
            case TaskAnswer():
                capabilities = capabilities_of(robot)
                draft = read_draft(answer.document, capabilities, request)
                if isinstance(draft, tuple):
                    return _Understood(problems=draft)
                problems = (*review(draft, site, capabilities), *coordinates(draft, request, site))
                if problems:
                    return _Understood(problems=problems)
                planned = _planned(draft, request, site, robot, name, answers)
                return _Understood(outcome=planned, problems=request_contradictions(planned.task, draft, site, robot))

    def _unusable(self, problems: Sequence[AnswerProblem]) -> ModelError:
        """Return the error for the last failed attempt, with its problems."""
        shown = "; ".join(str(problem) for problem in problems[:MOST_PROBLEMS])
        advice: str = message("say the request in other words, or use a larger model")
        if any(problem.truncated for problem in problems):
            advice = message("set FIELDHAND_MODEL_MAX_TOKENS higher, or give the model a larger context")
        if self._transcript_path is not None:
            kept = message("{file} contains the whole conversation", file=str(self._transcript_path))
            advice = joined("; ", (advice, kept))
        tries = self._settings.repairs + 1
        return ModelError(
            message(
                "none of {tries} answers could be used; the last had these problems: {shown}", tries=tries, shown=shown
            ),
            where=f"{self._settings.name} at {self._settings.endpoint}",
            advice=advice,
        )


def _check(request: str) -> None:
    if not request.strip():
        raise RequestError(
            message("the request is empty"),
            advice=message('say what the robot should do, such as "take a picture at ..."'),
        )
    if len(request) > LONGEST_REQUEST:
        raise RequestError(
            message(
                "the request has {count} characters, more than {most}",
                count=len(request),
                most=LONGEST_REQUEST,
            ),
            advice=message("say it in fewer words, or in several requests"),
        )
    odd = hidden_character(request, lines=True)
    if odd is not None:
        what = message("the request contains the invisible character {odd}", odd=odd)
        raise RequestError(what, advice=message("leave it out"))


def _planned(
    draft: TaskDraft, request: str, site: Site, robot: RobotProfile, name: str, answers: tuple[Answer, ...]
) -> Planned:
    usual = usual_exit(site)
    asked = bool(draft.nominal_said) or draft.nominal not in ("return_to_end", usual)
    nominal = draft.nominal if asked else usual
    task = make_task(
        request=request,
        plan=draft.plan,
        measures=measures_of(robot),
        resources=(
            Resource(kind="robot", name=robot.name, sha256=robot.sha256),
            Resource(kind="site", name=site.name, sha256=site.sha256),
        ),
        constraints=draft.constraints,
        nominal=nominal,
        faulted=draft.faulted or faulted_exits(nominal),
        assumptions=(*map(str, answers), *(visible_line(text, LONGEST_ASSUMPTION) for text in draft.assumptions)),
        nominal_said=draft.nominal_said,
        no_part=draft.no_part,
        read_as="\n".join([f"{request}.", *(f"{answer.answer}." for answer in answers)]) if answers else "",
        warnings=tuple(visible_line(text, LONGEST_ASSUMPTION) for text in draft.warnings),
        timing=draft.timing,
        watches=draft.watches,
    )
    return Planned(task=task if asked else with_assumed_exit(task, site, robot), planner=name)
