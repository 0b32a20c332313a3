"""Approve a reviewed Task in the name of a person."""

from __future__ import annotations

from collections.abc import Container
from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING

from fieldhand.compatibility import UTC
from fieldhand.mission.review_task import Review
from fieldhand.robot.model import RobotProfile
from fieldhand.short_repr import short_repr
from fieldhand.site.model import Site
from fieldhand.task.authorization import AuthorizedTask
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from fieldhand.forecast.estimate import Estimate


@dataclass(frozen=True, kw_only=True, repr=False)
class ApprovedMission:
    """An approved Task with the site and the robot it was approved for, ready to be carried out.

    Attributes:
        authorized: The Task with its authorization.
        site, robot: Site and robot of the approval.
        estimate: Forecast that was approved; None where the mission was approved elsewhere.
    """

    authorized: AuthorizedTask
    site: Site
    robot: RobotProfile
    estimate: Estimate | None = None

    __repr__ = short_repr

    @property
    def task(self) -> Task:
        """The Task that was approved."""
        return self.authorized.task


def approved_earlier(authorized: AuthorizedTask, review: Review) -> ApprovedMission:
    """Return a mission whose Task was approved before, such as a signed one, with the forecast of a new review."""
    return ApprovedMission(authorized=authorized, site=review.site, robot=review.robot, estimate=review.estimate)


def authorize(
    review: Review,
    *,
    by: str,
    at: datetime | None = None,
    confirmed: Container[str] = (),
    language: str = "en",
) -> ApprovedMission:
    """Approve a reviewed Task for its site and its robot.

    Args:
        review: Review that the operator has read.
        by: Name of the operator.
        at: Time of the approval, with time zone; now by default.
        confirmed: The warnings that were read and accepted (:attr:`Review.warnings`).
        language: Code of the language in which the review was read.

    Raises:
        NotConfirmedError: There is a warning that is not among the confirmed ones.
        NotApprovedError: A check failed, or the name is empty.
    """
    from fieldhand.approval.authorize import approve

    moment = at or datetime.now(UTC)
    authorized = approve(
        review.examination, by=by, at=moment.isoformat(timespec="seconds"), confirmed=confirmed, language=language
    )
    return ApprovedMission(authorized=authorized, site=review.site, robot=review.robot, estimate=review.estimate)
