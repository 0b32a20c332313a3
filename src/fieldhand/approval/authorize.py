"""The approval itself: the one place that makes an ``AuthorizedTask`` (a test holds every other module to that)."""

from __future__ import annotations

import hashlib
from datetime import datetime

from fieldhand.approval.checks import check
from fieldhand.errors import NotApprovedError
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.authorization import Authorization, AuthorizedTask
from fieldhand.task.codec import encode
from fieldhand.task.frames import Task


def approve(
    task: Task, site: Site, robot: RobotProfile, *, by: str, at: str, confirmed: tuple[str, ...] = ()
) -> AuthorizedTask:
    """Approve a Task for this site and this robot, in the name of a person.

    Args:
        task: The Task, as it was read back.
        site, robot: For which it is approved, byte by byte.
        by: Who approves.
        at: When, ISO 8601 with time zone.
        confirmed: Warnings that were shown and accepted.

    Raises:
        NotApprovedError: A check fails, nobody approves, or ``at`` is no moment.
    """
    if not by.strip():
        raise NotApprovedError("nobody approves", where="by", advice="say who approves")
    _require_moment(at)
    errors = [str(p) for p in check(task, site, robot) if p.severity == "error"]
    if errors:
        raise NotApprovedError("; ".join(errors), advice="mend this and approve again")
    authorization = Authorization(
        by=by,
        at=at,
        task_sha256=hashlib.sha256(encode(task)).hexdigest(),
        site_sha256=site.sha256,
        robot_sha256=robot.sha256,
        confirmed=confirmed,
    )
    return AuthorizedTask(task=task, authorization=authorization)


def _require_moment(at: str) -> None:
    try:
        moment = datetime.fromisoformat(at)
    except ValueError:
        moment = None
    if moment is None or moment.tzinfo is None:
        raise NotApprovedError(
            f"'{at}' is no moment", where="at", advice="give date, time and time zone, as in 2026-05-01T08:00:00+02:00"
        )
