"""The approval itself: the one place that makes an ``AuthorizedTask`` (a test holds every other module to that)."""

from __future__ import annotations

import hashlib
from collections.abc import Container
from datetime import datetime

from fieldhand.approval.checks import Examination
from fieldhand.errors import NotApprovedError, NotConfirmedError
from fieldhand.language import joined, message, open_language
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.authorization import Authorization, AuthorizedTask
from fieldhand.task.codec import encode
from fieldhand.task.frames import Task


class EveryWarning(Container[str]):
    """Confirms whatever is warned of: for experiments, in which nobody is there to read."""

    def __contains__(self, warning: object) -> bool:
        return True


def approve(
    examined: Examination,
    *,
    by: str,
    at: str,
    confirmed: Container[str] = (),
    language: str = "en",
) -> AuthorizedTask:
    """Approve a Task for the site and the robot it was examined for, in the name of a person.

    Args:
        examined: Result of every check; the Task, site and robot in it are approved byte by byte.
        by: Name of the person.
        at: Time of the approval, ISO 8601 with time zone.
        confirmed: The warnings that were shown and accepted, each in its own words (``line`` of the problem) in the
            language in which it was shown.
        language: Code of the language in which the plan and its warnings were read.

    Raises:
        NotConfirmedError: There is a warning that is not among the confirmed ones.
        NotApprovedError: A check fails, nobody approves, or ``at`` is no moment.
    """
    if not by.strip():
        raise NotApprovedError(message("nobody approves"), where="by", advice=message("say who approves"))
    _require_moment(at)
    if examined.errors:
        raise NotApprovedError(joined("; ", map(str, examined.errors)), advice=message("mend this and approve again"))
    lines = tuple(p.line() for p in examined.problems if p.severity == "warning")
    warnings = open_language(language).read(lines)
    _require_confirmed(warnings, confirmed)
    authorization = Authorization(
        by=by,
        at=at,
        task_sha256=hashlib.sha256(encode(examined.task)).hexdigest(),
        site_sha256=examined.site.sha256,
        robot_sha256=examined.robot.sha256,
        confirmed=warnings,
        language=language,
    )
    return AuthorizedTask(task=examined.task, authorization=authorization)


def uphold(task: Task, authorization: Authorization) -> AuthorizedTask:
    """Take an approval that was given elsewhere for what it is.

    Only the reader of bundles calls this, once a trusted person's signature was found to be good for every byte (a test
    holds every other module to that).

    Raises:
        NotApprovedError: It was given for another Task.
    """
    if hashlib.sha256(encode(task)).hexdigest() != authorization.task_sha256:
        raise NotApprovedError(message("another Task was approved"), advice=message("approve this one"))
    return AuthorizedTask(task=task, authorization=authorization)


def approved_before(
    document: bytes, task: Task, authorization: Authorization, site: Site, robot: RobotProfile
) -> AuthorizedTask:
    """A Task that was approved, and kept with its authorization: what was approved must be what was kept.

    Args:
        document: The Task as it was approved.
        task: What it says.

    Raises:
        NotApprovedError: Task, site or profile are not those that were approved.
    """
    for kind, given, wanted in (
        (message("Task"), hashlib.sha256(document).hexdigest(), authorization.task_sha256),
        (message("site"), site.sha256, authorization.site_sha256),
        (message("robot profile"), robot.sha256, authorization.robot_sha256),
    ):
        if given != wanted:
            raise NotApprovedError(
                message(
                    "the {kind} is not the one that was approved (SHA-256 {given}, approved {wanted})",
                    kind=kind,
                    given=given[:12],
                    wanted=wanted[:12],
                ),
                advice=message("approve the Task again"),
            )
    return AuthorizedTask(task=task, authorization=authorization)


def _require_confirmed(warnings: tuple[str, ...], confirmed: Container[str]) -> None:
    left = tuple(warning for warning in warnings if warning not in confirmed)
    if left:
        raise NotConfirmedError(
            message("not confirmed: {warnings}", warnings=joined("; ", left)),
            left,
            advice=message("confirm each if the plan is right in spite of it, or plan it anew"),
        )


def _require_moment(at: str) -> None:
    try:
        moment = datetime.fromisoformat(at)
    except ValueError:
        moment = None
    if moment is None or moment.tzinfo is None:
        raise NotApprovedError(
            message("'{at}' is no moment", at=at),
            where="at",
            advice=message("give date, time and time zone, as in 2026-05-01T08:00:00+02:00"),
        )
