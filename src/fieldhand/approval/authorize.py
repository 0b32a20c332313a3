"""Operator approval: the only module that creates an ``AuthorizedTask`` (enforced by a test)."""

from __future__ import annotations

import hashlib
from collections.abc import Container

from fieldhand.approval.checks import Examination
from fieldhand.compatibility import datetime_from_iso
from fieldhand.errors import NotApprovedError, NotConfirmedError
from fieldhand.language import joined, message, open_language
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.authorization import Authorization, AuthorizedTask
from fieldhand.task.codec import encode
from fieldhand.task.frames import Task


class EveryWarning(Container[str]):
    """Container that accepts every warning as confirmed, for unattended experiments."""

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
    """Approve a Task in the name of a person, for the site and robot that it was examined with.

    Args:
        examined: Result of the checks; the approval covers its Task, site and robot profile byte for byte.
        by: Name of the person.
        at: Time of the approval, ISO 8601 with time zone.
        confirmed: Warnings that the person accepted, each as the text shown (``line`` of the problem) in ``language``.
        language: Code of the language in which the plan and its warnings were shown.

    Raises:
        NotConfirmedError: A warning is missing from ``confirmed``.
        NotApprovedError: A check fails, ``by`` is empty, or ``at`` is not a time with a time zone.
    """
    if not by.strip():
        raise NotApprovedError(
            message("no approver is given"), where="by", advice=message("give the name of whoever approves")
        )
    _require_moment(at)
    if examined.errors:
        raise NotApprovedError(
            joined("; ", map(str, examined.errors)), advice=message("correct this and approve again")
        )
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
    """Restore an approval that was given on another machine.

    Only the bundle reader calls this function (enforced by a test), after verifying a trusted person's signature over
    every byte.

    Raises:
        NotApprovedError: The approval belongs to another Task.
    """
    if hashlib.sha256(encode(task)).hexdigest() != authorization.task_sha256:
        raise NotApprovedError(message("another Task was approved"), advice=message("approve this one"))
    return AuthorizedTask(task=task, authorization=authorization)


def approved_before(
    document: bytes, task: Task, authorization: Authorization, site: Site, robot: RobotProfile
) -> AuthorizedTask:
    """Restore an approval from a stored Task and its authorization, after comparing their hashes.

    Args:
        document: Bytes of the Task as approved.
        task: Task parsed from ``document``.

    Raises:
        NotApprovedError: The Task, site or robot profile differs from the approved one.
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
            advice=message("confirm each one if the plan is right in spite of it, or plan again"),
        )


def _require_moment(at: str) -> None:
    try:
        moment = datetime_from_iso(at)
    except ValueError:
        moment = None
    if moment is None or moment.tzinfo is None:
        raise NotApprovedError(
            message("'{at}' is not a valid date and time", at=at),
            where="at",
            advice=message("give date, time and time zone, as in 2026-05-01T08:00:00+02:00"),
        )
