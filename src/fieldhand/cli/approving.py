"""The approval of a plan at the terminal: it is shown, warnings are confirmed, and the person says yes."""

from __future__ import annotations

import getpass
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Protocol

from fieldhand import mission
from fieldhand.cli import show
from fieldhand.cli.console import working
from fieldhand.cli.inputs import may_ask
from fieldhand.errors import NotApprovedError, NotConfirmedError
from fieldhand.language import Language, Message, counted, joined, message
from fieldhand.language.words import some_names
from fieldhand.mission.documents import SiteAndRobot
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    pass


class Consent(Protocol):
    """How a person's consent is had."""

    @property
    def ask(self) -> bool:
        """Ask the person; else ``confirm`` alone decides about warnings."""
        ...

    @property
    def confirm(self) -> bool:
        """Every warning is confirmed without asking."""
        ...

    @property
    def by(self) -> str | None:
        """Who approves; None for the user who is logged in."""
        ...

    @property
    def quiet(self) -> bool:
        """Show nothing."""
        ...

    @property
    def language(self) -> Language:
        """In which the plan is read."""
        ...


def review_plan(ground: SiteAndRobot, task: Task, document: bytes | None, consent: Consent) -> mission.Review:
    """Check a Task and show what it will do.

    Raises:
        NotApprovedError: A check fails.
    """
    with working(message("Checking ..."), None if consent.quiet else consent.language):
        review = mission.review(task, ground.site, ground.robot, document=document)
    if not consent.quiet:
        show.show_review(review, consent.language)
        if review.errors:
            raise NotApprovedError(message("not approved: mend the errors above first"))
    elif review.errors:
        raise NotApprovedError(some_names([p.line() for p in review.errors], 3, "; "))
    return review


def approve_plan(review: mission.Review, consent: Consent, question: Message) -> mission.ApprovedMission:
    """Have the warnings confirmed and the plan approved.

    Args:
        review: As it was shown.
        consent: Whose it is, and how it is asked for.
        question: What a person is asked at the end.

    Raises:
        NotConfirmedError: There are warnings, and nobody is asked about them.
        NotApprovedError: The person says no, or nobody is there.
    """
    if consent.ask and not may_ask():
        raise NotApprovedError(
            message("nobody is here to approve"), advice=message("give --yes if you have read the plan")
        )
    if review.warnings and not consent.confirm:
        _confirm(consent.language.read(review.warnings), consent)
    if consent.ask:
        _ask(question, consent.language)
    return mission.authorize(
        review,
        by=consent.by or user_name(),
        at=datetime.now(UTC),
        confirmed=consent.language.read(review.warnings),
        language=consent.language.code,
    )


def _confirm(warnings: tuple[str, ...], consent: Consent) -> None:
    """Have the operator confirm the warnings; they were shown with the review.

    Raises:
        NotConfirmedError: Nobody is asked.
        NotApprovedError: The operator says no.
    """
    if not consent.ask:
        raise NotConfirmedError(
            message("not confirmed: {warnings}", warnings=joined("; ", warnings)),
            warnings,
            advice=message("give --confirm, too, if the plan is right in spite of that"),
        )
    question = counted(
        "Is the plan right in spite of the warning above?",
        "Is the plan right in spite of the {count} warnings above?",
        len(warnings),
    )
    _ask(question, consent.language)


def _ask(question: str, language: Language) -> None:
    """Ask a question until it is answered with yes or no, in that language or in English; nothing typed is no.

    Raises:
        NotApprovedError: The answer is no.
        Abort: The input has ended.
    """
    import typer

    yes, no = message("yes"), message("no")
    short = message("y/N", context="yes or no")
    letters = zip(language.say(short).lower().split("/"), short.lower().split("/"), strict=True)
    agreed, declined = ({*both, language.say(said), said} for both, said in zip(letters, (yes, no), strict=True))
    while True:
        said = typer.prompt(f"\n{language.say(question)} [{language.say(short)}]", default="", show_default=False)
        if said.strip().lower() in agreed:
            return
        if said.strip().lower() in declined | {""}:
            raise NotApprovedError(message("not approved, nothing was done"))
        show.err.print(language.say(message("answer yes or no")))


def user_name() -> str:
    """Who is logged in."""
    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return "unknown"
