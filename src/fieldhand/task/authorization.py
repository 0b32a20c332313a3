"""The output of approval: a Task cleared for execution, with the site and robot it was approved for.

Only the approval room creates one (a test enforces this); execution accepts nothing else.
"""

from __future__ import annotations

from dataclasses import dataclass

from fieldhand.task.frames import Task


@dataclass(frozen=True, kw_only=True)
class Authorization:
    """Record of an approval.

    Attributes:
        by: Name of the approver.
        at: Time of approval, ISO 8601 with time zone.
        task_sha256, site_sha256, robot_sha256: Hashes of the approved Task document, site file and robot profile.
        confirmed: The Task's warnings that the approver was shown and accepted, in the words shown.
        language: Language of the review, as an ISO 639 code.
    """

    by: str
    at: str
    task_sha256: str
    site_sha256: str
    robot_sha256: str
    confirmed: tuple[str, ...] = ()
    language: str = "en"


@dataclass(frozen=True, kw_only=True)
class AuthorizedTask:
    """A Task with its authorization."""

    task: Task
    authorization: Authorization
