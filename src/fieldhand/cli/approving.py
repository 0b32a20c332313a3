"""Approval of a plan at the terminal: print the review, ask for each confirmation, and authorize the Task."""

from __future__ import annotations

import getpass
from datetime import datetime

from fieldhand import mission
from fieldhand.cli import show
from fieldhand.cli.console import working
from fieldhand.cli.inputs import may_ask
from fieldhand.cli.options import ApprovalOptions, DisplayOptions
from fieldhand.compatibility import UTC
from fieldhand.errors import NotApprovedError, NotConfirmedError
from fieldhand.language import Language, Message, counted, joined, message
from fieldhand.language.words import some_names
from fieldhand.mission.documents import SiteAndRobot
from fieldhand.task.frames import Task


def review_plan(
    site_and_robot: SiteAndRobot, task: Task, document: bytes | None, display: DisplayOptions
) -> mission.Review:
    """Check a Task and print its review.

    Raises:
        NotApprovedError: A check failed.
    """
    with working(message("Checking ..."), display.progress):
        review = mission.review(task, site_and_robot.site, site_and_robot.robot, document=document)
    if not display.json:
        show.show_review(review, display.language)
        if review.errors:
            raise NotApprovedError(message("not approved: correct the errors above first"))
    elif review.errors:
        raise NotApprovedError(some_names([p.line() for p in review.errors], 3, "; "))
    return review


def approve_plan(
    review: mission.Review, approval: ApprovalOptions, display: DisplayOptions, question: Message
) -> mission.ApprovedMission:
    """Ask the operator to confirm the warnings and to approve the plan.

    Args:
        review: Review that was printed.
        approval: Name of the operator, and what is approved without asking.
        display: Language of the questions.
        question: Last question to the operator.

    Raises:
        NotConfirmedError: There are warnings, and the operator may not be asked about them.
        NotApprovedError: The operator declines, or standard input is not a terminal.
    """
    ask, language = not approval.yes, display.language
    if ask and not may_ask():
        raise NotApprovedError(
            message("approval needs a terminal to ask at"), advice=message("give --yes if you have read the plan")
        )
    if review.warnings and not approval.confirm:
        _confirm(language.read(review.warnings), language, ask=ask)
    if ask:
        _ask(question, language)
    return mission.authorize(
        review,
        by=approval.by or user_name(),
        at=datetime.now(UTC),
        confirmed=language.read(review.warnings),
        language=language.code,
    )


def _confirm(warnings: tuple[str, ...], language: Language, *, ask: bool) -> None:
    """Ask the operator to confirm the warnings that the review lists.

    Raises:
        NotConfirmedError: The operator may not be asked.
        NotApprovedError: The operator declines.
    """
    if not ask:
        raise NotConfirmedError(
            message("not confirmed: {warnings}", warnings=joined("; ", warnings)),
            warnings,
            advice=message("give --confirm as well if the plan is right in spite of that"),
        )
    question = counted(
        "Is the plan right in spite of the warning above?",
        "Is the plan right in spite of the {count} warnings above?",
        len(warnings),
    )
    _ask(question, language)


def _ask(question: str, language: Language) -> None:
    """Ask a question until the answer is yes or no, in the given language or in English; an empty answer is no.

    Raises:
        NotApprovedError: The answer is no.
        Abort: Standard input ended.
    """
    import typer

    yes, no = message("yes"), message("no")
    short = message("y/N", context="yes or no")
    letters = zip(language.say(short).lower().split("/"), short.lower().split("/"), strict=True)
    agreed, declined = ({*both, language.say(word), word} for both, word in zip(letters, (yes, no), strict=True))
    while True:
        answer = typer.prompt(f"\n{language.say(question)} [{language.say(short)}]", default="", show_default=False)
        if answer.strip().lower() in agreed:
            return
        if answer.strip().lower() in declined | {""}:
            raise NotApprovedError(message("not approved, nothing was done"))
        show.err.print(language.say(message("answer yes or no")))


def user_name() -> str:
    """Return the name of the user who is logged in."""
    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return "unknown"
