"""Describe a site."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Depends

from fieldhand.api.callers import Caller, Scope, require
from fieldhand.api.inputs import SiteBody, open_choice
from fieldhand.api.maps import site_map
from fieldhand.api.work import Workers


def router(workers: Workers) -> APIRouter:
    """``POST /site``."""
    routes = APIRouter(tags=["site"])

    @routes.post("/site")
    async def site(body: SiteBody, caller: Annotated[Caller, Depends(require(Scope.READ))]) -> dict[str, Any]:
        """Return trees, markers, zones and attributes of a site, and the notes of its reader."""
        return await workers.do(lambda: _site(body), caller.name)

    return routes


def _site(body: SiteBody) -> dict[str, Any]:
    site = open_choice(body.site)
    return {
        "name": site.name,
        "sha256": site.sha256,
        "trees": len(site.trees),
        "markers": sorted(site.markers),
        "zones": [{"name": z.name, "kind": z.kind} for z in site.zones],
        "attributes": sorted(site.attributes),
        "notes": list(site.notes),
        "map": site_map(site),
    }
