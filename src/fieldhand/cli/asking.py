"""Planning with questions: each is answered by what was given for it, by its first choice, or by the person there."""

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

#: A planner that has asked so often about one request goes round in circles.
MOST_QUESTIONS = 12
#: Bytes of a request or a Task on standard input.
_MOST = 4_000_000
#: Bytes that show what kind of file it is.
_ENOUGH = 200


@dataclass(frozen=True, kw_only=True)
class Replies:
    """How questions are answered.

    Attributes:
        given: Answers in the order in which they are used.
        assume: Take the first choice where no answer is given, and say so among the assumptions.
        ask: Ask the person at the terminal where there is one.
        draw: Draws a question that is put to a person, or that nobody answers.
        progress: In which language a terminal is told that the program is planning; None to say nothing.
        language: In which questions are asked and refusals said.
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
        """Return the replies that the options of a command describe; nobody is asked where JSON is printed."""
        return cls(
            given=tuple(planning.answer or ()),
            assume=planning.assume,
            ask=not display.json,
            draw=draw,
            progress=display.progress,
            language=display.language,
        )


def plan_and_ask(request: str, ground: SiteAndRobot, planner: Planner, replies: Replies) -> tuple[str, Outcome]:
    """Plan a request, one question after the other.

    Returns:
        The request that was planned in the end (another one where a question was answered by one) and its outcome; a
        question, where nobody answers it.

    Raises:
        RequestError: It is the name of a file, an answer is none or answers no question, or there was no end of
            questions.
    """
    _require_words(request)
    given = list(replies.given)
    answers: tuple[Answer, ...] = ()
    for _ in range(MOST_QUESTIONS + 1):
        with working(message("Planning ..."), replies.progress):
            outcome = mission.plan(request, ground.site, ground.robot, planner, answers)
        if not isinstance(outcome, Clarify):
            if given and isinstance(outcome, Planned):
                what = message("nothing was asked that '{given}' answers", given=given[0])
                raise RequestError(what, where="--answer", advice=message("leave it out, or say it in the request"))
            return request, outcome
        assumed = False
        if given:
            said = given.pop(0)
        elif replies.assume and outcome.choices:
            said, assumed = outcome.choices[0], True
        elif replies.ask and may_ask():
            replies.draw(outcome)
            said = _asked(outcome, sys.stdin.readline, replies.language)
        else:
            replies.draw(outcome)
            return request, outcome
        choice = _choice(said, outcome, replies.language)
        if choice is not None or outcome.free:
            answers = (*answers, Answer(question=outcome.question, answer=choice or said, assumed=assumed))
        elif replies.given:
            raise RequestError(
                message("'{said}' does not answer '{question}'", said=said, question=outcome.question),
                where="--answer",
                advice=message("give one of: {choices}", choices=some_names(outcome.choices, 12, "; "))
                if outcome.choices
                else message("say it in the request"),
            )
        else:
            request, answers = said, ()
    raise RequestError(
        message("no plan after {count} questions", count=MOST_QUESTIONS),
        advice=message("say the request in other words"),
    )


def plan_or_read(
    words: str, ground: SiteAndRobot, planner: str, transcript: Path | None, replies: Replies
) -> tuple[Task, bytes | None, str]:
    """The Task of a request, or of a Task document if ``words`` is a file that ends in ``.xml``; and who planned it.

    Ends the program with status 2 where the planner refuses, or has a question that nobody answers.
    """
    if words == str(STANDARD):
        typed = given_words(words)
        if typed.lstrip("\ufeff").lstrip().startswith("<"):
            require_no_answer(replies.given, "standard input")
            document = typed.encode()
            return mission.decode_task(document, ground.robot, source="standard input"), document, "file"
        words = typed
    if is_bundle(words):
        what = message("is a signed mission, neither a request nor a Task")
        raise InputError(
            what, where=words, advice=message("say what is in it with fieldhand inspect, carry it out with run")
        )
    if words.lower().endswith(".xml") and "\n" not in words:
        require_no_answer(replies.given, words)
        task, document = mission.read_task(Path(words), ground.robot)
        return task, document, "file"
    words, outcome = plan_and_ask(words, ground, mission.make_planner(planner, os.environ, transcript), replies)
    if not isinstance(outcome, Planned):
        fail_outcome(words, outcome, replies.language)
    return outcome.task, None, outcome.planner


def given_words(words: str) -> str:
    """Return the words of a request, those on standard input where ``-`` is given.

    Raises:
        RequestError: They are not text.
    """
    if words != str(STANDARD):
        return words
    try:
        return read_file(STANDARD, _MOST).decode().strip()
    except (FileFault, UnicodeDecodeError) as fault:
        what = recalled(fault.what, "file") if isinstance(fault, FileFault) else message("is not UTF-8 text")
        raise RequestError(what, where="standard input", advice=message("write a request or a Task to it")) from None


def require_no_answer(given: Sequence[str], words: str) -> None:
    """Refuse answers beside a file that holds a plan: nothing is asked about it.

    Raises:
        InputError: There are some.
    """
    if given:
        what = message(
            "{words} is planned already, nothing is asked that '{given}' answers", words=words, given=given[0]
        )
        raise InputError(what, where="--answer", advice=message("leave it out"))


def _require_words(request: str) -> None:
    """Refuse the name of a file where the words themselves are wanted, and say what it seems to be.

    Raises:
        RequestError: There is such a file.
    """
    path = Path(request)
    try:
        if not path.is_file():
            return
        with path.open("rb") as file:
            begins = file.read(_ENOUGH)
    except (OSError, ValueError):
        return  # no name that a file can have, or none that may be read: words, then
    if begins.startswith(b"PK"):
        what, advice = (
            message("is a zip file, perhaps a signed mission, not what the robot should do"),
            message("give a signed mission, whose name ends in .mission, to run"),
        )
    elif begins.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"<"):
        what = message("is an XML file, not what the robot should do")
        advice = message("give a Task, whose name ends in .xml, to check, approve or run")
    elif begins.lstrip().startswith(b"{"):
        what = message("is a JSON file, not what the robot should do")
        advice = message("give a site with --site, an event log to fieldhand report")
    else:
        what, advice = (
            message("is a file, not what the robot should do"),
            message('give the words that stand in it: "$(cat {file})"', file=shlex.quote(request)),
        )
    raise RequestError(what, where=request, advice=advice)


def _asked(asked: Clarify, read: Callable[[], str], language: Language) -> str:
    """One question at the terminal, and what was typed."""
    show_question(asked, language)
    other = message("other words") if asked.free else message("the whole request in other words")
    if len(asked.choices) > 1:
        wanted = message("1 to {count}, or {other}: ", count=len(asked.choices), other=other)
    else:
        wanted = message("1, or {other}: ", other=other) if asked.choices else message("{other}: ", other=other)
    err.print(Words(language.say(wanted)), end="")
    try:
        said = read().strip()
    except KeyboardInterrupt:
        said = ""
    if not said:
        raise RequestError(
            message("no answer was given, nothing was planned"), advice=message("answer, or say it in the request")
        )
    return said


def _choice(said: str, asked: Clarify, language: Language) -> str | None:
    """The choice that a number or its own words name. Words come first: a choice may be a number itself."""
    typed = said.strip().lower()
    named = [choice for choice in asked.choices if typed in (choice.lower(), language.say(choice).lower())]
    if named:
        return named[0]
    number = int(said) if said.strip().isdecimal() else 0
    return asked.choices[number - 1] if 0 < number <= len(asked.choices) else None
