"""The review of the last mission of an agent, which its start and its report both need."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand import mission

if TYPE_CHECKING:
    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.model import Site
    from fieldhand.task.authorization import AuthorizedTask


class ReviewCache:
    """Reviews approved Tasks and keeps the last review, so that each mission is reviewed once."""

    def __init__(self) -> None:
        self._last: tuple[tuple[str, str, str], mission.Review] | None = None

    def review(self, authorized: AuthorizedTask, site: Site, robot: RobotProfile) -> mission.Review:
        """Return the review of a Task; the last one again if Task, site and robot are the same."""
        approved = authorized.authorization
        key = (approved.task_sha256, approved.site_sha256, approved.robot_sha256)
        last = self._last
        if last is None or last[0] != key:
            last = self._last = key, mission.review(authorized.task, site, robot)
        return last[1]
