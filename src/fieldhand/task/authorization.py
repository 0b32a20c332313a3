"""The output of approval: a Task that may be carried out, and for which site and robot.

Approval alone makes one (a test holds every other room to that); execution takes nothing else.
"""

from __future__ import annotations

from dataclasses import dataclass

from fieldhand.task.frames import Task


@dataclass(frozen=True, kw_only=True)
class Authorization:
    """Who approved what.

    Attributes:
        by: Who approved.
        at: When, ISO 8601 with time zone.
        task_sha256, site_sha256, robot_sha256: Of the Task document, the site file and the profile that were approved.
        confirmed: Every warning of the Task there, each shown and accepted, as it was shown.
        language: In which it was read and approved, by its code (ISO 639).
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
