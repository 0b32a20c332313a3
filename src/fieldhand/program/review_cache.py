"""The review of the last mission of an agent, which its start and its report both need."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand import mission
from fieldhand.task.earlier import site_of_run, with_earlier

if TYPE_CHECKING:
    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.earlier_missions import EarlierMissions
    from fieldhand.site.model import Site
    from fieldhand.task.authorization import AuthorizedTask


class ReviewCache:
    """Reviews approved Tasks and keeps the last review, so that each mission is reviewed once."""

    def __init__(self) -> None:
        self._last: tuple[tuple[str, str, str, EarlierMissions | None], mission.Review] | None = None

    def review(self, authorized: AuthorizedTask, site: Site, robot: RobotProfile) -> mission.Review:
        """Return the review of a Task; the last one again if Task, site and robot are the same.

        Of a run of a standing mission, which counts earlier missions anew, it is the review with those.
        """
        approved = authorized.authorization
        key = (
            approved.task_sha256,
            approved.site_sha256,
            approved.robot_sha256,
            site_of_run(authorized.task, site).earlier,
        )
        last = self._last
        if last is None or last[0] != key:
            task = (
                authorized.task if key[3] in (None, authorized.task.earlier) else with_earlier(authorized.task, key[3])
            )
            last = self._last = key, mission.review(task, site, robot)
        return last[1]
