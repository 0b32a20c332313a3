"""Planning with questions, which are answered by ``--answer``, by their first choice, or at the terminal."""

from __future__ import annotations

import os
import shlex
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from fieldhand import mission
from fieldhand.cli.bundles import is_bundle
from fieldhand.cli.console import Words, err, working
from fieldhand.cli.inputs import may_ask
from fieldhand.cli.options import DisplayOptions, PlanningOptions
from fieldhand.cli.show import fail_outcome, show_question
from fieldhand.errors import InputError, RequestError
from fieldhand.files import STANDARD, FileFault, read_file
from fieldhand.language import ENGLISH, Language, message, recalled
from fieldhand.language.words import some_names
from fieldhand.mission.documents import SiteAndRobot
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Planner
from fieldhand.task.frames import Task

#: Largest number of questions about one request; a planner that asks more often does not terminate.
MOST_QUESTIONS = 12
#: Largest request or Task on standard input, in bytes.
_MOST = 4_000_000
#: Number of bytes by which the kind of a file is recognized.
_ENOUGH = 200


@dataclass(frozen=True, kw_only=True)
class Replies:
    """The answers to the questions of a planner.

    Attributes:
        given: Answers in the order of the questions.
        assume: Take the first choice if no answer is given, and list it among the assumptions.
        ask: Ask at the terminal, if there is one.
        draw: Draws a question that is asked at the terminal or stays unanswered.
        progress: Language of progress messages; None for no messages.
        language: Language of questions and refusals.
    """

    given: tuple[str, ...] = ()
    assume: bool = False
    ask: bool = True
    draw: Callable[[Clarify], None] = lambda _: None
    progress: Language | None = None
    language: Language = ENGLISH

    @classmethod
    def of(
        cls, planning: PlanningOptions, display: DisplayOptions, draw: Callable[[Clarify], None] = lambda _: None
    ) -> Replies:
        """Return the replies that the options of a command describe; with JSON, questions stay unanswered."""
        return cls(
            given=tuple(planning.answer or ()),
            assume=planning.assume,
            ask=not display.json,
            draw=draw,
            progress=display.progress,
            language=display.language,
        )


def plan_and_ask(request: str, site_and_robot: SiteAndRobot, planner: Planner, replies: Replies) -> tuple[str, Outcome]:
    """Plan a request, and answer the questions of the planner.

    Returns:
        The request that was planned, which an answer may have replaced, and the outcome; the outcome is a question if
        it stays unanswered.

    Raises:
        RequestError: The request is the name of a file, an answer fits no question, or there are too many questions.
    """
    _require_words(request)
    given = list(replies.given)
    answers: tuple[Answer, ...] = ()
    for _ in range(MOST_QUESTIONS + 1):
        with working(message("Planning ..."), replies.progress):
            outcome = mission.plan(request, site_and_robot.site, site_and_robot.robot, planner, answers)
        if not isinstance(outcome, Clarify):
            if given and isinstance(outcome, Planned):
                what = message("no question was asked to which '{given}' is an answer", given=given[0])
                raise RequestError(what, where="--answer", advice=message("leave it out, or write it in the request"))
            return request, outcome
        assumed = False
        if given:
            reply = given.pop(0)
        elif replies.assume and outcome.otherwise is not None:
            return request, outcome.otherwise
        elif replies.assume and outcome.choices:
            reply, assumed = outcome.choices[0], True
        elif replies.ask and may_ask():
            replies.draw(outcome)
            reply = _ask(outcome, sys.stdin.readline, replies.language)
        else:
            replies.draw(outcome)
            return request, outcome
        choice = _choice(reply, outcome, replies.language)
        if choice is not None or outcome.free:
            answers = (*answers, Answer(question=outcome.question, answer=choice or reply, assumed=assumed))
        elif replies.given:
            raise RequestError(
                message("'{said}' does not answer '{question}'", said=reply, question=outcome.question),
                where="--answer",
                advice=message("give one of: {choices}", choices=some_names(outcome.choices, 12, "; "))
                if outcome.choices
                else message("write it in the request"),
            )
        else:
            request, answers = reply, ()
    raise RequestError(
        message("no plan after {count} questions", count=MOST_QUESTIONS),
        advice=message("say the request in other words"),
    )


def plan_or_read(
    words: str, site_and_robot: SiteAndRobot, planner: str, transcript: Path | None, replies: Replies
) -> tuple[Task, bytes | None, str]:
    """Plan a request, or read a Task document if ``words`` is the name of an ``.xml`` file.

    Ends the program with status 2 if the planner refuses the request, or asks a question that stays unanswered.

    Returns:
        The Task, the bytes of its document if it was read, and the name of its planner.
    """
    if words == str(STANDARD):
        typed = given_words(words)
        if typed.lstrip("\ufeff").lstrip().startswith("<"):
            require_no_answer(replies.given, "standard input")
            document = typed.encode()
            return mission.decode_task(document, site_and_robot.robot, source="standard input"), document, "file"
        words = typed
    if is_bundle(words):
        what = message("is a signed mission, neither a request nor a Task")
        raise InputError(
            what, where=words, advice=message("show its contents with fieldhand inspect, or run it with fieldhand run")
        )
    if words.lower().endswith(".xml") and "\n" not in words:
        require_no_answer(replies.given, words)
        task, document = mission.read_task(Path(words), site_and_robot.robot)
        return task, document, "file"
    words, outcome = plan_and_ask(words, site_and_robot, mission.make_planner(planner, os.environ, transcript), replies)
    if not isinstance(outcome, Planned):
        fail_outcome(words, outcome, replies.language)
    return outcome.task, None, outcome.planner


def given_words(words: str) -> str:
    """Return a request, read from standard input if it is ``-``.

    Raises:
        RequestError: Standard input is not text.
    """
    if words != str(STANDARD):
        return words
    try:
        return read_file(STANDARD, _MOST).decode().strip()
    except (FileFault, UnicodeDecodeError) as fault:
        what = recalled(fault.what, "file") if isinstance(fault, FileFault) else message("is not UTF-8 text")
        raise RequestError(what, where="standard input", advice=message("write a request or a Task to it")) from None


def require_no_answer(given: Sequence[str], words: str) -> None:
    """Require that no answers are given for a mission that is planned already.

    Raises:
        InputError: There are some.
    """
    if given:
        what = message(
            "{words} is already planned, and there is no question to which '{given}' is an answer",
            words=words,
            given=given[0],
        )
        raise InputError(what, where="--answer", advice=message("leave it out"))


def _require_words(request: str) -> None:
    """Require that a request is not the name of a file.

    Raises:
        RequestError: It is; the error names the kind of the file.
    """
    path = Path(request)
    try:
        if not path.is_file():
            return
        with path.open("rb") as file:
            begins = file.read(_ENOUGH)
    except (OSError, ValueError):
        return  # not a file name, or not readable: a request
    if begins.startswith(b"PK"):
        what, advice = (
            message("is a zip file, perhaps a signed mission, not what the robot should do"),
            message("pass a signed mission (.mission) to fieldhand run"),
        )
    elif begins.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"<"):
        what = message("is an XML file, not what the robot should do")
        advice = message("pass a Task (.xml) to fieldhand check, approve or run")
    elif begins.lstrip().startswith(b"{"):
        what = message("is a JSON file, not what the robot should do")
        advice = message("pass a site with --site, or an event log to fieldhand report")
    else:
        what, advice = (
            message("is a file, not what the robot should do"),
            message('give the words in the file: "$(cat {file})"', file=shlex.quote(request)),
        )
    raise RequestError(what, where=request, advice=advice)


def _ask(question: Clarify, read: Callable[[], str], language: Language) -> str:
    """Print a question at the terminal and return the answer."""
    show_question(question, language)
    other = message("other words") if question.free else message("the whole request in other words")
    if len(question.choices) > 1:
        wanted = message("1 to {count}, or {other}: ", count=len(question.choices), other=other)
    else:
        wanted = message("1, or {other}: ", other=other) if question.choices else message("{other}: ", other=other)
    err.print(Words(language.say(wanted)), end="")
    try:
        reply = read().strip()
    except KeyboardInterrupt:
        reply = ""
    if not reply:
        raise RequestError(
            message("no answer was given, nothing was planned"), advice=message("answer, or write it in the request")
        )
    return reply


def _choice(reply: str, question: Clarify, language: Language) -> str | None:
    """Return the choice that an answer names by its text or its number; text first, as a choice may be a number."""
    typed = reply.strip().lower()
    named = [choice for choice in question.choices if typed in (choice.lower(), language.say(choice).lower())]
    if named:
        return named[0]
    number = int(reply) if reply.strip().isdecimal() else 0
    return question.choices[number - 1] if 0 < number <= len(question.choices) else None
