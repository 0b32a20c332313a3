"""The state of the server, for programs that watch it."""

from __future__ import annotations

from fastapi import APIRouter

from fieldhand.api.account_service import AccountService


def router(service: AccountService) -> APIRouter:
    """``GET /health``."""
    routes = APIRouter(tags=["health"])

    @routes.get("/health")
    async def health() -> dict[str, str]:
        """Return that the server and its database respond; anybody may ask."""
        await service.do(service.accounts.database.require_reachable)
        return {"status": "ok"}

    return routes
