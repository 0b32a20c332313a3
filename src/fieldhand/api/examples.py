"""Requests to begin with, for a site and a robot."""

from __future__ import annotations

from functools import lru_cache
from typing import Annotated, Any

from fastapi import APIRouter, Depends

from fieldhand import mission
from fieldhand.api.callers import Caller, Scope, require
from fieldhand.api.inputs import SiteAndRobotBody, open_site_and_robot
from fieldhand.api.work import Workers
from fieldhand.mission.documents import SiteAndRobot
from fieldhand.planning.examples import site_examples


def router(workers: Workers) -> APIRouter:
    """``POST /examples``."""
    routes = APIRouter(tags=["catalogue"])
    kept = lru_cache(maxsize=64)(_by_hashes)

    @routes.post("/examples")
    async def examples(
        body: SiteAndRobotBody, caller: Annotated[Caller, Depends(require(Scope.READ))]
    ) -> dict[str, Any]:
        """Return requests that the built-in planner plans on a site with a robot."""

        def find() -> list[str]:
            chosen = open_site_and_robot(body)
            return list(kept(_Hashed(chosen), body.lang))

        return {"examples": await workers.do(find, caller.name)}

    return routes


class _Hashed:
    """Site and robot, equal to others of the same content."""

    def __init__(self, chosen: SiteAndRobot) -> None:
        self.chosen = chosen
        self._key = (chosen.site.sha256, chosen.robot.sha256)

    def __hash__(self) -> int:
        return hash(self._key)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Hashed) and self._key == other._key


def _by_hashes(hashed: _Hashed, language: str) -> tuple[str, ...]:
    chosen = hashed.chosen
    return site_examples(chosen.site, chosen.robot, mission.make_planner("english", {}), language=language)
