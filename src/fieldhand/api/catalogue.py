"""Built-in sites, robots and languages."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any

from fastapi import APIRouter, Depends

from fieldhand.api.callers import Caller, Scope, require
from fieldhand.api.inputs import open_choice, open_robot
from fieldhand.api.work import Workers
from fieldhand.language import languages
from fieldhand.site.loader import BUILT_IN_SITES

Reader = Annotated[Caller, Depends(require(Scope.READ))]


def router(workers: Workers) -> APIRouter:
    """``GET /sites``, ``GET /robots``, ``GET /robots/{name}``, ``GET /languages``."""
    routes = APIRouter(tags=["catalogue"])

    @routes.get("/sites")
    async def sites(caller: Reader) -> list[dict[str, Any]]:
        """List the built-in sites."""
        return await workers.do(_sites, caller.name)

    @routes.get("/robots")
    async def robots(caller: Reader) -> list[dict[str, Any]]:
        """List the built-in robots."""
        return await workers.do(_robots, caller.name)

    @routes.get("/robots/{name}")
    async def robot(name: str, caller: Reader) -> dict[str, Any]:
        """Return the profile of a robot."""
        return await workers.do(lambda: _robot(name), caller.name)

    @routes.get("/languages")
    async def spoken(_: Reader) -> list[dict[str, str]]:
        """List the languages in which a plan can be read back."""
        return [{"code": code, "name": name} for code, name in languages().items()]

    return routes


def _sites() -> list[dict[str, Any]]:
    sites = {name: open_choice(name) for name in BUILT_IN_SITES}
    return [{"name": name, "title": site.name, "trees": len(site.trees)} for name, site in sites.items()]


def _robots() -> list[dict[str, Any]]:
    from fieldhand.robot.loader import robot_names

    profiles = [open_robot(name) for name in robot_names()]
    return [{"name": p.name, "description": p.description, "actions": [a.name for a in p.actions]} for p in profiles]


def _robot(name: str) -> dict[str, Any]:
    record = asdict(open_robot(name))
    record.pop("source")
    return record
